// Edges that are straight or an arc become one segment each, what lies between them is fitted; then segments are joined
// as far as one line or arc is near enough to all of them, and at last cut where the width changes.

#include "kernel/toolpath/middle_path.h"

#include <algorithm>
#include <cmath>

#include "kernel/contour/fit.h"

namespace lyr {
namespace {

// What is allowed is shared between fitting and joining.
constexpr double fit_share = 0.5, join_share = 0.4;

// Tangents that differ by less are no corner.
constexpr double smooth_rad = 1e-3;

// A strand is not cut into shorter parts for the width's sake: it is not known better than that where the plastic goes.
constexpr double shortest_mm = 0.05;

struct Element {
    Point2 start;
    Segment segment;
    double from_mm, to_mm;  // along the chain
};

// The arc from one point to another through a third.
Segment arc_through(const Point2& start, const Point2& middle, const Point2& end) {
    const Vector2 p = middle - start, q = end - middle;
    const double divisor = p.norm() * q.norm() + p.dot(q);
    return {end, divisor > 0 ? (end - start).norm() / 2 * cross(p, q) / divisor : 0};
}

// What of the area between two points lies before a fraction of the way.
double area_share(const MedialPoint& a, const MedialPoint& b, double fraction) {
    const double sum = a.radius_mm + b.radius_mm;
    const double here = a.radius_mm + fraction * (b.radius_mm - a.radius_mm);
    return sum > 0 ? fraction * (a.radius_mm + here) / sum : fraction;
}

MedialPoint between(const MedialPoint& a, const MedialPoint& b, double fraction) {
    const double turn = std::atan2(cross(a.tangent, b.tangent), a.tangent.dot(b.tangent));
    const Segment arc{b.centre, (b.centre - a.centre).norm() / 2 * std::tan(turn / 4)};
    const Eigen::Rotation2Dd turned(fraction * turn);
    return {point_at(a.centre, arc, fraction), turned * a.tangent,
            a.radius_mm + fraction * (b.radius_mm - a.radius_mm),
            a.area_mm2 + area_share(a, b, fraction) * (b.area_mm2 - a.area_mm2)};
}

Station between(const Station& a, const Station& b, double at_mm) {
    const double fraction = (at_mm - a.at_mm) / (b.at_mm - a.at_mm);
    return {between(a.point, b.point, fraction), at_mm,
            a.area_mm2 + area_share(a.point, b.point, fraction) * (b.area_mm2 - a.area_mm2)};
}

class PathMaker {
public:
    PathMaker(const Stations& stations, double allowed_mm)
        : stations_(stations), allowed_mm_(allowed_mm) {}

    std::vector<Element> make() {
        for (const std::vector<Station>& edge : stations_)
            if (!add_plain(edge)) curve_.push_back(&edge);
        add_curve();
        return joined();
    }

private:
    // Through points that run to and fro along a line goes a circle too, nearly all of it far from them.
    bool is_as_long(const Point2& start, const Segment& segment, double line_mm) const {
        constexpr double longest_share = 1.1;
        return length_mm(start, segment) <= longest_share * line_mm + allowed_mm_;
    }

    bool add_plain(const std::vector<Station>& edge) {
        const Station &first = edge.front(), &last = edge.back();
        const Point2 start = first.point.centre, end = last.point.centre;
        const Segment arc = arc_through(start, edge[edge.size() / 2].point.centre, end);
        for (const Segment& segment : {Segment{end, 0}, arc}) {
            const bool fits = is_as_long(start, segment, last.at_mm - first.at_mm) &&
                              std::all_of(edge.begin(), edge.end(), [&](const Station& s) {
                                  return distance_mm(start, segment, s.point.centre) <=
                                         join_share * allowed_mm_ / 4;
                              });
            if (!fits) continue;
            add_curve();
            elements_.push_back({start, segment, first.at_mm, last.at_mm});
            return true;
        }
        return false;
    }

    void add_curve() {
        if (curve_.empty()) return;
        std::vector<CurvePoint> points;
        for (const std::vector<Station>* edge : curve_) {
            const Vector2 tangent = edge->front().point.tangent;
            const bool goes_on =
                !points.empty() && angle_between(points.back().tangent, tangent) < smooth_rad;
            for (std::size_t i = goes_on ? 1 : 0; i < edge->size(); ++i)
                points.push_back({(*edge)[i].point.centre, (*edge)[i].point.tangent});
        }
        std::vector<Segment> segments;
        fit_arcs(points, fit_share * allowed_mm_, segments);
        add_fitted(points.front().point, segments);
        curve_.clear();
    }

