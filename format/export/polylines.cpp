#include "format/export/polylines.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "format/arc.h"

namespace lyr::format {
namespace {

bool is_wall(Role role) {
    return role == Role::outer_wall || role == Role::inner_wall || role == Role::overhang_wall;
}

double gap_mm(const std::vector<PlanePoint>& line) {
    return std::hypot(line.front()[0] - line.back()[0], line.front()[1] - line.back()[1]);
}

}  // namespace

double area_mm2(const std::vector<PlanePoint>& closed) {
    double twice = 0;
    for (std::size_t i = 0; i < closed.size(); ++i) {
        const PlanePoint& a = closed[i];
        const PlanePoint& b = closed[(i + 1) % closed.size()];
        twice += a[0] * b[1] - a[1] * b[0];
    }
    return twice / 2;
}

PlanePoint PolylineCollector::in_mm(const Point& point) const {
    return {quantum_.mm(point.x), quantum_.mm(point.y)};
}

Polyline& PolylineCollector::open(const Point& from, const PathStyle& style, bool hatch) {
    const auto goes_on = [&](const Polyline& last) {
        if (last.hatch != hatch) return false;
        if (hatch) return last.role == style.role;
        return from.x == at_.x && from.y == at_.y &&
               (last.role == style.role || (is_wall(last.role) && is_wall(style.role)));
    };
    if (drawing_ && goes_on(done_.back())) return done_.back();
    close();
    done_.push_back({.role = style.role, .width_mm = style.width_mm, .hatch = hatch});
    if (!hatch) done_.back().points.push_back(in_mm(from));
    begin_ = from;
    drawing_ = true;
    return done_.back();
}

void PolylineCollector::close() {
    if (!drawing_) return;
    drawing_ = false;
    Polyline& last = done_.back();
    constexpr std::size_t least = 3;
    if (last.hatch || last.points.size() <= least) return;
    const bool meets = begin_.x == at_.x && begin_.y == at_.y;
    last.closed = meets || (is_wall(last.role) && gap_mm(last.points) < last.width_mm);
    if (meets) last.points.pop_back();
}

void PolylineCollector::turn(double center_x, double center_y, const Point& from, double sweep_rad,
                             const Point& to, const PathStyle& style) {
    Polyline& line = open(from, style, false);
    const double dx = static_cast<double>(from.x) - center_x;
    const double dy = static_cast<double>(from.y) - center_y;
    const double unit = quantum_.mm(1), radius_mm = unit * std::hypot(dx, dy);
    const double widest_rad = 2 * std::acos(std::max(0.0, 1 - tolerance_mm_ / radius_mm));
    const auto count = static_cast<int>(std::max(1.0, std::ceil(std::abs(sweep_rad) / widest_rad)));
    for (int i = 1; i < count; ++i) {
        const double angle = sweep_rad * i / count;
        const double c = std::cos(angle), s = std::sin(angle);
        line.points.push_back(
            {unit * (center_x + c * dx - s * dy), unit * (center_y + s * dx + c * dy)});
    }
    line.points.push_back(in_mm(to));
    at_ = to;
}

void PolylineCollector::take(const Operation& operation, const PathStyle& style) {
    if (const auto* line = std::get_if<Line>(&operation)) {
        Polyline& polyline = open(line->from, style, line->hatch);
        if (line->hatch) polyline.points.push_back(in_mm(line->from));
        polyline.points.push_back(in_mm(line->to));
        at_ = line->to;
    } else if (const auto* arc = std::get_if<Arc>(&operation)) {
        const ArcShape shape = arc_shape(*arc);
        turn(shape.center_x, shape.center_y, arc->from, shape.sweep_rad, arc->to, style);
    } else if (const auto* circle = std::get_if<Circle>(&operation)) {
        constexpr double whole = 2 * std::numbers::pi;
        close();  // a circle is closed by itself
        turn(static_cast<double>(circle->center_x), static_cast<double>(circle->center_y),
             circle->from, circle->counter_clockwise ? whole : -whole, circle->to, style);
        close();
    }
}

std::vector<Polyline> PolylineCollector::finish() {
    close();
    return std::exchange(done_, {});
}

}  // namespace lyr::format
