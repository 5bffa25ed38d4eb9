// The lean is followed along each span of a face's section, between places so dense that it does little between them.

#include "kernel/section/leaning.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "kernel/section/cutter.h"

namespace lyr {
namespace {

constexpr double step_rad = std::numbers::pi / 12;

// At least so many parts of a span, whatever it is.
constexpr int least_parts = 4;

// Of a free-form surface's parameters, found from a neighbour's: farther off, they are those of another place.
constexpr double farthest_foot_mm = 0.05;

// What the section runs along has the same normal all the way.
bool is_uniform(const SurfaceSection& section) {
    return std::holds_alternative<LineSection>(section) ||
           std::holds_alternative<GeneratorSection>(section) ||
           std::holds_alternative<CircleSection>(section) ||
           std::holds_alternative<TouchSection>(section);
}

struct Look {
    double key, over_rad;  // the limit; negative: under it
};

// Of one component: the lean at its keys.
class LeanAlong {
public:
    LeanAlong(const Face& face, const SurfaceSection& section, int component, double z_mm,
              double limit_rad)
        : face_(face),
          section_(section),
          component_(component),
          z_mm_(z_mm),
          limit_rad_(limit_rad + lean_resolution_rad) {}

    double over_rad(double key) {
        const Point2 point = at(section_, {component_, key}).point;
        return over_rad(Point3(point.x(), point.y(), z_mm_));
    }

    double over_rad(const Point3& point) {
        const Vector3 outward = (face_.same_sense ? 1 : -1) * normal(face_.surface, foot(point));
        return std::asin(std::clamp(-outward.z(), -1.0, 1.0)) - limit_rad_;
    }

    std::vector<Look> looks(double from, double to) {
        std::vector<Look> result;
        for (const double key : keys(from, to)) result.push_back({key, over_rad(key)});
        add_extremes(result);
        return result;
    }

    // Between a place over the limit and one under it.
    double division(const Look& a, const Look& b) {
        constexpr int halvings = 40;
        double low = a.key, high = b.key;
        for (int i = 0; i < halvings; ++i) {
            const double middle = (low + high) / 2;
            ((over_rad(middle) > 0) == (a.over_rad > 0) ? low : high) = middle;
        }
        return (low + high) / 2;
    }

private:
    // Neighbours on a free-form surface are asked one after the other.
    Point2 foot(const Point3& point) {
        const auto* shared = std::get_if<SharedBSplineSurface>(&face_.surface);
        if (!shared) return invert(face_.surface, point);
        const BSplineSurface& surface = **shared;
        if (known_) {
            guess_ = invert_near(surface, point, guess_);
            if ((evaluate(surface, guess_) - point).norm() <= farthest_foot_mm) return guess_;
        }
        known_ = true;
        return guess_ = invert(surface, point, farthest_foot_mm);
    }

    std::vector<double> keys(double from, double to) const {
        const auto* freeform = std::get_if<FreeformSection>(&section_);
        const double turn = period(section_, component_);
        std::vector<double> corners{from};
        if (freeform) {
            const auto& own = freeform->curves[static_cast<std::size_t>(component_)].key;
            const double first = turn > 0 ? turn * std::floor(from / turn) : 0;
            for (double base = first; base < to; base += turn) {
                for (const double key : own)
                    if (base + key > corners.back() + look_mm && base + key < to)
                        corners.push_back(base + key);
                if (turn == 0) break;
            }
        }
        corners.push_back(to);
        const double part = freeform ? to - from : step_rad;
        const auto all = static_cast<int>(corners.size()) - 1;
        std::vector<double> result{from};
        for (std::size_t i = 1; i < corners.size(); ++i) {
            const double length = corners[i] - corners[i - 1];
            const int parts = std::max(
                {1, static_cast<int>(std::ceil(length / part)), (least_parts + all - 1) / all});
            for (int k = 1; k <= parts; ++k) result.push_back(corners[i - 1] + length * k / parts);
        }
        return result;
    }

