// Contract of target/run/interpreter.h, step_stream.h and file_path.h, by number: two readings of the same file that share no
// code must agree.

#include "target/run/interpreter.h"

#include <doctest/doctest.h>

#include <cmath>

#include "target/run/event_stream.h"
#include "target/run/file_path.h"
#include "target/run/print_files.h"

using namespace lyr;
using namespace lyr::run;
using namespace lyr::tests;

namespace {

constexpr double diameter_mm = 1.75;

format::Reader reader_of(const std::string& file) {
    Result<format::Reader> reader = format::Reader::open(file);
    REQUIRE(reader.ok());
    return std::move(*reader);
}

std::vector<Instruction> instructions_of(
    const std::string& file, const config::Printer& printer = config::generic_printer()) {
    Interpreter interpreter(reader_of(file), printer, diameter_mm);
    std::vector<Instruction> instructions;
    for (;;) {
        const Result<std::optional<Instruction>> next = interpreter.next();
        REQUIRE(next.ok());
        if (!*next) return instructions;
        instructions.push_back(**next);
    }
}

std::vector<motion::Move> moves_of(const std::string& file) {
    std::vector<motion::Move> moves;
    for (const Instruction& instruction : instructions_of(file))
        if (const auto* move = std::get_if<motion::Move>(&instruction)) moves.push_back(*move);
    return moves;
}

}  // namespace

TEST_CASE(
    "interpreter 1, 2, file path 1, 2: moves and curves are the same path with the same filament") {
    std::vector<Drawing> drawings;
    for (const Case& what : all_cases()) drawings.push_back(what.drawing);
    for (const bool mirrored : {false, true})
        for (const double angle_rad : {0.0, 1.1}) {
            const std::string file =
                write_print("two_ways", drawings, {angle_rad, mirrored, 40, 30});
            const std::vector<motion::Move> moves = moves_of(file);
            FilePath path(reader_of(file), {}, diameter_mm);
            PathCurve curve;
            AxisValues end{};
            for (const motion::Move& move : moves) {
                const Result<bool> more = path.next(curve);
                REQUIRE(more.ok());
                REQUIRE(*more);
                CHECK(curve.from_mm == end);
                end = curve.to_mm;
                CHECK(motion::advance_of(move.path) ==
                      doctest::Approx(curve.to_mm[3] - curve.from_mm[3]).epsilon(1e-9));
                // Below its layer the head is in the one before.
                const bool is_below = curve.layer > 0 && curve.from_mm[config::axis_z] <
                                                             layer_state(curve.layer).z_mm - 1e-9;
                CHECK(move.tag == curve.layer + (is_below ? 0 : 1));
                const double length_mm = motion::length_of(move.path);
                double worst_mm = 0;
                for (int k = 0; k <= 20; ++k) {
                    const AxisValues a = curve.at(k / 20.0);
                    const motion::Point b = motion::point_at(move.path, length_mm * k / 20.0);
                    worst_mm = std::max({worst_mm, std::abs(a[0] - b.x), std::abs(a[1] - b.y),
                                         std::abs(a[2] - b.z)});
                }
                // Far below a step; the arc of 2 um sagitta has a radius of metres.
                const bool feeds_only = motion::start_of(move.path) == motion::end_of(move.path) &&
                                        std::holds_alternative<motion::Line>(move.path);
                if (!feeds_only) CHECK(worst_mm < 1e-7);
            }
            const Result<bool> more = path.next(curve);
            CHECK((more.ok() && !*more));
        }
}

TEST_CASE("interpreter 1: to a layer's start z goes first if it rises and last if it sinks") {
    const std::string rising = write_print("rising", {draw_square});
    std::vector<motion::Move> moves = moves_of(rising);
    CHECK(motion::end_of(moves[0].path) == motion::Point{0, 0, 0.2});
    CHECK(motion::end_of(moves[1].path) == motion::Point{35, 25, 0.2});
    config::Printer high = config::generic_printer();
    high.start_mm = {1, 2, 50};
    const std::vector<Instruction> sinking = instructions_of(rising, high);
    CHECK(motion::end_of(std::get<motion::Move>(sinking[0]).path) == motion::Point{35, 25, 50});
    CHECK(motion::end_of(std::get<motion::Move>(sinking[1]).path) == motion::Point{35, 25, 0.2});
}

