// The medial axis, less its branches into corners, is where strands run; what remains is to find where they begin and
// end. At a joint the axis is that of the narrow part together with what it is cut off from: it runs on through the cut
// as if there were none, and strands are what of it lies outside of what walls cover.

#include "kernel/toolpath/centre_lines.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "kernel/region/verify.h"
#include "kernel/toolpath/islands.h"
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

// Of a chain, within a region.
struct Stretch {
    Range range;
    Point2 inside;
};

std::vector<Stretch> stretches_within(const std::vector<Station>& all, const Boundary& region) {
    std::vector<Stretch> result;
    std::vector<BoundaryCrossing> crossings;
    for (std::size_t i = 1; i < all.size(); ++i) {
        const Point2 &a = all[i - 1].point.centre, &b = all[i].point.centre;
        region.crossings(a, b, crossings);
        const double length = (b - a).norm();
        double from = 0;
        for (std::size_t k = 0; k <= crossings.size(); ++k) {
            const double to = k < crossings.size() ? crossings[k].along_mm : length;
            if (!(from < to)) continue;
            const Point2 middle = a + (from + to) / (2 * length) * (b - a);
            const Range range{all[i - 1].at_mm + from,
                              k < crossings.size() ? all[i - 1].at_mm + to : all[i].at_mm};
            from = to;
            if (region.winding(middle) <= 0) continue;
            if (!result.empty() && result.back().range.to_mm == range.from_mm)
                result.back().range.to_mm = range.to_mm;
            else
                result.push_back({range, middle});
        }
    }
    return result;
}

// What lies between stretches.
std::vector<Range> outside_of(const std::vector<Stretch>& stretches, double length_mm) {
    std::vector<Range> result;
    double from = 0;
    for (const Stretch& stretch : stretches) {
        if (from < stretch.range.from_mm) result.push_back({from, stretch.range.from_mm});
        from = stretch.range.to_mm;
    }
    if (from < length_mm) result.push_back({from, length_mm});
    return result;
}

bool meet(const Range& a, const Range& b) {
    return a.from_mm < b.to_mm && b.from_mm < a.to_mm;
}

Range common(const Range& a, const Range& b) {
    return {std::max(a.from_mm, b.from_mm), std::min(a.to_mm, b.to_mm)};
}

// With round ends.
double printed_mm2(const Strand& strand) {
    double area = flat_area_mm2(strand);
    if (is_closed(strand)) return area;
    const bool varies = !strand.widths_mm.empty();
    for (const double width : {varies ? strand.widths_mm.front() : strand.width_mm,
                               varies ? strand.widths_mm.back() : strand.width_mm})
        area += std::numbers::pi / 8 * width * width;
    return area;
}

struct JointBoundary {
    Boundary covered, narrow;
};

class LineMaker {
public:
    explicit LineMaker(const CentreLineRequest& request)
        : request_(request), allowed_mm_(std::max(request.allowed_mm, least_allowed_mm)) {}

    void fill(Region narrow) {
        const MedialAxis axis = axis_of(narrow);
        complete_ = complete_ && axis.complete;
        made_.unresolved += !axis.complete;
        for (const MedialChain& chain : medial_chains(axis, request_.min_width_mm)) add(chain);
        for (const MedialDisc& disc : axis.discs)
            add_dot(disc.centre, Vector2::UnitX(), disc.radius_mm, 0);
    }

    // Gives points in the parts that strands run through, none if it does not come out right.
    std::vector<Point2> fill_joint(Region narrow, const Joint& joint) {
        const MedialAxis axis = axis_of(joint.around);
        if (!axis.complete) return {};
        const JointBoundary boundary{Boundary(joint.covered), Boundary(narrow)};
        std::vector<Point2> met;
        for (const MedialChain& chain :
             medial_chains(axis, request_.min_width_mm, &boundary.covered))
            add_outside(chain, boundary, met);
        return met;
    }

