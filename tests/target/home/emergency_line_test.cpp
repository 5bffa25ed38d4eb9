// What target/home/job.h and mover.h say of homing and jogs on real lines: with the libgpiod that lyrrun is built with, on
// a fake board.

#include <doctest/doctest.h>

#include <chrono>
#include <thread>

#include "target/gpio/fake_board.h"
#include "target/home/job.h"

using namespace lyr;
using namespace lyr::tests;

namespace {

constexpr std::size_t x_step = 0, emergency_line = 20;

FakeLine& line(std::size_t number) {
    return board().chips.front().lines[number];
}

config::Pin pin(std::size_t line) {
    return {"gpiochip0", static_cast<std::uint32_t>(line), false};
}

constexpr int way_mm = 90, steps_per_mm = 80;

// Homing takes ten seconds, as its endstop never triggers, and a jog takes four.
home::Job job_on_fake_board() {
    board() = {};
    board().chips.push_back({"gpiochip0", "pinctrl-test", std::vector<FakeLine>(28)});
    home::Job job{.printer = config::generic_printer()};
    config::Printer& printer = job.printer;
    std::size_t next = 0;
    for (config::Axis& axis : printer.axes) {
        axis.step = pin(next++);
        axis.direction = pin(next++);
        axis.enable = pin(next++);
    }
    config::Axis& x = printer.axes[config::axis_x];
    x.max_speed_mm_s = 20;
    x.min_mm = 0;
    x.max_mm = 200;
    printer.endstops[config::axis_x].input = pin(next);
    printer.inputs[config::input_emergency] = pin(emergency_line);
    printer.homing.lift_mm = 0;
    printer.pulse.late_limit_ns = 10'000'000'000;  // the machine of a test may be busy
    return job;
}

void check_stopped_by_emergency(const Result<home::Report>& report) {
    REQUIRE_FALSE(report.ok());
    CHECK(report.error().status == ExitStatus::stopped);
    CHECK(report.error().message == "stopped on request of input.emergency, which is active");
    CHECK(board().requests == 0);
    CHECK(board().opened == 0);
    for (std::size_t i = 0; i < board().chips.front().lines.size(); ++i) {
        CHECK(line(i).user.empty());
        CHECK(line(i).level == (i == emergency_line));
    }
}

const auto home_x = [](const home::Job& job) { return home::home(job, home::AxisSet(0b001), {}); };
const auto jog_x = [](const home::Job& job) {
    return home::home(job, {}, motion::Point{way_mm, 0, 0});
};

}  // namespace

TEST_CASE("mover 3: an emergency line that is active from the start lets nothing move") {
    for (const auto& run : {+home_x, +jog_x}) {
        const home::Job job = job_on_fake_board();
        line(emergency_line).level = true;
        check_stopped_by_emergency(run(job));
        CHECK(FakeBoard::rises_of(line(x_step)) == 0);
    }
}

TEST_CASE("mover 3: an emergency line that becomes active ends homing and jogs where they are") {
    for (const auto& run : {+home_x, +jog_x}) {
        const home::Job job = job_on_fake_board();
        std::thread user([] {
            // Once it moves, however busy the machine is.
            for (int i = 0; i < 2'000 && FakeBoard::rises_of(line(x_step)) < steps_per_mm; ++i)
                std::this_thread::sleep_for(std::chrono::milliseconds(5));
            FakeBoard::turn(line(emergency_line), true, gpio::MonotonicClock().now_ns());
        });
        const Result<home::Report> report = run(job);
        user.join();
        check_stopped_by_emergency(report);
        const int steps = FakeBoard::rises_of(line(x_step));
        CHECK(steps >= steps_per_mm);
        CHECK(steps < way_mm * steps_per_mm);
    }
}

TEST_CASE("mover 3: an emergency line that chatters was told to be active") {
    const home::Job job = job_on_fake_board();
    std::thread user([] {
        for (int i = 0; i < 2'000 && FakeBoard::rises_of(line(x_step)) < steps_per_mm; ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        constexpr int turns = 20;
        const std::int64_t now_ns = gpio::MonotonicClock().now_ns();
        for (int i = 0; i < turns; ++i)
            FakeBoard::turn(line(emergency_line), i % 2 == 0, now_ns + i);
    });
    const Result<home::Report> report = home_x(job);
    user.join();
    REQUIRE_FALSE(report.ok());
    CHECK(report.error().message.find("edges come faster than they can be taken") !=
          std::string::npos);
}
