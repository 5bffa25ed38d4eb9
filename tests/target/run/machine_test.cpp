// Prints on crossed belts, on a delta and with shaped motion, from file to decoded pulses; contract of
// target/run/machine_check.h and reach.h, by number.

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>

#include "target/run/machine_check.h"
#include "target/run/print_files.h"
#include "target/run/reach.h"
#include "target/run/simulate.h"
#include "target/run/step_stream.h"

using namespace lyr;
using namespace lyr::run;
using namespace lyr::tests;

namespace {

config::Printer crossed() {
    config::Printer printer = config::generic_printer();
    printer.kinematics = config::Kinematics::corexy;
    return printer;
}

config::Printer delta() {
    config::Printer printer = config::generic_printer();
    printer.kinematics = config::Kinematics::delta;
    printer.delta = {{250, 251, 250}, {120, 120, 121}, {210, 331, 90}, 105};
    for (std::size_t i = 0; i < 3; ++i) printer.axes[i].steps_per_mm = 100;
    printer.axes[config::axis_z].max_speed_mm_s = 100;
    return printer;
}

config::Printer shaped(config::Printer printer) {
    for (std::size_t i = 0; i < 3; ++i) printer.shapers[i] = {config::ShaperKind::mzv, 40, 0.1};
    if (printer.kinematics != config::Kinematics::delta)
        printer.shapers[config::axis_y] = {config::ShaperKind::ei, 31, 0.05};
    printer.pressure_advance_s = 0.05;
    return printer;
}

config::Printer with_jerk(config::Printer printer) {
    printer.max_jerk_mm_s3 = 1e5;
    return printer;
}

SimulationReport simulated(const std::string& file, const config::Printer& printer) {
    Result<SimulationReport> report = simulate({file, printer, {}, {}, {}, true});
    REQUIRE_MESSAGE(report.ok(), (report.ok() ? "" : to_string(report.error())));
    return *report;
}

std::string whole_print(const std::string& name, const Frame& frame) {
    std::vector<Drawing> drawings;
    for (const Case& what : all_cases()) drawings.push_back(what.drawing);
    return write_print(name, drawings, frame);
}

// The motors' positions where the file ends.
std::array<double, 3> carried_mm(const config::Printer& printer, double x, double y, double z) {
    if (printer.kinematics == config::Kinematics::corexy) return {x + y, x - y, z};
    std::array<double, 3> carried{x, y, z};
    if (printer.kinematics == config::Kinematics::delta)
        for (std::size_t i = 0; i < 3; ++i) {
            const double angle = printer.delta.tower_angle_deg[i] * std::numbers::pi / 180;
            const double off = std::hypot(x - printer.delta.radius_mm[i] * std::cos(angle),
                                          y - printer.delta.radius_mm[i] * std::sin(angle));
            carried[i] = z + std::sqrt(std::pow(printer.delta.arm_mm[i], 2) - off * off);
        }
    return carried;
}

void check_end(const SimulationReport& report, const std::string& file) {
    const config::Printer& printer = report.printer;
    Result<format::Reader> reader = format::Reader::open(file);
    REQUIRE(reader.ok());
    FilePath path(std::move(*reader), printer.start_mm, report.filament_diameter_mm);
    PathCurve curve;
    while (*path.next(curve)) continue;
    const auto start = carried_mm(printer, 0, 0, 0);
    const auto end = carried_mm(printer, curve.to_mm[0], curve.to_mm[1], curve.to_mm[2]);
    for (std::size_t i = 0; i < 3; ++i)
        CHECK(std::abs(static_cast<double>(report.positions[i]) -
                       (end[i] - start[i]) * printer.axes[i].steps_per_mm) < 0.5001);
    CHECK(std::abs(static_cast<double>(report.positions[3]) -
                   curve.to_mm[3] * printer.axes[3].steps_per_mm) < 0.5001);
}

}  // namespace