    CentreLines made(Region narrow) {
        double rest = -made_.left_out_mm2 - made_.beside_mm2;
        for (const Contour& contour : narrow) rest += lyr::area_mm2(contour);
        for (const Strand& strand : made_.strands) rest -= printed_mm2(strand);
        if (complete_) made_.corners_mm2 = std::max(0.0, rest);
        return std::move(made_);
    }

private:
    MedialAxis axis_of(Region region) const {
        MedialAxis axis = medial_axis(region, request_.max_width_mm);
        if (axis.complete || !std::all_of(region.begin(), region.end(), region::is_finite))
            return axis;
        return medial_axis(of_chords(region, chord_share * allowed_mm_), request_.max_width_mm);
    }

    static std::vector<Station> joined(const Stations& stations) {
        std::vector<Station> all;
        for (const std::vector<Station>& edge : stations)
            all.insert(all.end(), edge.begin(), edge.end());
        return all;
    }

    void add(const MedialChain& chain) {
        const Stations stations = stations_of(chain);
        const std::vector<Station> all = joined(stations);
        const Range whole{0, all.back().at_mm};
        const Range within = chain.is_closed ? whole : between_ends(chain, all, whole);
        const bool is_alone = !chain.starts_at_branch && !chain.ends_at_branch;
        const std::vector<Range> wide = wide_ranges(all, within, chain.is_closed);
        add_strands(chain, stations, all, within, wide);
        find_broken(all, whole, wide);
        if (!wide.empty() || !is_alone) return;
        const Station& widest =
            *std::max_element(all.begin(), all.end(), [](const Station& a, const Station& b) {
                return a.point.radius_mm < b.point.radius_mm;
            });
        made_.left_out_mm2 -= area_mm2(part(stations, within.from_mm, within.to_mm));
        add_dot(widest.point.centre, widest.point.tangent, widest.point.radius_mm,
                all.back().area_mm2);
    }

    // What of a chain runs through narrow parts, on to what is covered.
    void add_outside(const MedialChain& chain, const JointBoundary& joint,
                     std::vector<Point2>& met) {
        const Stations stations = stations_of(chain);
        const std::vector<Station> all = joined(stations);
        const std::vector<Stretch> narrow = stretches_within(all, joint.narrow);
        if (narrow.empty()) return;
        const std::vector<Range> outside =
            outside_of(stretches_within(all, joint.covered), all.back().at_mm);
        if (outside.empty()) return;
        const Range ends{outside.front().from_mm, outside.back().to_mm};
        const Range within = chain.is_closed ? ends : between_ends(chain, all, ends);
        for (const Range& range : outside) {
            std::vector<Stretch> here;
            std::copy_if(narrow.begin(), narrow.end(), std::back_inserter(here),
                         [&](const Stretch& stretch) { return meet(stretch.range, range); });
            const Range open = common(range, within);
            if (here.empty() || !(open.from_mm < open.to_mm)) continue;
            std::vector<Range> wide = wide_ranges(all, open, chain.is_closed);
            find_broken(all, range, wide);
            // The chain may go on to other parts.
            std::erase_if(wide, [&](const Range& one) {
                return std::none_of(here.begin(), here.end(), [&](const Stretch& stretch) {
                    return meet(stretch.range, one);
                });
            });
            for (const Range& one : wide)
                for (const Stretch& stretch : here)
                    if (meet(stretch.range, one)) met.push_back(stretch.inside);
            const Range part{here.front().range.from_mm, here.back().range.to_mm};
            add_strands(chain, stations, all, common(open, part), wide);
        }
    }

    // The strands along ranges that are wide enough for them; what else is in the part is left out.
    void add_strands(const MedialChain& chain, const Stations& stations,
                     const std::vector<Station>& all, const Range& whole,
                     const std::vector<Range>& wide) {
        const auto within_mm2 = [&](const Range& range) {
            return range.from_mm < range.to_mm
                       ? area_mm2(part(stations, range.from_mm, range.to_mm))
                       : 0;
        };
        made_.left_out_mm2 += within_mm2(whole);
        for (const Range& one : wide) {
            made_.left_out_mm2 -= within_mm2(common(one, whole));
            add_strand(part(stations, one.from_mm, one.to_mm),
                       chain.is_closed && one.from_mm == 0 && one.to_mm == all.back().at_mm);
        }
    }

