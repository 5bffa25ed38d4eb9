// Contract of slicer/estimate.h, by number, on layers that are made by hand.

#include "slicer/estimate.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

using namespace lyr;
using namespace lyr::slicer;

namespace {

constexpr double diameter_mm = 1.75;

using Draw = std::function<void(format::LayerEncoder&)>;

format::LayerState state_at(double x_mm, double y_mm) {
    format::LayerState state;
    state.z_mm = state.height_mm = 0.2;
    state.start_x_mm = x_mm;
    state.start_y_mm = y_mm;
    state.retract_length_mm = 0.8;
    state.retract_speed_mm_s = state.unretract_speed_mm_s = 40;
    return state;
}

format::EncodedLayer layer_of(const Draw& draw, const format::LayerState& state = state_at(0, 0)) {
    format::LayerEncoder encoder({1000}, state);
    draw(encoder);
    auto layer = encoder.finish();
    REQUIRE(layer.ok());
    return std::move(*layer);
}

format::PathStyle style_of(format::Role role) {
    return {.role = role, .width_mm = 0.45, .height_mm = 0.2, .speed_mm_s = 60};
}

Estimator estimator() {
    return {config::generic_printer(), diameter_mm};
}

LayerEstimate estimated(const format::EncodedLayer& layer) {
    const auto estimate = estimator().layer(layer, 0);
    REQUIRE(estimate.ok());
    return *estimate;
}

const RoleEstimate& of(const Estimate& estimate, format::Role role) {
    return estimate.roles[static_cast<std::size_t>(role)];
}

// From rest to rest, at a speed that is reached.
double duration_s(double length_mm, double speed_mm_s, double acceleration_mm_s2) {
    return length_mm / speed_mm_s + speed_mm_s / acceleration_mm_s2;
}

struct Leg {
    double x_mm, y_mm, sagitta_mm;  // 0: a line
};
// Around 30 mm, with corners, bends and short pieces.
const std::vector<Leg> trail{{40, 0, 0},     {40, 20, -3},    {38, 21, 0.4}, {37.8, 21.3, 0},
                             {37.5, 22, 0.}, {10, 22.5, 4.5}, {10, 5, 0},    {0, 0, 1}};

// The trail through a map of points; `back`: from its end, `mirrored`: bends to the other side.
Estimate along_trail(const std::function<Leg(const Leg&)>& map, bool back) {
    std::vector<Leg> legs{map({0, 0, 0})};
    for (const Leg& leg : trail) legs.push_back(map(leg));
    if (back) {
        std::vector<Leg> reversed{{legs.back().x_mm, legs.back().y_mm, 0}};
        for (std::size_t i = legs.size() - 1; i > 0; --i)
            reversed.push_back({legs[i - 1].x_mm, legs[i - 1].y_mm, -legs[i].sagitta_mm});
        legs = reversed;
    }
    const Draw draw = [&](format::LayerEncoder& layer) {
        layer.begin_path(style_of(format::Role::outer_wall));
        for (std::size_t i = 1; i < legs.size(); ++i) {
            if (legs[i].sagitta_mm == 0) {
                layer.line_to(legs[i].x_mm, legs[i].y_mm);
            } else {
                layer.arc_to(legs[i].x_mm, legs[i].y_mm, legs[i].sagitta_mm);
            }
        }
    };
    return estimated(layer_of(draw, state_at(legs[0].x_mm, legs[0].y_mm))).estimate;
}

}  // namespace

