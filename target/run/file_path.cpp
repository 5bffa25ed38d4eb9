// Each operation appends its curves to a short queue, which next() hands out.

#include "target/run/file_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

namespace lyr::run {
namespace {

using config::axis_e;
using config::axis_x;
using config::axis_y;
using config::axis_z;

using std::numbers::pi;

double length_mm(const PathCurve& curve) {
    const double rise = curve.to_mm[axis_z] - curve.from_mm[axis_z];
    const double flat = curve.is_arc ? curve.radius_mm * std::abs(curve.sweep_rad)
                                     : std::hypot(curve.to_mm[axis_x] - curve.from_mm[axis_x],
                                                  curve.to_mm[axis_y] - curve.from_mm[axis_y]);
    return std::hypot(flat, rise);
}

}  // namespace

FilePath::FilePath(format::Reader reader, const std::array<double, 3>& start_mm,
                   double filament_diameter_mm)
    : reader_(std::move(reader)),
      quantum_(reader_.header().quantum),
      filament_area_mm2_(pi / 4 * filament_diameter_mm * filament_diameter_mm) {
    for (std::size_t i = 0; i < start_mm.size(); ++i) at_mm_[i] = start_mm[i];
}

Result<bool> FilePath::next(PathCurve& curve) {
    while (waiting_from_ == waiting_to_) {
        waiting_from_ = waiting_to_ = 0;
        const Result<std::optional<format::Operation>> operation = reader_.next();
        if (!operation) return operation.error();
        if (!*operation) return false;
        std::visit([this](const auto& what) { visit(what); }, **operation);
    }
    curve = waiting_[waiting_from_++];
    return true;
}

// z first on the way up and last on the way down, so that the head never cuts through the print.
void FilePath::visit(const format::LayerStart& layer) {
    ++totals_.layers;
    const format::LayerState& state = reader_.layer().state;
    for (const format::HeaterTarget& target : state.temperatures)
        visit(format::Temperature{target.heater, target.target_c, first_layer_});
    for (const format::Fan& fan : state.fans) visit(fan);
    visit(format::Tool{state.tool});
    const double drawn_back_mm = state.retracted_mm;
    if (first_layer_) drawn_back_mm_ = begins_drawn_back_mm_.value_or(drawn_back_mm);
    first_layer_ = false;
    draw_back(drawn_back_mm);
    const AxisValues start_mm = position(layer.start);
    AxisValues corner_mm = at_mm_;
    if (start_mm[axis_z] > at_mm_[axis_z])
        corner_mm[axis_z] = start_mm[axis_z];
    else
        corner_mm[axis_x] = start_mm[axis_x], corner_mm[axis_y] = start_mm[axis_y];
    straight(corner_mm, false);
    straight(start_mm, false);
}

void FilePath::visit(const format::Line& line) {
    straight(position(line.to), true);
}

void FilePath::visit(const format::Travel& travel) {
    straight(position(travel.to), false);
}

void FilePath::visit(const format::Retract& retract) {
    draw_back(retract.depth_mm);
}

void FilePath::visit(const format::Temperature& temperature) {
    if (temperature.heater.kind == format::HeaterKind::tool)
        sure_tool_c_ =
            temperature.wait ? temperature.target_c : std::min(sure_tool_c_, temperature.target_c);
    if (!(temperature.target_c > 0)) return;
    for (format::HeaterTarget& known : demands_.hottest)
        if (known.heater == temperature.heater) {
            known.target_c = std::max(known.target_c, temperature.target_c);
            return;
        }
    demands_.hottest.push_back({temperature.heater, temperature.target_c});
}

void FilePath::visit(const format::Fan& fan) {
    const auto known = std::find(demands_.fans.begin(), demands_.fans.end(), fan.fan);
    if (fan.duty > 0 && known == demands_.fans.end()) demands_.fans.push_back(fan.fan);
}

void FilePath::visit(const format::Tool& tool) {
    demands_.highest_tool = std::max(demands_.highest_tool, tool.tool);
}

void FilePath::visit(const format::Pause&) {
    ++demands_.pauses;
}

void FilePath::visit(const format::Arc& arc) {
    turn(bent(arc.from, arc.to, arc.sagitta), arc.to);
}

// Shares the rest of the way to the depth out by length.
void FilePath::visit(const format::Wipe& wipe) {
    PathCurve curve;
    if (wipe.sagitta != 0) curve = bent(wipe.from, wipe.to, wipe.sagitta);
    curve.from_mm = at_mm_;
    curve.to_mm = position(wipe.to);
    const double way_mm = length_mm(curve);
    totals_.travelled_mm += way_mm;
    // All the rest on the last piece: what is less than a quantum longer is so by rounding.
    const bool is_last = wipe.left_mm - way_mm < quantum_.mm(1) / 2;
    const double due_mm = wipe.depth_mm - drawn_back_mm_;
    const double drawn_mm = is_last ? due_mm : due_mm * way_mm / wipe.left_mm;
    drawn_back_mm_ = is_last ? wipe.depth_mm : drawn_back_mm_ + drawn_mm;
    curve.to_mm[axis_e] = fed_mm(-drawn_mm);
    append(curve);
}

// The middle lies off the chord's middle by the sagitta, to the right of the way if that is positive.
PathCurve FilePath::bent(const format::Point& from, const format::Point& to,
                         std::int64_t sagitta) const {
    const double quantum_mm = quantum_.mm(1);
    const double dx = at_mm_[axis_x], dy = at_mm_[axis_y];
    const double bx = static_cast<double>(to.x - from.x) * quantum_mm;
    const double by = static_cast<double>(to.y - from.y) * quantum_mm;
    const double chord_mm = std::hypot(bx, by);
    const double sagitta_mm = static_cast<double>(sagitta) * quantum_mm;
    const double mx = bx / 2 + sagitta_mm * by / chord_mm;
    const double my = by / 2 - sagitta_mm * bx / chord_mm;
    // Circumcentre of the triangle (0, 0), (bx, by), (mx, my).
    const double twice_area = 2 * (bx * my - by * mx);
    const double b2 = bx * bx + by * by, m2 = mx * mx + my * my;
    const double cx = (my * b2 - by * m2) / twice_area;
    const double cy = (bx * m2 - mx * b2) / twice_area;
    PathCurve curve;
    curve.is_arc = true;
    curve.center_x_mm = dx + cx;
    curve.center_y_mm = dy + cy;
    curve.radius_mm = std::hypot(cx, cy);
    curve.start_angle_rad = std::atan2(-cy, -cx);
    double sweep_rad = std::atan2(by - cy, bx - cx) - curve.start_angle_rad;
    if (sagitta > 0 && sweep_rad <= 0) sweep_rad += 2 * pi;
    if (sagitta < 0 && sweep_rad >= 0) sweep_rad -= 2 * pi;
    curve.sweep_rad = sweep_rad;
    return curve;
}

void FilePath::visit(const format::Circle& circle) {
    PathCurve curve;
    curve.is_arc = true;
    curve.center_x_mm = quantum_.mm(circle.center_x);
    curve.center_y_mm = quantum_.mm(circle.center_y);
    const double rx = at_mm_[axis_x] - curve.center_x_mm, ry = at_mm_[axis_y] - curve.center_y_mm;
    curve.radius_mm = std::hypot(rx, ry);
    curve.start_angle_rad = std::atan2(ry, rx);
    curve.sweep_rad = circle.counter_clockwise ? 2 * pi : -2 * pi;
    turn(curve, circle.to);
}

AxisValues FilePath::position(const format::Point& point) const {
    return {quantum_.mm(point.x), quantum_.mm(point.y), quantum_.mm(point.z), at_mm_[axis_e]};
}

void FilePath::draw_back(double depth_mm) {
    const double feed_mm = drawn_back_mm_ - depth_mm;
    drawn_back_mm_ = depth_mm;
    if (feed_mm == 0) return;
    if (feed_mm > 0) note_pushing();
    PathCurve curve;
    curve.to_mm = at_mm_;
    curve.to_mm[axis_e] = fed_mm(feed_mm);
    append(curve);
}

void FilePath::straight(const AxisValues& to_mm, bool extrudes) {
    if (to_mm == at_mm_) return;
    PathCurve curve;
    curve.from_mm = at_mm_;
    curve.to_mm = to_mm;
    const double way_mm = length_mm(curve);
    (extrudes ? totals_.extruded_mm : totals_.travelled_mm) += way_mm;
    if (extrudes) extrude(curve, way_mm);
    append(curve);
}

void FilePath::turn(PathCurve curve, const format::Point& to) {
    curve.from_mm = at_mm_;
    curve.to_mm = position(to);
    const double way_mm = length_mm(curve);
    totals_.extruded_mm += way_mm;
    extrude(curve, way_mm);
    append(curve);
}

void FilePath::append(const PathCurve& curve) {
    PathCurve& next = waiting_[waiting_to_++];
    next = curve;
    next.from_mm = at_mm_;
    next.layer = totals_.layers - 1;
    at_mm_ = next.to_mm;
    ++totals_.motions;
}

void FilePath::extrude(PathCurve& curve, double way_mm) {
    const double filament_mm =
        way_mm * format::cross_section_mm2(reader_.path()) / filament_area_mm2_;
    totals_.filament_mm += filament_mm;
    if (!(reader_.path().speed_mm_s > 0) && !demands_.still_layer)
        demands_.still_layer = totals_.layers;
    if (filament_mm > 0) note_pushing();
    curve.to_mm[axis_e] = fed_mm(filament_mm);
}

void FilePath::note_pushing() {
    if (demands_.coldest_extrusion_c && *demands_.coldest_extrusion_c <= sure_tool_c_) return;
    demands_.coldest_extrusion_c = sure_tool_c_;
    demands_.coldest_layer = totals_.layers;
}

double FilePath::fed_mm(double feed_mm) {
    const double due_mm = feed_mm - feed_error_mm_;
    const double sum_mm = at_mm_[axis_e] + due_mm;
    feed_error_mm_ = (sum_mm - at_mm_[axis_e]) - due_mm;
    return sum_mm;
}

}  // namespace lyr::run