    void add_fitted(Point2 from, const std::vector<Segment>& segments) {
        const double begin = curve_.front()->front().at_mm, end = curve_.back()->back().at_mm;
        double whole = 0, done = 0;
        Point2 at = from;
        for (const Segment& segment : segments) {
            whole += length_mm(at, segment);
            at = segment.end;
        }
        for (const Segment& segment : segments) {
            const double length = length_mm(from, segment);
            elements_.push_back({from, segment, begin + (end - begin) * done / whole,
                                 begin + (end - begin) * (done + length) / whole});
            done += length;
            from = segment.end;
        }
    }

    // Elements as few as one line or arc in place of some allows.
    std::vector<Element> joined() const {
        std::vector<Element> result;
        for (std::size_t first = 0; first < elements_.size();) {
            Element best = elements_[first];
            std::size_t last = first + 1;
            while (last < elements_.size() && join(first, last, best)) ++last;
            result.push_back(best);
            first = last;
        }
        return result;
    }

    bool join(std::size_t first, std::size_t last, Element& best) const {
        const Element &a = elements_[first], &b = elements_[last];
        if (a.start == b.segment.end) return false;
        const double half = (a.from_mm + b.to_mm) / 2;
        std::size_t middle = first + 1;
        while (middle < last && elements_[middle].to_mm < half) ++middle;
        for (const Segment& segment :
             {Segment{b.segment.end, 0},
              arc_through(a.start, elements_[middle].start, b.segment.end)}) {
            const auto is_near = [&](const Point2& point) {
                return distance_mm(a.start, segment, point) <= join_share * allowed_mm_;
            };
            bool fits = is_as_long(a.start, segment, b.to_mm - a.from_mm);
            for (std::size_t i = first; i <= last && fits; ++i)
                fits = is_near(elements_[i].start) &&
                       is_near(point_at(elements_[i].start, elements_[i].segment, 0.25)) &&
                       is_near(point_at(elements_[i].start, elements_[i].segment, 0.75));
            if (!fits) continue;
            best = {a.start, segment, a.from_mm, b.to_mm};
            return true;
        }
        return false;
    }

    const Stations& stations_;
    double allowed_mm_;
    std::vector<const std::vector<Station>*> curve_;  // edges that are to be fitted
    std::vector<Element> elements_;
};

// The width along a chain, linear between its stations.
class WidthProfile {
public:
    WidthProfile(const Stations& stations, const WidthLimits& limits) : limits_(limits) {
        for (const std::vector<Station>& edge : stations)
            for (const Station& station : edge)
                knots_.push_back(
                    {station.at_mm, std::min(2 * station.point.radius_mm, limits.greatest_mm)});
    }

    bool is_constant() const {
        const auto [low, high] = std::minmax_element(
            knots_.begin(), knots_.end(),
            [](const Knot& a, const Knot& b) { return a.width_mm < b.width_mm; });
        return high->width_mm - low->width_mm <= limits_.step_mm;
    }

    double mean(double from_mm, double to_mm) const {
        const std::vector<Knot> knots = within(from_mm, to_mm);
        double sum = 0;
        for (std::size_t i = 1; i < knots.size(); ++i)
            sum += (knots[i].at_mm - knots[i - 1].at_mm) *
                   (knots[i - 1].width_mm + knots[i].width_mm) / 2;
        return to_mm > from_mm ? sum / (to_mm - from_mm) : knots.front().width_mm;
    }

    // The mean, unless that is more than half a step wider than it is somewhere.
    double fitting(double from_mm, double to_mm) const {
        double least = limits_.greatest_mm;
        for (const Knot& knot : within(from_mm, to_mm)) least = std::min(least, knot.width_mm);
        return std::min(mean(from_mm, to_mm), least + limits_.step_mm / 2);
    }

    // Places between which the width changes by no more than a step, with both ends.
    std::vector<double> cuts(double from_mm, double to_mm) const {
        const std::vector<Knot> knots = within(from_mm, to_mm);
        double change = 0;
        for (std::size_t i = 1; i < knots.size(); ++i)
            change += std::abs(knots[i].width_mm - knots[i - 1].width_mm);
        const double most = std::max(1.0, std::floor((to_mm - from_mm) / shortest_mm));
        // Round-off does not make another part.
        constexpr double share = 1e-6;
        const double parts = std::clamp(std::ceil(change / limits_.step_mm - share), 1.0, most);
        std::vector<double> places{from_mm};
        double done = 0;
        for (std::size_t i = 1; i < knots.size(); ++i) {
            const double here = std::abs(knots[i].width_mm - knots[i - 1].width_mm);
            for (double at;
                 static_cast<double>(places.size()) < parts &&
                 (at = static_cast<double>(places.size()) * change / parts) <= done + here;)
                places.push_back(knots[i - 1].at_mm +
                                 (at - done) / here * (knots[i].at_mm - knots[i - 1].at_mm));
            done += here;
        }
        places.push_back(to_mm);
        return places;
    }

private:
    struct Knot {
        double at_mm, width_mm;
    };