TEST_CASE("machine: every kind of motion on crossed belts and on a delta, turned and mirrored" *
          doctest::test_suite("long")) {
    for (const config::Printer& printer : {crossed(), delta(), with_jerk(delta())})
        for (const bool mirrored : {false, true})
            for (const double angle_rad : {0.0, 2.5}) {
                const std::string file = whole_print("kinds", {angle_rad, mirrored, 20, 30});
                const SimulationReport report = simulated(file, printer);
                CAPTURE(text_of(report));
                CHECK(report.within_limits());
                CHECK(report.worst_steps() < 0.5 + 1e-3);
                CHECK(report.worst_steps() > 0.4);
                CHECK(report.path.distance_mm < 0.02);
                check_end(report, file);
            }
}

TEST_CASE("machine: shaped motions follow the shaped plan, and end where the file does" *
          doctest::test_suite("long")) {
    const std::string file = whole_print("shaped", {0.3, false, 20, 30});
    for (const config::Printer& plain : {config::generic_printer(), crossed(), delta()})
        for (const config::Printer& printer :
             {shaped(plain), with_jerk(plain), with_jerk(shaped(plain))}) {
            const SimulationReport report = simulated(file, printer);
            CAPTURE(text_of(report));
            CHECK(report.within_limits());
            CHECK(report.worst_steps() > 0.4);
            check_end(report, file);
        }
}

TEST_CASE("machine: axes with backlash follow the file, a fifth of it late after turns") {
    const std::string file = whole_print("backlash", {0.3, false, 20, 30});
    for (const config::Printer& plain : {config::generic_printer(), shaped(crossed())}) {
        config::Printer printer = plain;
        printer.backlash_mm = {0.1, 0.15, 0.02};
        const SimulationReport report = simulated(file, printer);
        CAPTURE(text_of(report));
        CHECK(report.within_limits());
        CHECK(report.planned_steps[config::axis_x] > 1);
        CHECK(report.planned_steps[config::axis_x] < 0.501 + 0.1 * 80 / 5);
        CHECK(report.planned_steps[config::axis_e] < 0.501);
    }
}

TEST_CASE(
    "machine: an axis that is later after turns than its play explains is not within limits") {
    config::Printer printer = config::generic_printer();
    printer.backlash_mm[config::axis_x] = 0.1;
    SimulationReport report = simulated(write_print("late", {draw_square}), printer);
    const double a_fifth = 0.1 * printer.axes[config::axis_x].steps_per_mm / 5;
    report.planned_steps[config::axis_x] = 0.5 + 0.9 * a_fifth;
    CHECK(report.within_limits());
    report.planned_steps[config::axis_x] = 0.5 + 1.1 * a_fifth;
    CHECK_FALSE(report.within_limits());
}

TEST_CASE(
    "machine: axes with backlash are where each move ends, whichever way the first one goes") {
    config::Printer printer = config::generic_printer();
    printer.backlash_mm = {0.1, 0.25, 0};
    const std::array<double, 5> stops_mm{0, 3.3, -1.1, 5.7, 0.2};
    for (const double sign : {1.0, -1.0})
        for (std::size_t moves = 1; moves < stops_mm.size(); ++moves) {
            // x and y go opposite ways.
            const auto place = [&](std::size_t i) {
                return motion::Point{sign * stops_mm[i], -sign * stops_mm[i], 0};
            };
            Result<motion::Planner> planner = motion::Planner::create(motion_limits(printer));
            REQUIRE(planner.ok());
            for (std::size_t i = 0; i < moves; ++i)
                REQUIRE(planner->push({motion::Line{place(i), place(i + 1)}, 50}).ok());
            planner->flush();
            MotorSteps generator(printer);
            // As after a motion downwards, axes stand where their motors do.
            std::array<double, 2> motors{}, axes{};
            std::array<std::int64_t, 2> stepped_ns{-1, -1};
            const auto follow = [&] {
                motion::StepEvent event;
                while (generator.next(std::span(&event, 1)) == 1) {
                    std::vector<Step> steps;
                    append_steps(std::span(&event, 1), steps);
                    for (const Step& step : steps) {
                        const double play =
                            printer.backlash_mm[step.axis] * printer.axes[step.axis].steps_per_mm;
                        double& motor = motors[step.axis];
                        motor += step.positive ? 1 : -1;
                        axes[step.axis] = std::clamp(axes[step.axis], motor - play, motor);
                        REQUIRE(step.time_ns > std::exchange(stepped_ns[step.axis], step.time_ns));
                    }
                }
            };
            for (motion::PlannedMove planned; planner->pop(planned); follow())
                generator.start(planned);
            generator.finish();
            follow();
            const motion::Point end = place(moves);
            CHECK(std::abs(axes[0] - end.x * printer.axes[0].steps_per_mm) <= 0.501);
            CHECK(std::abs(axes[1] - end.y * printer.axes[1].steps_per_mm) <= 0.501);
        }
}