TEST_CASE(
    "interpreter 2: retraction, its speeds, rests, changes of width, speed and acceleration") {
    const std::vector<Instruction> all = instructions_of(write_print("climb", {draw_climb}));
    std::vector<motion::Move> moves;
    double rest_s = 0;
    for (const Instruction& instruction : all) {
        if (const auto* rest = std::get_if<Rest>(&instruction)) rest_s += rest->time_s;
        if (const auto* move = std::get_if<motion::Move>(&instruction)) moves.push_back(*move);
    }
    CHECK(rest_s == doctest::Approx(0.02));
    // z, to the start, travel, three climbing lines, retract, travel, unretract, line.
    REQUIRE(moves.size() == 10);
    CHECK(motion::advance_of(moves[6].path) == doctest::Approx(-0.8));
    CHECK(moves[6].speed_mm_s == doctest::Approx(40));
    CHECK(motion::advance_of(moves[8].path) == doctest::Approx(0.8));
    CHECK(moves[8].speed_mm_s == doctest::Approx(30));
    CHECK(moves[3].speed_mm_s == doctest::Approx(50));
    CHECK(moves[5].speed_mm_s == doctest::Approx(30));
    CHECK(moves[7].speed_mm_s == doctest::Approx(150));
    CHECK(moves[9].acceleration_mm_s2 == doctest::Approx(500));
    const double per_mm_before =
        motion::advance_of(moves[3].path) / motion::length_of(moves[3].path);
    const double per_mm_after =
        motion::advance_of(moves[5].path) / motion::length_of(moves[5].path);
    const auto area_mm2 = [](double width) {
        return (width - 0.2) * 0.2 + std::numbers::pi / 4 * 0.2 * 0.2;
    };
    CHECK(per_mm_after / per_mm_before == doctest::Approx(area_mm2(0.6) / area_mm2(0.45)));
}

TEST_CASE("file path 2: the filament of very many motions adds up without drifting" *
          doctest::test_suite("long")) {
    const Drawing zigzag = [](const Pen& pen) {
        pen.path();
        pen.travel(0, 0);
        for (int i = 0; i < 60'000; ++i) pen.line(i % 2 ? 0.0 : 0.137, 0.0);
    };
    FilePath path(reader_of(write_print("drift", {zigzag, zigzag, zigzag})), {}, diameter_mm);
    PathCurve curve;
    for (bool more = true; more;) {
        const Result<bool> next = path.next(curve);
        REQUIRE(next.ok());
        more = *next;
    }
    const long double area_mm2 =
        (0.45L - 0.2L) * 0.2L + std::numbers::pi_v<long double> / 4 * 0.2L * 0.2L;
    const long double filament_mm2 = std::numbers::pi_v<long double> / 4 * 1.75L * 1.75L;
    const auto expected = static_cast<double>(180'000 * 0.137L * area_mm2 / filament_mm2);
    CHECK(std::abs(curve.to_mm[3] - expected) < 1e-11 * expected);
}

TEST_CASE("interpreter: a print that begins retracted does not feed the retraction first") {
    const std::string file =
        write_print("retracted", {draw_square, draw_square}, {},
                    [](format::LayerState& state) { state.retracted_mm = 0.8; });
    for (const motion::Move& move : moves_of(file)) CHECK(motion::advance_of(move.path) >= 0);
}

TEST_CASE("step stream 1, 3: steps are in order, and every move is told once") {
    std::vector<Drawing> drawings;
    for (const Case& what : all_cases()) drawings.push_back(what.drawing);
    const std::string file = write_print("stream", drawings);
    Result<StepStream> stream = StepStream::open(file, config::generic_printer(), diameter_mm);
    REQUIRE(stream.ok());
    std::vector<Step> steps;
    std::size_t moves = 0;
    std::uint32_t layer = 0;
    for (bool more = true; more;) {
        const Result<bool> next = stream->next(steps);
        REQUIRE(next.ok());
        more = *next;
        moves += stream->moves().size();
        CHECK(stream->layer() >= layer);
        layer = stream->layer();
    }
    CHECK(moves == moves_of(file).size());
    CHECK(layer == drawings.size());
    std::size_t wrong = 0;
    for (std::size_t i = 1; i < steps.size(); ++i) wrong += steps[i].time_ns < steps[i - 1].time_ns;
    CHECK(wrong == 0);
    CHECK(steps.back().time_ns <= stream->time_ns());
}

TEST_CASE("event stream 1: drivers are switched on before the first step, and off at the end") {
    config::Printer printer = config::generic_printer();
    printer.axes[config::axis_x].enable = config::Pin{"gpiochip0", 22u, true};
    const std::string file = write_print("enable", {draw_square});
    Result<EventStream> stream = EventStream::open(file, printer, diameter_mm);
    REQUIRE(stream.ok());
    std::vector<LineEvent> events;
    for (bool more = true; more;) {
        const Result<bool> next = stream->next(events);
        REQUIRE(next.ok());
        more = *next;
    }
    CHECK(events[0].time_ns == 0);
    CHECK(events[0].levels == gpio::line_bit(8));
    CHECK(events[1].time_ns >= EventStream::driver_wake_ns - printer.pulse.direction_setup_ns);
    CHECK(events.back().levels == 0);
    for (std::size_t i = 0; i + 1 < events.size(); ++i)
        REQUIRE((events[i].levels & gpio::line_bit(8)) != 0);
}
