// Small prints for tests, made with the writer of the format. Each can be turned and mirrored.

#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "format/writer.h"
#include "scratch.h"

namespace lyr::tests {

// Turns about the origin, then mirrors at the y axis if asked, then moves.
struct Frame {
    double angle_rad = 0;
    bool mirrored = false;
    double x_mm = 40, y_mm = 30;

    double x(double px, double py) const {
        const double turned = px * std::cos(angle_rad) - py * std::sin(angle_rad);
        return x_mm + (mirrored ? -turned : turned);
    }
    double y(double px, double py) const {
        return y_mm + px * std::sin(angle_rad) + py * std::cos(angle_rad);
    }
    // Mirroring swaps the senses of rotation.
    double sagitta(double mm) const { return mirrored ? -mm : mm; }
};

// Draws on one layer, in a frame.
struct Pen {
    format::LayerEncoder& layer;
    const Frame& frame;

    void travel(double x, double y) const { layer.travel_to(frame.x(x, y), frame.y(x, y)); }
    void line(double x, double y) const { layer.line_to(frame.x(x, y), frame.y(x, y)); }
    void line(double x, double y, double z) const {
        layer.line_to(frame.x(x, y), frame.y(x, y), z);
    }
    void arc(double x, double y, double sagitta) const {
        layer.arc_to(frame.x(x, y), frame.y(x, y), frame.sagitta(sagitta));
    }
    void circle(double cx, double cy, bool counter_clockwise) const {
        layer.circle(frame.x(cx, cy), frame.y(cx, cy), counter_clockwise != frame.mirrored);
    }
    void path(double speed_mm_s = 60) const {
        layer.begin_path({.role = format::Role::outer_wall,
                          .width_mm = 0.45,
                          .height_mm = 0.2,
                          .flow = 1,
                          .speed_mm_s = speed_mm_s,
                          .acceleration_mm_s2 = 0});
    }
};

using Drawing = std::function<void(const Pen&)>;

inline void draw_square(const Pen& pen) {
    pen.path();
    pen.travel(0, 0);
    pen.line(20, 0);
    pen.line(20, 20);
    pen.line(0, 20);
    pen.line(0, 0);
}

inline void draw_circles(const Pen& pen) {
    pen.path(80);
    pen.travel(10, 0);
    pen.circle(0, 0, true);
    pen.circle(2, 0, false);
    pen.path(20);
    pen.travel(0.15, 0);
    pen.circle(0, 0, true);  // a tenth of a millimetre
}

// Arcs of both senses from next to nothing to three quarters of a turn, tangent and not.
inline void draw_arcs(const Pen& pen) {
    pen.path();
    pen.travel(0, 0);
    for (const double sign : {1.0, -1.0}) {
        pen.arc(10, 0, sign * 0.002);
        pen.arc(20, 4, sign * 0.5);
        pen.arc(24, 14, sign * 4);
        pen.arc(14, 20, sign * std::hypot(10, 6) / 2);  // half a turn
        pen.arc(4, 16, sign * 9);
        pen.arc(0, 10, sign * 1.2 * std::hypot(4, 6));  // almost three quarters
        pen.line(0, 0);
    }
}

inline void draw_hatch(const Pen& pen) {
    pen.path(100);
    std::vector<format::HatchRow> rows(12, {1, true});
    rows[0].linked = false;
    rows[4] = {2, false};
    rows[5] = {0, false};
    rows[6] = {1, false};
    std::vector<format::HatchInterval> intervals(11, {-8, 8});
    intervals.insert(intervals.begin() + 4, {-8, -2});
    intervals[5] = {1, 8};
    const double angle = pen.frame.angle_rad + std::numbers::pi / 4;
    pen.layer.hatch({.direction_x = std::cos(angle),
                     .direction_y = std::sin(angle),
                     .offset_mm = 12,
                     .pitch_mm = pen.frame.mirrored ? -0.4 : 0.4,
                     .one_way = false,
                     .rows = rows,
                     .intervals = intervals});
}

inline void draw_small(const Pen& pen) {
    pen.path(80);
    pen.travel(0, 0);
    pen.line(4, 0);
    pen.arc(4, 4, 1);
    pen.line(0, 0);
}

// A wall that climbs, a retraction, a rest, a change of width and speed.
inline void draw_climb(const Pen& pen) {
    pen.path(50);
    pen.travel(0, 0);
    const double base_mm = static_cast<double>(pen.layer.position().z) * 1e-3;
    pen.line(6, 0, base_mm + 0.05);
    pen.line(6, 6, base_mm + 0.1);
    pen.layer.width(0.6);
    pen.layer.speed(30);
    pen.line(0, 6, base_mm + 0.15);
    pen.layer.retract();
    pen.layer.travel_to(pen.frame.x(3, 3), pen.frame.y(3, 3), base_mm);
    pen.layer.dwell(20);
    pen.layer.unretract();
    pen.layer.acceleration(500);
    pen.line(0, 0);
}

// Wipes along lines and arcs, from not retracted and from half, and a layer that ends with one.
inline void draw_wipes(const Pen& pen) {
    pen.path();
    const auto wipe = [&](std::initializer_list<format::WipePiece> pieces, double depth_mm) {
        std::vector<format::WipePiece> placed;
        for (const auto& [x, y, sagitta] : pieces)
            placed.push_back({pen.frame.x(x, y), pen.frame.y(x, y), pen.frame.sagitta(sagitta)});
        pen.layer.wipe(placed, depth_mm);
        pen.layer.retract_to(depth_mm);
    };
    pen.travel(0, 0);
    pen.arc(10, 0, 3);
    wipe({{6, -2.9, -0.3}, {5, -3, 0}}, 0.8);
    pen.travel(0, 20);
    pen.layer.unretract();
    pen.line(8, 20);
    pen.layer.retract_to(0.3);
    wipe({{4, 20, 0}, {4, 20.01, 0}, {4.002, 20.01, 0}, {4, 24, -2.1}}, 0.8);
    const auto rise = static_cast<double>(pen.layer.position().z) * 1e-3 + 0.4;
    pen.layer.travel_to(pen.frame.x(4, 24), pen.frame.y(4, 24), rise);
    pen.layer.travel_to(pen.frame.x(0, 0), pen.frame.y(0, 0), rise - 0.4);
    pen.layer.unretract();
    pen.circle(5, 0, false);
    wipe({{5, 5, -5 * (1 - std::cos(std::numbers::pi / 4))}}, 0.8);
}

struct Case {
    const char* name;
    Drawing drawing;
};

inline const std::vector<Case>& all_cases() {
    static const std::vector<Case> cases{{"square", draw_square}, {"circles", draw_circles},
                                         {"arcs", draw_arcs},     {"hatch", draw_hatch},
                                         {"climb", draw_climb},   {"wipes", draw_wipes}};
    return cases;
}

constexpr double layer_height_mm = 0.2;

inline format::LayerState layer_state(std::size_t index) {
    format::LayerState state;
    state.z_mm = layer_height_mm * static_cast<double>(index + 1);
    state.height_mm = layer_height_mm;
    state.start_x_mm = 35;
    state.start_y_mm = 25;
    state.retract_length_mm = 0.8;
    state.retract_speed_mm_s = 40;
    state.unretract_speed_mm_s = 30;
    return state;
}

using StateChange = std::function<void(format::LayerState&)>;

inline constexpr format::Heater tool{format::HeaterKind::tool, 0}, bed{format::HeaterKind::bed, 0};

inline StateChange heated(double tool_c, double bed_c) {
    return [=](format::LayerState& state) {
        state.temperatures.push_back({bed, bed_c});
        state.temperatures.push_back({tool, tool_c});
    };
}

// What went wrong; empty if nothing did.
template <class Value>
std::string message_of(const Result<Value>& result) {
    return result ? std::string() : to_string(result.error());
}

// One layer a drawing; returns the path of the file.
inline std::string write_print(const std::string& name, const std::vector<Drawing>& drawings,
                               const Frame& frame = {}, const StateChange& change = {}) {
    const std::string path = scratch(name + ".lyr");
    const format::Quantum quantum;
    Result<format::Writer> writer = format::Writer::create(path, quantum, {});
    REQUIRE(writer.ok());
    for (std::size_t i = 0; i < drawings.size(); ++i) {
        format::LayerState state = layer_state(i);
        if (change) change(state);
        format::LayerEncoder layer(quantum, state);
        drawings[i]({layer, frame});
        const Result<format::EncodedLayer> encoded = layer.finish();
        REQUIRE_MESSAGE(encoded.ok(), (encoded.ok() ? "" : encoded.error().message));
        REQUIRE(writer->append(*encoded).ok());
    }
    REQUIRE(writer->finish().ok());
    return path;
}

}  // namespace lyr::tests