    // Where strands, or one and what is covered beside the range, have more between them than they reach over.
    void find_broken(const std::vector<Station>& all, const Range& range,
                     const std::vector<Range>& wide) {
        if (made_.broken || wide.empty()) return;
        double from = range.from_mm > 0 ? range.from_mm : wide.front().from_mm;
        for (std::size_t i = 0; i <= wide.size(); ++i) {
            const double end = range.to_mm < all.back().at_mm ? range.to_mm : wide.back().to_mm;
            const double to = i < wide.size() ? wide[i].from_mm : end;
            if (to - from > request_.min_width_mm) made_.broken = narrowest(all, {from, to});
            if (i < wide.size()) from = wide[i].to_mm;
        }
    }

    static std::optional<Point2> narrowest(const std::vector<Station>& all, const Range& range) {
        const MedialPoint* least = nullptr;
        for (const Station& station : all)
            if (range.from_mm <= station.at_mm && station.at_mm <= range.to_mm &&
                (!least || station.point.radius_mm < least->radius_mm))
                least = &station.point;
        return least ? std::optional(least->centre) : std::nullopt;
    }

    // Without corners, and what lies in the strands that it branches off from. Ends of the range that are not the
    // chain's stay.
    static Range between_ends(const MedialChain& chain, const std::vector<Station>& all,
                              const Range& range) {
        const auto is_steep = [](const Station& tip, const Station& next) {
            return next.point.radius_mm - tip.point.radius_mm >=
                   steep * std::abs(next.at_mm - tip.at_mm);
        };
        const bool starts = range.from_mm == 0, ends = range.to_mm == all.back().at_mm;
        std::size_t first = 0, last = all.size() - 1;
        if (starts && !chain.starts_at_branch)
            while (first < last && is_steep(all[first], all[first + 1])) ++first;
        if (ends && !chain.ends_at_branch)
            while (first < last && is_steep(all[last], all[last - 1])) --last;
        Range result{starts ? all[first].at_mm : range.from_mm,
                     ends ? all[last].at_mm : range.to_mm};
        if (starts && chain.starts_at_branch) result.from_mm += all.front().point.radius_mm;
        if (ends && chain.ends_at_branch) result.to_mm -= all.back().point.radius_mm;
        return result;
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
    bool complete_ = true;
    CentreLines made_;
};

// The parts that none of the points is in.
std::vector<Contour> others(Region narrow, std::span<const Point2> met) {
    std::vector<Contour> result;
    for (const std::vector<Contour>& part : parts_of(narrow)) {
        const Boundary boundary(part);
        if (std::none_of(met.begin(), met.end(),
                         [&](const Point2& point) { return boundary.winding(point) > 0; }))
            result.insert(result.end(), part.begin(), part.end());
    }
    return result;
}

}  // namespace

CentreLines centre_lines(Region narrow, const CentreLineRequest& request,
                         std::span<const Joint> joints) {
    const bool is_valid = request.min_width_mm > 0 && std::isfinite(request.allowed_mm) &&
                          request.max_width_mm >= request.min_width_mm &&
                          std::isfinite(request.max_width_mm);
    if (!is_valid) return {.unresolved = 1};
    if (narrow.empty()) return {};
    LineMaker maker(request);
    std::vector<Point2> met;
    for (const Joint& joint : joints) {
        const std::vector<Point2> points = maker.fill_joint(narrow, joint);
        met.insert(met.end(), points.begin(), points.end());
    }
    if (met.empty()) {
        maker.fill(narrow);
    } else {
        maker.fill(others(narrow, met));
    }
    return maker.made(narrow);
}

}  // namespace lyr
