// The medial axis, less its branches into corners, is where strands run; what remains is to find where they begin and
// end.

#include "kernel/toolpath/centre_lines.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/region/verify.h"
#include "kernel/toolpath/middle_path.h"

namespace lyr {
namespace {

// Where the radius changes by more than this share of the way, sides run into a corner of more than 80 degrees: the
// strand's end fills it as well as a strand up to its point would.
const double steep = std::sin(40 * std::numbers::pi / 180);

// Of the least width: shorter strands are not worth the start.
constexpr double shortest_share = 0.5;

// The width of a strand in a part that is a disc, as a share of the disc's radius: half the part's, and so it is as long.
constexpr double dot_width_share = 1;
// Of the least width, how long such a strand is at least: a pin is printed if it is a little wider than the least width.
constexpr double shortest_dot_share = 0.1;

// Paths are never held to less than what a file can tell.
constexpr double least_allowed_mm = 1e-4;

// Of what is allowed, how far chords may be off the arcs that they stand for.
constexpr double chord_share = 0.25;

Path halves_of(const FullCircle& circle) {
    const Vector2 out(circle.radius_mm, 0);
    const double sagitta_mm = circle.counter_clockwise ? circle.radius_mm : -circle.radius_mm;
    return {circle.centre + out,
            {{circle.centre - out, sagitta_mm}, {circle.centre + out, sagitta_mm}}};
}

// Discs between arcs that are almost one circle, or between arcs and lines that they are almost, touch both along their
// length but for round-off. Between chords they touch points. Where discs find no end because of that, paths are fitted to
// the middle of chords, from which they differ by less than allowed; they are lines and arcs as ever.
std::vector<Contour> of_chords(Region region, double off_mm) {
    std::vector<Contour> result;
    for (const Contour& contour : region) {
        const auto* circle = std::get_if<FullCircle>(&contour);
        const Path arcs = circle ? halves_of(*circle) : std::get<Path>(contour);
        Path chords{arcs.start, {}};
        Point2 from = arcs.start;
        for (const Segment& segment : arcs.segments) {
            const double turn_by_length =
                std::abs(sweep_rad(from, segment)) * lyr::length_mm(from, segment);
            const int count =
                std::max(1, static_cast<int>(std::ceil(std::sqrt(turn_by_length / (8 * off_mm)))));
            for (int i = 1; i < count; ++i)
                chords.segments.push_back(
                    {point_at(from, segment, static_cast<double>(i) / count)});
            chords.segments.push_back({segment.end});
            from = segment.end;
        }
        result.push_back(std::move(chords));
    }
    return result;
}

struct Range {
    double from_mm, to_mm;
};

// With round ends.
double printed_mm2(const Strand& strand) {
    if (strand.widths_mm.empty()) {
        const double ends = is_closed(strand) ? 0 : std::numbers::pi / 4 * strand.width_mm;
        return (length_mm(strand.path) + ends) * strand.width_mm;
    }
    const Path& path = std::get<Path>(strand.path);
    double area = 0;
    Point2 from = path.start;
    for (std::size_t i = 0; i < path.segments.size(); ++i) {
        area += length_mm(from, path.segments[i]) * strand.widths_mm[i];
        from = path.segments[i].end;
    }
    if (is_closed(strand)) return area;
    for (const double width : {strand.widths_mm.front(), strand.widths_mm.back()})
        area += std::numbers::pi / 8 * width * width;
    return area;
}

class LineMaker {
public:
    explicit LineMaker(const CentreLineRequest& request)
        : request_(request), allowed_mm_(std::max(request.allowed_mm, least_allowed_mm)) {}

    CentreLines make(Region narrow) {
        MedialAxis axis = medial_axis(narrow, request_.max_width_mm);
        if (!axis.complete && std::all_of(narrow.begin(), narrow.end(), region::is_finite))
            axis = medial_axis(of_chords(narrow, chord_share * allowed_mm_), request_.max_width_mm);
        made_.unresolved += !axis.complete;
        for (const MedialChain& chain : medial_chains(axis, request_.min_width_mm)) add(chain);
        for (const MedialDisc& disc : axis.discs)
            add_dot(disc.centre, Vector2::UnitX(), disc.radius_mm, 0);
        double rest = -made_.left_out_mm2 - made_.beside_mm2;
        for (const Contour& contour : narrow) rest += lyr::area_mm2(contour);
        for (const Strand& strand : made_.strands) rest -= printed_mm2(strand);
        if (axis.complete) made_.corners_mm2 = std::max(0.0, rest);
        return std::move(made_);
    }

private:
    void add(const MedialChain& chain) {
        const Stations stations = stations_of(chain);
        std::vector<Station> all;
        for (const std::vector<Station>& edge : stations)
            all.insert(all.end(), edge.begin(), edge.end());
        const double length = all.back().at_mm;
        const Range whole = chain.is_closed ? Range{0, length} : between_ends(chain, all);
        const std::vector<Range> ranges = wide_ranges(all, whole, chain.is_closed);
        const bool is_alone = !chain.starts_at_branch && !chain.ends_at_branch;
        if (ranges.empty() && is_alone) {
            const Station& widest =
                *std::max_element(all.begin(), all.end(), [](const Station& a, const Station& b) {
                    return a.point.radius_mm < b.point.radius_mm;
                });
            return add_dot(widest.point.centre, widest.point.tangent, widest.point.radius_mm,
                           all.back().area_mm2);
        }
        made_.left_out_mm2 += area_mm2(part(stations, whole.from_mm, whole.to_mm));
        for (const Range& range : ranges) {
            const Stations within = part(stations, range.from_mm, range.to_mm);
            made_.left_out_mm2 -= area_mm2(within);
            add_strand(within, chain.is_closed && range.from_mm == 0 && range.to_mm == length);
        }
    }