    // Where the lean is greatest or least between two places that are on the same side of the limit.
    void add_extremes(std::vector<Look>& looks) {
        std::vector<Look> extremes;
        for (std::size_t i = 1; i + 1 < looks.size(); ++i) {
            const Look &a = looks[i - 1], &b = looks[i], &c = looks[i + 1];
            const bool over = b.over_rad > 0;
            if ((a.over_rad > 0) != over || (c.over_rad > 0) != over) continue;
            const double left = (a.over_rad - b.over_rad) / (a.key - b.key);
            const double right = (c.over_rad - b.over_rad) / (c.key - b.key);
            if (over ? !(left < 0 && right > 0) : !(left > 0 && right < 0)) continue;
            const double bend = (right - left) / (c.key - a.key);
            const double slope = left + bend * (b.key - a.key);  // at b
            const double key = std::clamp(b.key - slope / (2 * bend), a.key, c.key);
            const double there = over_rad(key);
            if ((there > 0) != over) extremes.push_back({key, there});
        }
        looks.insert(looks.end(), extremes.begin(), extremes.end());
        std::sort(looks.begin(), looks.end(),
                  [](const Look& a, const Look& b) { return a.key < b.key; });
    }

    const Face& face_;
    const SurfaceSection& section_;
    int component_;
    double z_mm_, limit_rad_;
    Point2 guess_ = Point2::Zero();
    bool known_ = false;
};

// Of one face: appends its spans, divided.
class Divider {
public:
    Divider(FaceId id, const Face& face, const SurfaceSection& section, double z_mm,
            double limit_rad, const Tolerance& tolerance, std::vector<LeaningSpan>& result)
        : id_(id),
          face_(face),
          section_(section),
          z_mm_(z_mm),
          limit_rad_(limit_rad),
          tolerance_(tolerance),
          result_(result) {}

    void append(const Span& span, const Point2& start, const Point2& end) {
        LeanAlong lean(face_, section_, std::max(span.component, 0), z_mm_, limit_rad_);
        if (span.component < 0 || is_uniform(section_)) {
            const Point2 on = (start + end) / 2;
            const bool straight = !std::holds_alternative<CircleSection>(section_);
            const double over = span.component < 0 || straight
                                    ? lean.over_rad(Point3(on.x(), on.y(), z_mm_))
                                    : lean.over_rad(span.from);
            add(span, span.from, span.to, start, end, over, over);
            return;
        }
        const std::vector<Look> looks = lean.looks(span.from, span.to);
        double from = span.from, most = looks.front().over_rad;
        Point2 first = start;
        for (std::size_t i = 1; i < looks.size(); ++i) {
            const Look &before = looks[i - 1], &look = looks[i];
            if ((before.over_rad > 0) != (look.over_rad > 0)) {
                const double key = lean.division(before, look);
                const Point2 point = at(section_, {span.component, key}).point;
                add(span, from, key, first, point, before.over_rad, most);
                from = key;
                first = point;
                most = look.over_rad;
            }
            most = std::max(most, look.over_rad);
        }
        add(span, from, span.to, first, end, looks.back().over_rad, most);
    }

private:
    void add(const Span& span, double from, double to, const Point2& start, const Point2& end,
             double over_rad, double most_over_rad) {
        if (!(over_rad > 0)) return;
        Path path{start, {}};
        if (span.component < 0) {
            path.segments.push_back({end});
        } else {
            trace(section_, span.component, from, to, start, end, tolerance_, path.segments);
        }
        result_.push_back({id_, std::move(path), most_over_rad + limit_rad_ + lean_resolution_rad});
    }

    FaceId id_;
    const Face& face_;
    const SurfaceSection& section_;
    double z_mm_, limit_rad_;
    const Tolerance& tolerance_;
    std::vector<LeaningSpan>& result_;
};

}  // namespace

std::vector<LeaningSpan> Cutter::leaning(double z_mm, double limit_rad) const {
    std::vector<LeaningSpan> result;
    Work work{.z_mm = clear_of_levels(z_mm)};
    find_crossings(work);
    for_faces(work, [&](FaceId id, std::span<const Event> events, bool whole) {
        const SurfaceSection section = section_at(id, work.z_mm);
        Divider divider(id, model_[id], section, work.z_mm, limit_rad, tolerance_, result);
        const FaceSpans spans = paired(section, events, work);
        for (const Span& span : spans.spans)
            divider.append(span, work.crossings[span.enter].point.head<2>(),
                           work.crossings[span.leave].point.head<2>());
        if (!whole) return;
        for (const int component : whole_components(id, section, spans.crossed, work.z_mm)) {
            const Point2 start = at(section, {component, 0}).point;
            divider.append({0, 0, component, 0, period(section, component)}, start, start);
        }
    });
    return result;
}

}  // namespace lyr
