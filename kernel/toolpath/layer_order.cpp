// Nests of walls and open pieces are the stops of a tour. Where the walls within a nest begin is decided on the way.

#include "kernel/toolpath/layer_order.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "kernel/toolpath/islands.h"
#include "kernel/toolpath/tour.h"
#include "kernel/toolpath/wall_nests.h"

namespace lyr {
namespace {

double width_of(const Strand& strand) {
    return strand.widths_mm.empty() ? strand.width_mm : strand.widths_mm.front();
}

class LayerWalk {
public:
    explicit LayerWalk(const LayerPlan& plan)
        : plan_(plan), nests_(wall_nests(plan.walls, plan.depths)), head_(plan.head) {
        seams_.resize(plan.walls.size());
        std::size_t next = 0;
        for (std::size_t i = 0; i < plan.walls.size() && next < plan.seams.size(); ++i)
            if (plan.depths[i] == 0) seams_[i] = plan.seams[next++];
    }

    std::vector<PrintMove> moves() {
        const std::size_t nests = nests_.roots.size();
        for (const Visit& visit : tour(stops(), head_)) {
            if (visit.index < nests) {
                const std::uint32_t root = nests_.roots[visit.index];
                anchor_ = seams_[root] ? std::optional(seams_[root]->point) : std::nullopt;
                append_nest(root);
            } else {
                append_piece(visit.index - static_cast<std::uint32_t>(nests), visit.reversed);
            }
        }
        return std::move(moves_);
    }

private:
    std::vector<Stop> stops() const {
        const Islands islands(plan_.region);
        std::vector<Stop> stops;
        for (const std::uint32_t root : nests_.roots) {
            const Point2 start =
                seams_[root] ? seams_[root]->point : start_of(plan_.walls[root].path);
            stops.push_back({start, start, islands.of(start), plan_.wall_stage});
        }
        for (const OpenPiece& piece : plan_.pieces)
            stops.push_back({piece.first, piece.last, islands.of(piece.first), piece.stage});
        return stops;
    }

    void append_nest(std::uint32_t wall) {
        if (plan_.sequence == WallSequence::outer_first) append_wall(wall);
        std::vector<std::uint32_t> children = nests_.children[wall];
        while (!children.empty()) {
            const auto nearest = std::min_element(
                children.begin(), children.end(), [&](std::uint32_t a, std::uint32_t b) {
                    return distance_to_start(a) < distance_to_start(b);
                });
            const std::uint32_t child = *nearest;
            children.erase(nearest);
            append_nest(child);
        }
        if (plan_.sequence == WallSequence::inner_first) append_wall(wall);
    }

    double distance_to_start(std::uint32_t wall) const {
        return (start_of(plan_.walls[wall].path) - head_).norm();
    }

    void append_wall(std::uint32_t wall) {
        const Strand& strand = plan_.walls[wall];
        const Seam seam = seams_[wall]
                              ? *seams_[wall]
                              : seam_of(strand.path, {SeamChoice::nearest, width_of(strand),
                                                      anchor_.value_or(head_)});
        moves_.push_back({true, wall, false, seam, way(seam.point)});
        head_ = seam.point;
    }

    void append_piece(std::uint32_t index, bool reversed) {
        const OpenPiece& piece = plan_.pieces[index];
        const Point2& start = reversed ? piece.last : piece.first;
        moves_.push_back({false, index, reversed, {start}, way(start)});
        head_ = reversed ? piece.first : piece.last;
    }

    Travel way(const Point2& to) const {
        return plan_.detours ? plan_.detours->way(head_, to) : Travel{};
    }

    const LayerPlan& plan_;
    WallNests nests_;
    std::vector<std::optional<Seam>> seams_;  // by wall
    Point2 head_;
    std::optional<Point2> anchor_;  // the seam of the nest's outermost wall
    std::vector<PrintMove> moves_;
};

}  // namespace

std::vector<PrintMove> layer_order(const LayerPlan& plan) {
    return LayerWalk(plan).moves();
}

std::vector<Seam> outer_seams(std::span<const Strand> walls, std::span<const std::uint32_t> depths,
                              SeamChoice choice, std::span<const Seam> below) {
    std::vector<Seam> seams;
    if (choice == SeamChoice::nearest) return seams;
    std::vector<Point2> points;
    for (const Seam& seam : below) points.push_back(seam.point);
    for (std::size_t i = 0; i < walls.size(); ++i) {
        if (depths[i] != 0) continue;
        seams.push_back(
            seam_of(walls[i].path, {choice, width_of(walls[i]), Point2::Zero(), points}));
    }
    return seams;
}

}  // namespace lyr