TEST_CASE("machine: arcs that climb are fed for their way in space, and end at their height") {
    constexpr double radius_mm = 2, rise_mm = 2;
    constexpr int arcs = 4;
    const auto draw_helix = [](const Pen& pen) {
        pen.path(20);
        pen.travel(0, 0);
        const double base_mm = static_cast<double>(pen.layer.position().z) * 1e-3;
        for (int i = 1; i <= arcs; ++i) {
            const double x_mm = i % 2 ? 2 * radius_mm : 0;
            pen.layer.arc_to(pen.frame.x(x_mm, 0), pen.frame.y(x_mm, 0), base_mm + i * rise_mm,
                             pen.frame.sagitta(radius_mm));
        }
    };
    for (const bool mirrored : {false, true}) {
        const std::string file = write_print("helix", {draw_helix}, {0.3, mirrored, 20, 30});
        const SimulationReport report = simulated(file, config::generic_printer());
        CAPTURE(text_of(report));
        CHECK(report.within_limits());
        const double way_mm = arcs * std::hypot(std::numbers::pi * radius_mm, rise_mm);
        CHECK(report.totals.extruded_mm == doctest::Approx(way_mm).epsilon(1e-4));
        CHECK(report.positions[config::axis_z] ==
              std::llround((layer_height_mm + arcs * rise_mm) * 400));
    }
}

TEST_CASE("machine check 1, 3: a step left out, doubled, late or of another motor is found" *
          doctest::test_suite("long")) {
    const std::string file = whole_print("mutated", {0.3, false, 20, 30});
    std::mt19937 random(5);
    for (const config::Printer& printer : {crossed(), shaped(delta())})
        for (int mutation = 0; mutation < 5; ++mutation) {
            CAPTURE(mutation);
            Result<StepStream> stream = StepStream::open(file, printer, 1.75);
            REQUIRE(stream.ok());
            Result<format::Reader> reader = format::Reader::open(file);
            REQUIRE(reader.ok());
            FilePath path(std::move(*reader), printer.start_mm, 1.75);
            MachineCheck check(printer, [&](PathCurve& curve) { return path.next(curve); });
            StepPositions at{};
            const std::size_t bad = 1000 + random() % 5000;
            std::size_t count = 0;
            const auto feed = [&](const Step& step) {
                check.step({step.time_ns, step.axis, at, step.positive});
                at[step.axis] += step.positive ? 1 : -1;
            };
            for (bool more = true; more;) {
                std::vector<Step> steps;
                more = *stream->next(steps);
                check.expect(stream->moves(), {});
                for (Step step : steps) {
                    const bool hit = ++count == bad;
                    if (hit && mutation == 1) continue;
                    if (hit && mutation == 2) feed(step);
                    if (hit && mutation == 3)
                        step.axis = static_cast<std::uint8_t>((step.axis + 1) % 4);
                    if (hit && mutation == 4) step.positive = !step.positive;
                    feed(step);
                }
            }
            REQUIRE(check.finish(at).ok());
            const AxisValues& off = check.off_plan();
            const double worst = *std::max_element(off.begin(), off.end());
            CHECK(count > 6000);
            if (mutation == 0)
                CHECK(worst < 0.501);
            else
                CHECK(worst > 0.9);
        }
}