TEST_CASE("estimate 1: speeding up, even speed and slowing down of one line, and its material") {
    const auto [estimate, end] = estimated(layer_of([](format::LayerEncoder& layer) {
        layer.begin_path(style_of(format::Role::outer_wall));
        layer.line_to(30, 0);
    }));
    CHECK(estimate.time_s() == doctest::Approx(duration_s(30, 60, 3'000)));
    const RoleEstimate& wall = of(estimate, format::Role::outer_wall);
    CHECK(wall.length_mm == doctest::Approx(30));
    CHECK(wall.volume_mm3 ==
          doctest::Approx(30 * format::cross_section_mm2(style_of(format::Role::outer_wall))));
    CHECK(estimate.travel_mm == 0);
    CHECK(end.at == motion::Point{30, 0, 0.2});
}

TEST_CASE("estimate 1: a layer of nothing takes no time") {
    const auto [estimate, end] = estimated(layer_of([](format::LayerEncoder&) {}));
    CHECK(estimate.time_s() == 0);
    CHECK(estimate.travel_mm == 0);
    CHECK(end.at == motion::Point{0, 0, 0.2});
}

TEST_CASE("estimate 1: turned, mirrored or walked back, a trail takes the same time") {
    const Estimate plain = along_trail([](const Leg& leg) { return leg; }, false);
    CHECK(plain.time_s() > of(plain, format::Role::outer_wall).length_mm / 60);
    const std::vector<std::function<Leg(const Leg&)>> maps{
        [](const Leg& leg) { return leg; },
        [](const Leg& leg) {
            return Leg{-leg.y_mm, leg.x_mm, leg.sagitta_mm};
        },
        [](const Leg& leg) {
            return Leg{-leg.x_mm, leg.y_mm, -leg.sagitta_mm};
        },
        [](const Leg& leg) {
            return Leg{leg.x_mm + 50, leg.y_mm - 70, leg.sagitta_mm};
        }};
    for (const auto& map : maps)
        for (const bool back : {false, true})
            CHECK(along_trail(map, back).time_s() == doctest::Approx(plain.time_s()).epsilon(1e-6));
}

TEST_CASE("estimate 2: the way to a layer is planned from where the layer before left the head") {
    const format::EncodedLayer layer = layer_of([](format::LayerEncoder&) {}, state_at(30, 40));
    const auto way = estimator().approach({{0, 0, 0}, {}}, layer, 0);
    REQUIRE(way.ok());
    CHECK(way->travel_mm == doctest::Approx(50.2));
    // z first, at 200 mm/s^2, then 50 mm, on which x is as quick as the file asks for.
    const double rise_s = 2 * std::sqrt(0.2 / 200);
    CHECK(way->travel_time_s > rise_s + 50 / 150.0);
    CHECK(way->time_s() == way->travel_time_s);
    const auto none = estimator().approach({{30, 40, 0.2}, 0.0}, layer, 1);
    REQUIRE(none.ok());
    CHECK(none->time_s() == 0);
    const auto feeding = estimator().approach({{30, 40, 0.2}, 0.8}, layer, 1);
    REQUIRE(feeding.ok());
    CHECK(feeding->travel_time_s == doctest::Approx(duration_s(0.8, 40, 5'000)));
    CHECK(feeding->travel_mm == 0);
}

TEST_CASE("estimate 3: roles, travel, retraction and rests add up to the time") {
    const auto [estimate, end] = estimated(layer_of([](format::LayerEncoder& layer) {
        layer.begin_path(style_of(format::Role::outer_wall));
        layer.circle(10, 0, true);
        layer.retract();
        layer.travel_to(40, 0);
        layer.unretract();
        layer.begin_path(style_of(format::Role::sparse_infill));
        layer.line_to(70, 0);
        layer.dwell(250);
        layer.retract();
    }));
    const RoleEstimate &wall = of(estimate, format::Role::outer_wall),
                       &fill = of(estimate, format::Role::sparse_infill);
    CHECK(wall.length_mm == doctest::Approx(20 * std::numbers::pi));
    CHECK(wall.time_s >= duration_s(20 * std::numbers::pi, 60, 3'000));
    CHECK(fill.time_s == doctest::Approx(duration_s(30, 60, 3'000)));
    CHECK(estimate.travel_mm == doctest::Approx(40));
    CHECK(estimate.travel_time_s ==
          doctest::Approx(duration_s(40, 150, 3'000) + 0.25 + 3 * duration_s(0.8, 40, 5'000)));
    CHECK(estimate.time_s() == doctest::Approx(wall.time_s + fill.time_s + estimate.travel_time_s));
    REQUIRE(end.drawn_back_mm);
    CHECK(*end.drawn_back_mm == doctest::Approx(0.8));
    Estimate twice = estimate;
    twice += estimate;
    CHECK(twice.time_s() == doctest::Approx(2 * estimate.time_s()));
}

TEST_CASE("estimate: what the printer cannot do is an error that names the layer") {
    config::Printer slow = config::generic_printer();
    slow.axes[config::axis_x].max_speed_mm_s = 1e-6;
    const auto estimate = Estimator(slow, diameter_mm)
                              .layer(layer_of([](format::LayerEncoder& l) {
                                         l.begin_path(style_of(format::Role::outer_wall));
                                         l.line_to(30, 0);
                                     }),
                                     6);
    REQUIRE(!estimate.ok());
    CHECK(estimate.error().status == ExitStatus::machine);
    CHECK(estimate.error().where.layer == 7);
}
