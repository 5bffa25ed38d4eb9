// target/motion/time_walk.h, by number: what the prints of timed_generator_test.cpp do not come to.

#include "target/motion/time_walk.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

namespace lyr::motion {
namespace {

// One motor that is x, in steps of a mm, along a line at an even speed that is cut in two.
struct CutLine {
    MoveWindow window;
    MotorFunction function = MotorFunction::sum({{0, {1, 0, 0, 0, 0}}}, 0);

    CutLine(double cut_mm, double end_mm, double speed_mm_s) {
        PlannedMove move;
        for (const auto& [from_mm, to_mm] : {std::pair(0.0, cut_mm), std::pair(cut_mm, end_mm)}) {
            const double length_mm = std::abs(to_mm - from_mm);
            move.path = Line{{from_mm, 0, 0}, {to_mm, 0, 0}, 0};
            move.profile = trapezoid(length_mm, speed_mm_s, speed_mm_s, speed_mm_s, 1000);
            window.push(move);
            const Instant end =
                Instant{move.start_ns, move.start_part_ns}.after(move.profile.duration_s);
            move.start_ns = end.ns;
            move.start_part_ns = end.part_ns;
        }
    }
};

}  // namespace

TEST_CASE("time walk 2: a middle that a piece leaves open is passed at the begin of the next one") {
    constexpr double speed_mm_s = 0.01, end_mm = 20;
    for (const double sign : {1.0, -1.0})
        for (const double beyond_steps : {0.0, 1e-9, 5e-9, 9e-9}) {
            CAPTURE(beyond_steps);
            const double cut_mm = 3.5 + beyond_steps;
            CutLine line(sign * cut_mm, sign * end_mm, speed_mm_s);
            TimeWalk walk;
            Instant begin;
            std::int64_t count = 0;
            double last_s = -1;
            for (int piece = 0; piece < 2; ++piece) {
                REQUIRE(line.function.begin_piece(line.window, begin) == Known::piece);
                walk.start(line.function, count);
                const double begin_s = begin.seconds_since({});
                for (;;) {
                    const std::span<const double> times_s = walk.next_s(line.function);
                    if (times_s.empty()) break;
                    for (const double time_s : times_s) {
                        CHECK(time_s >= 0);
                        const double middle = std::abs(static_cast<double>(count)) + 0.5;
                        count += walk.direction();
                        const double exact_s = std::max(middle / speed_mm_s, begin_s);
                        CHECK(std::abs(begin_s + time_s - exact_s) < 2e-10);
                        CHECK(begin_s + time_s > last_s);
                        last_s = begin_s + time_s;
                    }
                }
                CHECK(std::abs(count) == (piece == 0 ? 3 : 20));
                begin = begin.after(line.function.duration_s());
            }
        }
}

}  // namespace lyr::motion
