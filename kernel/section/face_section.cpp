// On an open component the i-th enter goes with the i-th leave. On a closed one the order is first turned to start
// where the running count of enters less leaves is least, which is where no span is open; then the same holds.

#include "kernel/section/face_section.h"

#include <algorithm>
#include <tuple>

namespace lyr {
namespace {

struct Event {
    Place place;
    std::uint32_t crossing;
    bool enters;

    // At one crossing a span ends before the next begins.
    bool operator<(const Event& other) const {
        return std::tie(place.component, place.key, crossing, enters) <
               std::tie(other.place.component, other.place.key, other.crossing, other.enters);
    }
};

std::size_t place_without_open_span(std::span<const Event> events) {
    int open = 0, least = 0;
    std::size_t start = 0;
    for (std::size_t i = 0; i < events.size(); ++i) {
        open += events[i].enters ? 1 : -1;
        if (open < least) {
            least = open;
            start = i + 1;
        }
    }
    return start % events.size();
}

// Pairs the events of one component; what is left over goes to `rest`.
void pair_component(std::span<const Event> events, const SurfaceSection& section, FaceSpans& result,
                    std::vector<Event>& rest) {
    const double period = lyr::period(section, events.front().place.component);
    const std::size_t n = events.size();
    const std::size_t start = period > 0 ? place_without_open_span(events) : 0;
    std::vector<Event> enters, leaves;
    for (std::size_t i = 0; i < n; ++i) {
        Event event = events[(start + i) % n];
        if (start + i >= n) event.place.key += period;
        (event.enters ? enters : leaves).push_back(event);
    }
    const std::size_t pairs = std::min(enters.size(), leaves.size());
    for (std::size_t i = 0; i < pairs; ++i) {
        double to = leaves[i].place.key;
        const bool whole_turn = enters[i].crossing == leaves[i].crossing && period > 0;
        if (whole_turn && to <= enters[i].place.key) to += period;
        const double from = enters[i].place.key;
        const bool unbroken = is_unbroken(section, from, to);
        if (!unbroken) ++result.forced;
        result.spans.push_back({enters[i].crossing, leaves[i].crossing,
                                unbroken ? enters[i].place.component : -1, from, to});
    }
    rest.insert(rest.end(), enters.begin() + static_cast<std::ptrdiff_t>(pairs), enters.end());
    rest.insert(rest.end(), leaves.begin() + static_cast<std::ptrdiff_t>(pairs), leaves.end());
}

void join_by_force(const std::vector<Event>& rest, FaceSpans& result) {
    std::vector<std::uint32_t> enters, leaves;
    for (const Event& event : rest) (event.enters ? enters : leaves).push_back(event.crossing);
    const std::size_t pairs = std::min(enters.size(), leaves.size());
    for (std::size_t i = 0; i < pairs; ++i) {
        result.spans.push_back({enters[i], leaves[i], -1, 0, 0});
        ++result.forced;
    }
    for (std::size_t i = pairs; i < enters.size(); ++i) result.unpaired.push_back(enters[i]);
    for (std::size_t i = pairs; i < leaves.size(); ++i) result.unpaired.push_back(leaves[i]);
}

}  // namespace

FaceSpans pair_crossings(const SurfaceSection& section, std::span<const FaceCrossing> crossings) {
    std::vector<Event> events;
    events.reserve(crossings.size());
    for (const FaceCrossing& c : crossings) {
        events.push_back({locate(section, c.at), c.crossing, c.enters});
    }
    std::sort(events.begin(), events.end());
    FaceSpans result;
    result.crossed.assign(static_cast<std::size_t>(component_count(section)), false);
    for (const Event& event : events) {
        result.crossed[static_cast<std::size_t>(event.place.component)] = true;
    }
    std::vector<Event> rest;
    for (std::size_t first = 0; first < events.size();) {
        std::size_t last = first;
        while (last < events.size() &&
               events[last].place.component == events[first].place.component) {
            ++last;
        }
        pair_component(std::span(events).subspan(first, last - first), section, result, rest);
        first = last;
    }
    if (!rest.empty()) join_by_force(rest, result);
    return result;
}

}  // namespace lyr
