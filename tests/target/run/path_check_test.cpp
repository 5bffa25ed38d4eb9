// Contract of target/run/path_check.h, by number. The steps come from rounding a densely sampled curve
// to the lattice, which needs none of the crossings that the check computes.

#include "target/run/path_check.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

using namespace lyr;
using namespace lyr::run;

namespace {

using std::numbers::pi;
const AxisValues steps_per_mm{80, 100, 400, 96};
const AxisValues origin_mm{0, 0, 0, 0};

struct TestStep {
    std::size_t axis;
    bool positive;
};

PathCurve line(const AxisValues& from_mm, const AxisValues& to_mm) {
    PathCurve curve;
    curve.from_mm = from_mm;
    curve.to_mm = to_mm;
    return curve;
}

PathCurve arc(const AxisValues& from_mm, double cx, double cy, double sweep_rad, double rise_mm,
              double feed_mm) {
    PathCurve curve;
    curve.is_arc = true;
    curve.from_mm = from_mm;
    curve.center_x_mm = cx;
    curve.center_y_mm = cy;
    curve.radius_mm = std::hypot(from_mm[0] - cx, from_mm[1] - cy);
    curve.start_angle_rad = std::atan2(from_mm[1] - cy, from_mm[0] - cx);
    curve.sweep_rad = sweep_rad;
    const double end = curve.start_angle_rad + sweep_rad;
    curve.to_mm = {cx + curve.radius_mm * std::cos(end), cy + curve.radius_mm * std::sin(end),
                   from_mm[2] + rise_mm, from_mm[3] + feed_mm};
    return curve;
}

// With samples fine enough that no two steps of one axis fall between two of them.
std::vector<TestStep> perfect_steps(const std::vector<PathCurve>& curves, int samples = 200'000) {
    std::vector<TestStep> steps;
    StepPositions at{};
    for (const PathCurve& curve : curves)
        for (int k = 0; k <= samples; ++k) {
            const AxisValues point = curve.at(static_cast<double>(k) / samples);
            for (std::size_t i = 0; i < 4; ++i) {
                const std::int64_t wanted = std::llround(point[i] * steps_per_mm[i]);
                if (wanted == at[i]) continue;
                REQUIRE(std::abs(wanted - at[i]) == 1);
                steps.push_back({i, wanted > at[i]});
                at[i] = wanted;
            }
        }
    return steps;
}

Deviation check(const std::vector<PathCurve>& curves, const std::vector<TestStep>& steps) {
    std::size_t next = 0;
    PathCheck path(steps_per_mm, origin_mm, [&](PathCurve& curve) -> Result<bool> {
        if (next == curves.size()) return false;
        curve = curves[next++];
        return true;
    });
    StepPositions at{};
    std::int64_t time_ns = 0;
    for (const TestStep& step : steps) {
        path.step({time_ns += 10'000, step.axis, at, step.positive});
        at[step.axis] += step.positive ? 1 : -1;
    }
    path.finish(at);
    CHECK(path.status().ok());
    return path.deviation();
}

// One of everything: a diagonal, arcs of both senses and more than half a turn, a whole circle, a helix,
// a ramp, a retraction, and corners between them.
std::vector<PathCurve> tour() {
    std::vector<PathCurve> curves;
    curves.push_back(line(origin_mm, {3.1, 1.7, 0.25, 0.1}));
    curves.push_back(arc(curves.back().to_mm, 3.1, 3.9, 1.3 * pi, 0, 0.3));
    curves.push_back(arc(curves.back().to_mm, 0.2, 4.4, -1.4 * pi, 0, 0.3));
    AxisValues at = curves.back().to_mm;
    curves.push_back(line(at, {at[0], at[1], at[2], at[3] - 0.8}));
    at = curves.back().to_mm;
    curves.push_back(line(at, {at[0] - 2.3, at[1], at[2], at[3]}));
    at = curves.back().to_mm;
    curves.push_back(line(at, {at[0], at[1], at[2], at[3] + 0.8}));
    at = curves.back().to_mm;
    curves.push_back(arc(at, at[0] + 1.1, at[1] + 0.3, 2 * pi, 0, 0.4));
    curves.push_back(arc(curves.back().to_mm, at[0] - 0.9, at[1], -2 * pi, 0.4, 0.4));
    at = curves.back().to_mm;
    curves.push_back(line(at, {at[0] + 0.013, at[1] - 3.3, at[2] - 0.2, at[3]}));
    return curves;
}

// The sampled steps are up to a sample late.
constexpr double sampling_slack = 0.01;

}  // namespace

TEST_CASE("path check 1: perfect steps deviate by half a step, on lines and arcs of every kind") {
    const std::vector<PathCurve> curves = tour();
    const std::vector<TestStep> steps = perfect_steps(curves);
    CHECK(steps.size() > 1'000);
    const Deviation deviation = check(curves, steps);
    CHECK(deviation.worst_steps == doctest::Approx(0.5).epsilon(sampling_slack));
    for (const double axis : deviation.steps)
        CHECK(axis == doctest::Approx(0.5).epsilon(sampling_slack));
    CHECK(deviation.distance_mm > 0.5 / 80);
    CHECK(deviation.distance_mm < std::hypot(0.51 / 80, 0.51 / 100, 0.51 / 400));
}

TEST_CASE("path check 1: so do mirrored and reversed tours" * doctest::test_suite("long")) {
    for (const double mirror_x : {1.0, -1.0})
        for (const double mirror_y : {1.0, -1.0}) {
            std::vector<PathCurve> curves = tour();
            for (PathCurve& curve : curves) {
                const bool flips = mirror_x * mirror_y < 0;
                for (AxisValues* end : {&curve.from_mm, &curve.to_mm})
                    (*end)[0] *= mirror_x, (*end)[1] *= mirror_y;
                curve.center_x_mm *= mirror_x;
                curve.center_y_mm *= mirror_y;
                curve.start_angle_rad = std::atan2(curve.from_mm[1] - curve.center_y_mm,
                                                   curve.from_mm[0] - curve.center_x_mm);
                if (flips) curve.sweep_rad = -curve.sweep_rad;
            }
            const Deviation deviation = check(curves, perfect_steps(curves));
            CHECK(deviation.worst_steps == doctest::Approx(0.5).epsilon(sampling_slack));
        }
}

TEST_CASE("path check 2: a step left out, doubled, turned round or of another axis is found") {
    const std::vector<PathCurve> curves = tour();
    const std::vector<TestStep> perfect = perfect_steps(curves);
    std::mt19937 random(3);
    for (int trial = 0; trial < 40; ++trial) {
        std::vector<TestStep> steps = perfect;
        const std::size_t at = random() % steps.size();
        CAPTURE(at);
        const auto place = steps.begin() + static_cast<std::ptrdiff_t>(at);
        switch (trial % 4) {
            case 0:
                steps.erase(place);
                break;
            case 1:
                steps.insert(place, *place);
                break;
            case 2:
                place->positive = !place->positive;
                break;
            case 3:
                place->axis = (place->axis + 1) % 4;
                break;
        }
        CHECK(check(curves, steps).worst_steps > 0.9);
    }
}

TEST_CASE("path check 2: steps in a wrong order are found") {
    const std::vector<PathCurve> curves{line(origin_mm, {5, 5, 0, 0})};
    std::vector<TestStep> steps = perfect_steps(curves);
    // All of y after all of x: the corner is far from the diagonal.
    std::stable_sort(steps.begin(), steps.end(),
                     [](const TestStep& a, const TestStep& b) { return a.axis < b.axis; });
    CHECK(check(curves, steps).worst_steps > 10);
}

TEST_CASE("path check 2: steps that stop short of the path's end, and go beyond it, are found") {
    const std::vector<PathCurve> curves{line(origin_mm, {5, 0, 0, 0})};
    std::vector<TestStep> steps = perfect_steps(curves);
    steps.resize(steps.size() - 3);
    CHECK(check(curves, steps).worst_steps > 2.9);
    steps = perfect_steps(curves);
    steps.insert(steps.end(), 3, {0, true});
    CHECK(check(curves, steps).worst_steps > 2.4);
    CHECK(check(curves, {}).worst_steps > PathCheck::lost_steps);
}

TEST_CASE("path check 2: a chord instead of the arc is found") {
    // 0.1 mm of sagitta over 2 mm: eight steps off in y.
    const double radius = (1 + 0.1 * 0.1) / (2 * 0.1);
    const double half = std::asin(1 / radius);
    AxisValues from = origin_mm;
    const PathCurve bow = arc(from, 1, radius - 0.1, 2 * half, 0, 0);
    const std::vector<PathCurve> curves{bow};
    CHECK(check(curves, perfect_steps(curves)).worst_steps < 0.51);
    CHECK(check(curves, perfect_steps({line(from, bow.to_mm)})).worst_steps > 5);
}

TEST_CASE("path check 3: an arc that only just reaches the middle may or may not be stepped to") {
    // The top of the circle is exactly between two steps of y.
    const double radius = 2.005;
    const std::vector<PathCurve> curves{arc(origin_mm, radius, 0, -pi, 0, 0)};
    std::vector<TestStep> steps = perfect_steps(curves);
    CHECK(check(curves, steps).worst_steps < 0.501);
    std::size_t top = 0;
    std::int64_t y = 0, highest = 0;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        if (steps[i].axis != 1) continue;
        y += steps[i].positive ? 1 : -1;
        if (y > highest) highest = y, top = i;
    }
    const auto place = steps.begin() + static_cast<std::ptrdiff_t>(top);
    if (highest == 201) {
        auto down = place + 1;
        while (down->axis != 1) ++down;
        steps.erase(down);
        steps.erase(place);
    } else {
        steps.insert(place + 1, {{1, true}, {1, false}});
    }
    CHECK(check(curves, steps).worst_steps < 0.51);
}

TEST_CASE("path check 3: simultaneous steps may come in either order") {
    const std::vector<PathCurve> curves{line(origin_mm, {4, 3.2, 0, 0})};  // 320 steps on both axes
    std::vector<TestStep> steps;
    for (int i = 0; i < 320; ++i) {
        steps.push_back({static_cast<std::size_t>(i % 2), true});
        steps.push_back({static_cast<std::size_t>(1 - i % 2), true});
    }
    CHECK(check(curves, steps).worst_steps < 0.501);
}

TEST_CASE(
    "path check 1: a step back through the same middle belongs to the crossing on the way back") {
    // Up past the middle at 2.005, and round by ways that come back to it from above.
    const std::vector<PathCurve> curves{line(origin_mm, {0, 2.008, 0, 0}),
                                        arc({0, 2.008, 0, 0}, -3, 2.008, 2 * pi, 0, 0),
                                        arc({0, 2.008, 0, 0}, -2, 2.008, -2 * pi, 0, 0)};
    CHECK(check(curves, perfect_steps(curves)).worst_steps < 0.5 + sampling_slack);
}

TEST_CASE("path check 1: a step that is almost due is measured where it is due") {
    // x and e pass their middles less than a thousandth of a step apart, all the way.
    const double apart_mm = 0.0009 / 96;
    const std::vector<PathCurve> curves{
        line(origin_mm, {0.3, 0, 0, apart_mm}),
        line({0.3, 0, 0, apart_mm}, {4.3, 0, 0, apart_mm + 80 * 4 / 96.0})};
    std::vector<TestStep> steps;
    for (int i = 0; i < 24; ++i) steps.push_back({0, true});
    for (int i = 0; i < 320; ++i) {
        steps.push_back({3, true});
        steps.push_back({0, true});
    }
    CHECK(check(curves, steps).worst_steps < 0.5 + 1e-6);
    // In the other order they are off by that much, and no more.
    for (std::size_t i = 24; i < steps.size(); i += 2) std::swap(steps[i], steps[i + 1]);
    const double swapped = check(curves, steps).worst_steps;
    CHECK(swapped > 0.5 + 0.0008);
    CHECK(swapped < 0.5 + 0.001);
}

TEST_CASE(
    "path check 3: a step on an arc is not lost where another axis, of the same nanosecond, goes "
    "first" *
    doctest::test_suite("long")) {
    // y is past its middle by `behind` steps where x passes its own, and both come in one write, x first.
    for (const double behind : {0.0, 1e-8, 1e-7, 9e-7, 1.1e-6, 2e-5})
        for (const double sign_x : {1.0, -1.0})
            for (const double sign_y : {1.0, -1.0}) {
                CAPTURE(behind);
                const double at_x = sign_x * 20.5 / 80, at_y = sign_y * (30.5 + behind) / 100;
                const double radius_mm = 3, before_rad = 0.08, sweep_rad = 0.2;
                // At 45 degrees through the place, towards larger sizes of both.
                const double at_rad = std::atan2(-sign_y, sign_x), turn = sign_x * sign_y;
                const double cx = at_x - radius_mm * std::cos(at_rad);
                const double cy = at_y - radius_mm * std::sin(at_rad);
                const double start_rad = at_rad - turn * before_rad;
                const AxisValues start{cx + radius_mm * std::cos(start_rad),
                                       cy + radius_mm * std::sin(start_rad), 0, 0};
                const std::vector<PathCurve> curves{line(origin_mm, start),
                                                    arc(start, cx, cy, turn * sweep_rad, 0, 0)};
                const std::vector<TestStep> steps = perfect_steps(curves);
                CHECK(check(curves, steps).worst_steps < 0.5 + sampling_slack);
                // A step that is missing there is still found, on either axis.
                for (const std::size_t axis : {0u, 1u}) {
                    std::vector<TestStep> fewer = steps;
                    int passed = axis == 0 ? 21 : 31;
                    auto place = fewer.begin();
                    while (place->axis != axis || --passed != 0) ++place;
                    fewer.erase(place);
                    CHECK(check(curves, fewer).worst_steps > 0.9);
                }
            }
}

namespace {

// Of curves of a millimetre.
constexpr int few_samples = 40'000;

// Ends of lines, extremes and starts of arcs lie on steps and on middles, as coordinates of whole micrometres do on a
// machine of 100 or 500 steps/mm: lines run along middles, arcs touch them, circles begin where they touch.
std::vector<PathCurve> tour_on_middles(std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto below = [&](int count) {
        return static_cast<int>(random() % static_cast<unsigned>(count));
    };
    // 0.025 mm are 2 steps of x and 2.5 of y.
    const auto coordinate = [&](double steps_mm) { return 0.5 * below(80) / steps_mm; };
    std::vector<PathCurve> curves;
    AxisValues at = origin_mm;
    const auto go = [&](const AxisValues& to) {
        if (to != at) curves.push_back(line(at, to));
        at = to;
    };
    for (int i = 0; i < 25; ++i) {
        const double radius_mm = 0.025 * (1 + below(12));
        const double turn = below(2) ? 1 : -1, way = below(2) ? 1 : -1;
        const bool along_x = below(2) == 0;
        const double cx = at[0] + (along_x ? way * radius_mm : 0);
        const double cy = at[1] + (along_x ? 0 : way * radius_mm);
        switch (below(4)) {
            case 0:
                go({coordinate(80), coordinate(100), at[2], at[3] + 0.02});
                break;
            case 1: {
                const AxisValues from = at;
                go({along_x ? coordinate(80) : at[0], along_x ? at[1] : coordinate(100), at[2],
                    at[3]});
                if (below(2)) go(from);
                break;
            }
            default: {
                const double sweep = turn * pi / 2 * (1 + below(4));
                curves.push_back(arc(at, cx, cy, sweep, 0, 0.01));
                // Where it ends on the grid, but for rounding.
                AxisValues& end = curves.back().to_mm;
                end[0] = std::round(end[0] * 160) / 160;
                end[1] = std::round(end[1] * 200) / 200;
                at = end;
            }
        }
    }
    // Where no middle is near, so that every step counts.
    go({1, 1, at[2], at[3]});
    return curves;
}

}  // namespace

TEST_CASE("path check 3: lines along middles and arcs that touch them are followed either way" *
          doctest::test_suite("long")) {
    for (std::uint32_t seed = 1; seed <= 15; ++seed) {
        CAPTURE(seed);
        const std::vector<PathCurve> curves = tour_on_middles(seed);
        CHECK(check(curves, perfect_steps(curves, few_samples)).worst_steps < 0.51);
    }
}

TEST_CASE("path check 2: among lines along middles and touches wrong steps are still found" *
          doctest::test_suite("long")) {
    std::mt19937 random(7);
    for (std::uint32_t seed = 1; seed <= 15; ++seed) {
        const std::vector<PathCurve> curves = tour_on_middles(seed);
        const std::vector<TestStep> perfect = perfect_steps(curves, few_samples);
        for (int trial = 0; trial < 12; ++trial) {
            std::vector<TestStep> steps = perfect;
            const std::size_t at = random() % steps.size();
            CAPTURE(seed);
            CAPTURE(at);
            CAPTURE(trial);
            const auto place = steps.begin() + static_cast<std::ptrdiff_t>(at);
            if (trial % 3 == 0) steps.erase(place);
            if (trial % 3 == 1) steps.insert(place, *place);
            if (trial % 3 == 2) place->positive = !place->positive;
            CHECK(check(curves, steps).worst_steps > 0.9);
        }
    }
}

TEST_CASE("path check: an error of the file ends it and is kept") {
    PathCheck path(steps_per_mm, origin_mm, [](PathCurve&) -> Result<bool> {
        return Diagnostic{Severity::error, ExitStatus::input, "cut short", {}};
    });
    path.finish({});
    REQUIRE_FALSE(path.status().ok());
    CHECK(path.status().error().message == "cut short");
}