TEST_CASE("timed check 1: a plan that is not a number shows, whatever comes after") {
    motion::PlannedMove move;
    move.path = motion::Line{{0, 0, 0}, {1, 0, 0}, 0};
    move.profile = motion::trapezoid(1, 10, 10, 10, 1000);
    motion::PlannedMove bad = move;
    for (motion::Phase& phase : bad.profile.phases)
        phase.speed_mm_s = std::numeric_limits<double>::quiet_NaN();
    motion::PlannedMove next = move;
    next.path = motion::Line{{1, 0, 0}, {2, 0, 0}, 0};
    next.start_ns = 100'000'000;
    for (const bool is_bad : {false, true}) {
        TimedCheck check(crossed());
        check.expect(std::array{is_bad ? bad : move, next}, {});
        for (const std::size_t motor : {config::axis_x, config::axis_y}) {
            StepPositions at{};
            check.step({50'000'000, motor, at, true});
            at[motor] = 1;
            check.step({200'000'000, motor, at, true});
        }
        CHECK(std::isinf(check.off_plan()[config::axis_x]) == is_bad);
        CHECK(std::isinf(check.off_plan()[config::axis_y]) == is_bad);
    }
}

TEST_CASE("machine check 3: curves that the plan leaves out or adds are found") {
    const std::string file = whole_print("fewer", {0, false, 20, 30});
    for (const bool leave_out : {true, false}) {
        const config::Printer printer = crossed();
        Result<StepStream> stream = StepStream::open(file, printer, 1.75);
        Result<format::Reader> reader = format::Reader::open(file);
        FilePath path(std::move(*reader), printer.start_mm, 1.75);
        int curves = 0;
        MachineCheck check(printer, [&](PathCurve& curve) -> Result<bool> {
            if (++curves == 40) {
                if (!leave_out) return false;
                (void)path.next(curve);
            }
            return path.next(curve);
        });
        std::vector<Step> steps;
        for (bool more = true; more;) {
            more = *stream->next(steps);
            check.expect(stream->moves(), {});
        }
        CHECK(check.finish({}).ok());
        CHECK(check.off_file().worst_steps > 0.9);
    }
}

TEST_CASE(
    "reach 1: a curve is farthest from the middle at an end or where its radius points away") {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> even(-1, 1);
    for (int i = 0; i < 200; ++i) {
        PathCurve curve;
        curve.is_arc = i % 4 != 0;
        curve.center_x_mm = 50 * even(random);
        curve.center_y_mm = 50 * even(random);
        curve.radius_mm = 30 + 29 * even(random);
        curve.start_angle_rad = 7 * even(random);
        curve.sweep_rad = 6.28 * even(random);
        const auto end = [&](double angle) {
            return AxisValues{curve.center_x_mm + curve.radius_mm * std::cos(angle),
                              curve.center_y_mm + curve.radius_mm * std::sin(angle), 0, 0};
        };
        curve.from_mm = end(curve.start_angle_rad);
        curve.to_mm = end(curve.start_angle_rad + curve.sweep_rad);
        double looked = 0;
        for (int k = 0; k <= 2000; ++k) {
            const AxisValues at = curve.at(k / 2000.0);
            looked = std::max(looked, std::hypot(at[0], at[1]));
        }
        CHECK(farthest_mm(curve) >= looked - 1e-9);
        CHECK(farthest_mm(curve) <= looked + 1e-3);
    }
}

TEST_CASE("reach 2: a file beyond a delta's arms is refused before anything moves") {
    const std::string file = whole_print("beyond", {0, false, 80, 60});
    config::Printer printer = delta();
    const Result<SimulationReport> report = simulate({file, printer, {}, {}, {}, true});
    REQUIRE_FALSE(report.ok());
    CHECK(report.error().status == ExitStatus::machine);
    CHECK(report.error().where.layer == 1);
    CHECK(report.error().message.find("delta.reach_mm") != std::string::npos);
    printer = crossed();
    CHECK(simulate({file, printer, {}, {}, {}, true}).ok());
}
