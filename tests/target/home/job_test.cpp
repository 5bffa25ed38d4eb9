// Contract of target/home/job.h, by number, on simulated machines.

#include "target/home/job.h"

#include "target/home/scene.h"

using namespace lyr;
using namespace lyr::tests;
using config::Kinematics;

TEST_CASE("homing before a print 4: one that resumes lifts first, and takes its height as it is") {
    for (const Kinematics kind : {Kinematics::cartesian, Kinematics::corexy, Kinematics::delta}) {
        CAPTURE(static_cast<int>(kind));
        config::Printer printer = machine_of(kind);
        const bool is_delta = kind == Kinematics::delta;
        run::Resumption resumption;
        resumption.stopped_z_mm = 10;
        printer.start_mm = is_delta ? std::array{0.0, 0.0, 30.0} : std::array{20.0, 20.0, 0.2};
        printer.simulated.head_mm =
            is_delta ? std::array{40.0, 30.0, 10.0} : std::array{120.0, 100.0, 10.0};
        // What was printed stands higher than the nozzle on the way to the endstop of x.
        if (!is_delta) printer.simulated.bumps = {{60, 100, 11, 20}};
        printer.homing.lift_mm = 0;
        printer.endstops[config::axis_z].at_high_end = is_delta;
        Scene scene(printer);
        const Status homed = home::home_before_print(scene.mover, printer, resumption);
        REQUIRE_MESSAGE(homed.ok(), homed.error().message);
        const std::array<double, 3> start = run::lifted(printer, resumption).start_mm;
        CHECK(start[config::axis_z] == 10 + printer.pause.lift_mm);
        CHECK(scene.off_steps({start[0], start[1], start[2]}) <= 1.01);
        if (!is_delta) CHECK(scene.machine.lowest_mm() > 0);
    }
}

TEST_CASE(
    "homing before a print 4: one that resumes over a crooked bed begins as high as it says") {
    for (const Kinematics kind : {Kinematics::cartesian, Kinematics::corexy, Kinematics::delta}) {
        CAPTURE(static_cast<int>(kind));
        config::Printer printer = machine_of(kind);
        const bool is_delta = kind == Kinematics::delta;
        constexpr double lift_mm = 0.5, z_mm = 10;
        printer.mesh.area_mm = {-100, -100, 100, 100};
        printer.mesh.heights_mm = {{lift_mm, lift_mm}, {lift_mm, lift_mm}};
        printer.start_mm = is_delta ? std::array{0.0, 0.0, 30.0} : std::array{20.0, 20.0, 0.2};
        printer.simulated.head_mm = is_delta ? std::array{40.0, 30.0, z_mm + lift_mm}
                                             : std::array{120.0, 100.0, z_mm + lift_mm};
        printer.endstops[config::axis_z].at_high_end = is_delta;
        run::Resumption resumption;
        resumption.stopped_z_mm = z_mm;
        Scene scene(printer);
        const Status homed = home::home_before_print(scene.mover, printer, resumption);
        REQUIRE_MESSAGE(homed.ok(), homed.error().message);
        const std::array<double, 3> start = run::lifted(printer, resumption).start_mm;
        CHECK(scene.off_steps({start[0], start[1], start[2] + lift_mm}) <= 1.01);
    }
}

TEST_CASE(
    "homing before a print 4: a loss of power while it homed, lifted, was resumed that much too "
    "high") {
    config::Printer printer = machine_of(Kinematics::cartesian);
    printer.start_mm = {20, 20, 0.2};
    printer.simulated.head_mm = {120, 100, 10};
    printer.homing.lift_mm = 3;
    run::Resumption resumption;
    resumption.stopped_z_mm = 10;
    const double up_mm = printer.pause.lift_mm + 3;
    for (const bool fails : {false, true}) {
        CAPTURE(fails);
        Scene scene(printer);
        const auto risen_mm = [&] {
            return static_cast<double>(scene.mover.counts()[config::axis_z]) /
                   printer.axes[config::axis_z].steps_per_mm;
        };
        std::vector<double> told_mm;
        const Status homed =
            home::home_before_print(scene.mover, printer, resumption, [&](double mm) -> Status {
                told_mm.push_back(mm);
                // It stands up there both times.
                CHECK(risen_mm() == doctest::Approx(up_mm));
                if (fails && told_mm.size() == 2)
                    return Diagnostic{Severity::error, ExitStatus::output, "disk full", {}};
                return Done{};
            });
        CHECK(homed.ok() == !fails);
        CHECK(told_mm == std::vector<double>{up_mm, printer.pause.lift_mm});
        // And comes down only if that is written.
        CHECK(risen_mm() == doctest::Approx(fails ? up_mm : printer.pause.lift_mm));
    }
}

TEST_CASE("homing before a print 4: without endstops of x and y none resumes with homing") {
    config::Printer printer = machine_of(Kinematics::cartesian);
    CHECK(home::homed_before_print(printer, false) == home::AxisSet(0b111));
    CHECK(home::homed_before_print(printer, true) == home::AxisSet(0b011));
    printer.endstops[config::axis_x].input.reset();
    printer.endstops[config::axis_y].input.reset();
    CHECK(home::homed_before_print(printer, true).none());
    CHECK(home::homed_before_print(printer, false).any());
    printer.homing.before_print = false;
    CHECK(home::homed_before_print(printer, false).none());
}

TEST_CASE(
    "a head pushed to the middle, of a printer without endstops, could be jogged one way only") {
    for (const double way_mm : {-10.0, 10.0}) {
        home::Job job{.printer = machine_of(Kinematics::cartesian), .simulate = true};
        job.printer.endstops = {};
        job.printer.start_mm = {0, 0, 0};
        const config::Axis& x = job.printer.axes[config::axis_x];
        const auto report = home::home(job, {}, motion::Point{way_mm, 0, 0});
        REQUIRE_MESSAGE(report.ok(), report.error().message);
        CHECK(report->head.x == (x.min_mm + x.max_mm) / 2 + way_mm);
        CHECK(report->homed.none());
    }
}