    // Without corners, and what lies in the strands that it branches off from.
    static Range between_ends(const MedialChain& chain, const std::vector<Station>& all) {
        const auto is_steep = [](const Station& tip, const Station& next) {
            return next.point.radius_mm - tip.point.radius_mm >=
                   steep * std::abs(next.at_mm - tip.at_mm);
        };
        std::size_t first = 0, last = all.size() - 1;
        if (!chain.starts_at_branch)
            while (first < last && is_steep(all[first], all[first + 1])) ++first;
        if (!chain.ends_at_branch)
            while (first < last && is_steep(all[last], all[last - 1])) --last;
        Range range{all[first].at_mm, all[last].at_mm};
        if (chain.starts_at_branch) range.from_mm += all.front().point.radius_mm;
        if (chain.ends_at_branch) range.to_mm -= all.back().point.radius_mm;
        return range;
    }

    // Where the region is wide enough, for long enough.
    std::vector<Range> wide_ranges(const std::vector<Station>& all, const Range& whole,
                                   bool is_closed) const {
        const double least = (request_.min_width_mm - allowed_mm_) / 2;
        std::vector<Range> ranges;
        const auto add = [&](double from, double to) {
            from = std::max(from, whole.from_mm);
            to = std::min(to, whole.to_mm);
            if (!(from < to)) return;
            if (!ranges.empty() && ranges.back().to_mm == from)
                ranges.back().to_mm = to;
            else
                ranges.push_back({from, to});
        };
        for (std::size_t i = 1; i < all.size(); ++i) {
            const Station &a = all[i - 1], &b = all[i];
            const double p = a.point.radius_mm - least, q = b.point.radius_mm - least;
            if (p < 0 && q < 0) continue;
            const double cut = a.at_mm + (b.at_mm - a.at_mm) * p / (p - q);
            add(p < 0 ? cut : a.at_mm, q < 0 ? cut : b.at_mm);
        }
        const double shortest = shortest_share * request_.min_width_mm;
        if (!is_closed)
            std::erase_if(ranges, [&](const Range& r) { return r.to_mm - r.from_mm < shortest; });
        return ranges;
    }

    static double area_mm2(const Stations& stations) {
        return stations.empty() ? 0 : stations.back().back().area_mm2 - stations[0][0].area_mm2;
    }

    void add_strand(const Stations& stations, bool is_closed) {
        for (const std::vector<Station>& edge : stations)
            for (std::size_t i = 1; i < edge.size(); ++i) {
                const auto beside = [&](const Station& s) {
                    return std::max(0.0, 2 * s.point.radius_mm - request_.max_width_mm);
                };
                made_.beside_mm2 += (edge[i].at_mm - edge[i - 1].at_mm) *
                                    (beside(edge[i - 1]) + beside(edge[i])) / 2;
            }
        const WidthLimits limits{request_.max_width_mm, width_step_mm};
        made_.strands.push_back(strand_along(stations, is_closed, limits, allowed_mm_));
    }

    // Of a part whose largest disc is as good as all of it.
    void add_dot(const Point2& centre, const Vector2& along, double radius_mm, double area_mm2) {
        const double width =
            std::clamp(dot_width_share * radius_mm, request_.min_width_mm, request_.max_width_mm);
        const double length = 2 * radius_mm - width;
        area_mm2 = std::max(area_mm2, std::numbers::pi * radius_mm * radius_mm);
        if (length < shortest_dot_share * request_.min_width_mm) {
            made_.left_out_mm2 += area_mm2;
            return;
        }
        const Vector2 half = length / 2 * along;
        made_.strands.push_back({Path{centre - half, {{centre + half}}}, width});
        made_.beside_mm2 += std::max(0.0, area_mm2 - printed_mm2(made_.strands.back()));
    }

    CentreLineRequest request_;
    double allowed_mm_;
    CentreLines made_;
};

}  // namespace

CentreLines centre_lines(Region narrow, const CentreLineRequest& request) {
    const bool is_valid = request.min_width_mm > 0 && std::isfinite(request.allowed_mm) &&
                          request.max_width_mm >= request.min_width_mm &&
                          std::isfinite(request.max_width_mm);
    if (!is_valid) return {.unresolved = 1};
    if (narrow.empty()) return {};
    return LineMaker(request).make(narrow);
}

}  // namespace lyr