    double width(double at_mm) const {
        const auto after =
            std::lower_bound(knots_.begin(), knots_.end(), at_mm,
                             [](const Knot& knot, double at) { return knot.at_mm < at; });
        if (after == knots_.begin()) return knots_.front().width_mm;
        if (after == knots_.end()) return knots_.back().width_mm;
        const Knot &a = *(after - 1), &b = *after;
        return a.width_mm + (at_mm - a.at_mm) / (b.at_mm - a.at_mm) * (b.width_mm - a.width_mm);
    }

    std::vector<Knot> within(double from_mm, double to_mm) const {
        std::vector<Knot> result{{from_mm, width(from_mm)}};
        const auto first =
            std::upper_bound(knots_.begin(), knots_.end(), from_mm,
                             [](double at, const Knot& knot) { return at < knot.at_mm; });
        for (auto knot = first; knot != knots_.end() && knot->at_mm < to_mm; ++knot)
            result.push_back(*knot);
        result.push_back({to_mm, width(to_mm)});
        return result;
    }

    std::vector<Knot> knots_;
    WidthLimits limits_;
};

void append_part(const Element& element, double from, double to, Path& path) {
    const Point2 start = path.segments.empty() ? path.start : path.segments.back().end;
    const Point2 end = to == 1 ? element.segment.end : point_at(element.start, element.segment, to);
    if (element.segment.sagitta_mm == 0)
        path.segments.push_back({end, 0});
    else
        path.segments.push_back(
            arc_with_sweep(start, end, (to - from) * sweep_rad(element.start, element.segment)));
}

}  // namespace

Stations stations_of(const MedialChain& chain) {
    Stations stations;
    double at = 0, area = 0;
    for (const MedialEdge& edge : chain.edges) {
        std::vector<Station>& list = stations.emplace_back();
        for (std::size_t i = 0; i < edge.points.size(); ++i) {
            if (i > 0) at += (edge.points[i].centre - edge.points[i - 1].centre).norm();
            list.push_back({edge.points[i], at, area + edge.points[i].area_mm2});
        }
        area += edge.points.back().area_mm2;
    }
    return stations;
}

Stations part(const Stations& stations, double from_mm, double to_mm) {
    Stations result;
    for (const std::vector<Station>& edge : stations) {
        std::vector<Station> list;
        const auto add = [&](const Station& station) {
            if (list.empty() || station.at_mm > list.back().at_mm) list.push_back(station);
        };
        for (std::size_t i = 0; i < edge.size(); ++i) {
            if (i > 0)
                for (const double cut : {from_mm, to_mm})
                    if (edge[i - 1].at_mm < cut && cut < edge[i].at_mm)
                        add(between(edge[i - 1], edge[i], cut));
            if (from_mm <= edge[i].at_mm && edge[i].at_mm <= to_mm) add(edge[i]);
        }
        if (list.size() > 1) result.push_back(std::move(list));
    }
    return result;
}

Strand strand_along(const Stations& stations, bool is_closed, const WidthLimits& limits,
                    double allowed_mm) {
    const std::vector<Element> elements = PathMaker(stations, allowed_mm).make();
    const WidthProfile width(stations, limits);
    Path path{elements.front().start, {}};
    Strand strand;
    const bool is_constant = width.is_constant();
    for (const Element& element : elements) {
        const std::vector<double> cuts = is_constant ? std::vector{element.from_mm, element.to_mm}
                                                     : width.cuts(element.from_mm, element.to_mm);
        const double length = element.to_mm - element.from_mm;
        for (std::size_t i = 1; i < cuts.size(); ++i) {
            const double from = (cuts[i - 1] - element.from_mm) / length;
            const double to = i + 1 == cuts.size() ? 1 : (cuts[i] - element.from_mm) / length;
            append_part(element, from, to, path);
            if (!is_constant) strand.widths_mm.push_back(width.fitting(cuts[i - 1], cuts[i]));
        }
    }
    if (is_closed) path.segments.back().end = path.start;
    strand.width_mm = width.mean(elements.front().from_mm, elements.back().to_mm);
    strand.path = path;
    if (is_closed && is_constant)
        if (auto simple = simplified(path, join_share * allowed_mm)) strand.path = *simple;
    return strand;
}

}  // namespace lyr
