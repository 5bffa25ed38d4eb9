// Islands are put in order first, each as one stop, then their stages each by a search from where the head is.

#include "kernel/toolpath/tour.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "kernel/toolpath/tour_search.h"

namespace lyr {
namespace {

// A shake costs 4 to 10 us. As many as stops gain 2 % of the travel for 20 to 50 stops; more than this many gain less
// than the time they take, if a layer is to be sliced in some milliseconds.
constexpr std::size_t most_shakes = 30;

// More islands are put in order by their middles only: they are small beside the ways between them.
constexpr std::size_t most_by_entries = 30;

using Run = std::span<const std::uint32_t>;  // stops' indices

// Indices with the same key, by rising key.
template <class Key>
std::vector<Run> runs_of(Run indices, Key key) {
    std::vector<Run> runs;
    for (std::size_t first = 0, last = 0; first < indices.size(); first = last) {
        while (last < indices.size() && key(indices[last]) == key(indices[first])) ++last;
        runs.push_back(indices.subspan(first, last - first));
    }
    return runs;
}

enum class Effort { quick, full };

std::vector<Visit> searched(std::span<const Stop> stops, const Point2& from, Effort effort) {
    TourSearch search(stops, from);
    search.improve();
    if (effort == Effort::full) search.shake(std::min(most_shakes, stops.size()));
    return search.visits();
}

Point2 left_at(const Stop& stop, bool reversed) {
    return reversed ? stop.first : stop.last;
}

class IslandTour {
public:
    IslandTour(std::span<const Stop> stops, const Point2& from)
        : stops_(stops), from_(from), order_(stops.size()) {
        std::iota(order_.begin(), order_.end(), 0u);
        std::stable_sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
            return std::pair(stops[a].island, stops[a].stage) <
                   std::pair(stops[b].island, stops[b].stage);
        });
        islands_ = runs_of(order_, [&](std::uint32_t i) { return stops[i].island; });
    }

    // The shorter one of two ways to put islands in order. Of islands of one stop the first is as good as it gets.
    std::vector<Visit> visits() const {
        std::vector<Run> islands = by_middles();
        if (islands.size() > 1 && islands.size() <= most_by_entries) {
            Walk entries = by_entries();
            if (travel_of(entries) < travel_of(walk_of(islands, Effort::quick)))
                islands = std::move(entries.islands);
        }
        return walk_of(islands, Effort::full).visits;
    }

private:
    struct Walk {
        Point2 head;
        std::vector<Run> islands{};
        std::vector<Visit> visits{};
    };

    double travel_of(const Walk& walk) const { return travel_mm(stops_, walk.visits, from_); }

    Walk walk_of(std::span<const Run> islands, Effort effort) const {
        Walk walk{from_};
        for (const Run island : islands) append(island, effort, walk);
        return walk;
    }

    std::vector<Run> by_middles() const {
        std::vector<Stop> places;
        for (const Run island : islands_) places.push_back(place_of(island));
        std::vector<Run> islands;
        for (const Visit& island : searched(places, from_, Effort::full))
            islands.push_back(islands_[island.index]);
        return islands;
    }

    // An island of one stop is that; others are entered and left somewhere, in the middle as far as one knows.
    Stop place_of(Run island) const {
        if (island.size() == 1) return {stops_[island[0]].first, stops_[island[0]].last};
        Point2 sum = Point2::Zero();
        for (const std::uint32_t i : island) sum += stops_[i].first + stops_[i].last;
        const Point2 middle = sum / (2.0 * static_cast<double>(island.size()));
        return {middle, middle};
    }

    // Always on to the island that can be entered next to the head.
    Walk by_entries() const {
        Walk walk{from_};
        std::vector<Run> left = islands_;
        while (!left.empty()) {
            const auto nearest = std::min_element(left.begin(), left.end(), [&](Run a, Run b) {
                return entry_mm(a, walk.head) < entry_mm(b, walk.head);
            });
            append(*nearest, Effort::quick, walk);
            left.erase(nearest);
        }
        return walk;
    }

    double entry_mm(Run island, const Point2& head) const {
        double least = std::numeric_limits<double>::infinity();
        for (const std::uint32_t i : island) {
            if (stops_[i].stage != stops_[island.front()].stage) break;
            least =
                std::min({least, (stops_[i].first - head).norm(), (stops_[i].last - head).norm()});
        }
        return least;
    }

    void append(Run island, Effort effort, Walk& walk) const {
        walk.islands.push_back(island);
        for (const Run stage : runs_of(island, [&](std::uint32_t i) { return stops_[i].stage; })) {
            std::vector<Stop> stops;
            for (const std::uint32_t i : stage) stops.push_back(stops_[i]);
            for (const Visit& visit : searched(stops, walk.head, effort))
                walk.visits.push_back({stage[visit.index], visit.reversed});
            walk.head = left_at(stops_[walk.visits.back().index], walk.visits.back().reversed);
        }
    }

    std::span<const Stop> stops_;
    Point2 from_;
    std::vector<std::uint32_t> order_;
    std::vector<Run> islands_;
};

}  // namespace

std::vector<Visit> tour(std::span<const Stop> stops, const Point2& from) {
    if (stops.empty()) return {};
    return IslandTour(stops, from).visits();
}

double travel_mm(std::span<const Stop> stops, std::span<const Visit> visits, const Point2& from) {
    double travel = 0;
    Point2 head = from;
    for (const Visit& visit : visits) {
        const Stop& stop = stops[visit.index];
        travel += ((visit.reversed ? stop.last : stop.first) - head).norm();
        head = left_at(stop, visit.reversed);
    }
    return travel;
}

}  // namespace lyr
