// Contract 5 of target/home/mover.h and those of move_stream.h and run/event_flow.h: what comes out piece by piece is what
// came out when all edges of a run were computed before it.

#include "target/home/move_stream.h"

#include <atomic>
#include <cmath>
#include <functional>
#include <thread>

#include "target/home/heap.h"
#include "target/home/scene.h"
#include "target/moves/move_maker.h"
#include "target/run/event_flow.h"
#include "target/run/event_stream.h"

using namespace lyr;
using namespace lyr::home;
using namespace lyr::tests;
using config::Kinematics;
using Edges = std::vector<run::LineEvent>;

namespace {

// All edges of the moves at once, and held against what is made in pieces.
Edges all_edges(const config::Printer& machine, const std::vector<motion::Move>& moves) {
    auto planner = motion::Planner::create(moves::motion_limits(machine), moves.size() + 4);
    REQUIRE(planner.ok());
    for (const motion::Move& move : moves) REQUIRE(planner->push(move).ok());
    planner->flush();
    run::MotorSteps generator(machine);
    std::vector<run::Step> steps;
    const auto take = [&] {
        motion::StepEvent event;
        while (generator.next(std::span(&event, 1)) == 1)
            run::append_steps(std::span(&event, 1), steps);
    };
    for (motion::PlannedMove planned; planner->pop(planned); take()) generator.start(planned);
    generator.finish();
    take();
    run::PulseSchedule schedule(machine.pulse, run::line_layout(machine).enable);
    Edges edges;
    schedule.begin(run::EventStream::driver_wake_ns, edges);
    schedule.append(steps, edges);
    schedule.finish(planner->time_ns() + generator.tail_ns(), edges);
    edges.pop_back();
    return edges;
}

// The first that differs; the number of edges: none does.
std::size_t first_difference(std::span<const run::LineEvent> one,
                             std::span<const run::LineEvent> other) {
    const auto same = [](const run::LineEvent& a, const run::LineEvent& b) {
        return a.time_ns == b.time_ns && a.levels == b.levels;
    };
    const auto place = std::mismatch(one.begin(), one.end(), other.begin(), other.end(), same);
    return static_cast<std::size_t>(place.first - one.begin());
}

void check_same(std::span<const run::LineEvent> one, std::span<const run::LineEvent> other) {
    REQUIRE(one.size() == other.size());
    CHECK(first_difference(one, other) == one.size());
}

// Waits take no time at all: whoever writes goes as fast as it can.
class HurriedClock final : public gpio::Clock {
public:
    std::int64_t now_ns() const override { return now_ns_; }
    std::int64_t wait_until_ns(std::int64_t time_ns) override {
        if (time_ns > now_ns_) now_ns_ = time_ns;
        return now_ns_;
    }

private:
    std::atomic<std::int64_t> now_ns_{0};
};

// Keeps what is written to its lines. With one of the writes its contact closes, or somebody asks for a stop; the thread
// that writes waits there until the other one has taken notice, where there is another.
class RecordedLines final : public gpio::GpioChip, public gpio::InputLines {
public:
    RecordedLines(gpio::Clock& clock, std::size_t most_writes) : clock_(clock) {
        writes_.reserve(most_writes);
    }
    std::size_t meets_at = 0;  // the number of that write, from 1; 0: none
    bool is_contact = false;
    bool waits = false;
    std::function<void()> met;  // in the thread that writes

    std::size_t line_count() const override { return 8; }
    Status write(gpio::LineMask changed, gpio::LineMask levels) override {
        counts_allocations = waits;
        levels_ = (levels_ & ~changed) | (levels & changed);
        if (writes_.size() == writes_.capacity()) return Done{};
        writes_.push_back({clock_.now_ns(), levels_});
        if (writes_.size() != meets_at) return Done{};
        if (met) met();
        met_ns_ = clock_.now_ns();
        has_met_ = true;
        while (waits && noticed_ < 2) std::this_thread::yield();
        return Done{};
    }
    Status release() override { return Done{}; }
    Result<gpio::LineMask> read() override { return gpio::LineMask{has_met_ && is_contact}; }
    Result<std::size_t> collect(std::span<gpio::InputEdge> edges) override {
        const bool first = notice();
        if (!first || !is_contact) return std::size_t{0};
        edges[0] = {met_ns_, 0, true};
        return std::size_t{1};
    }
    Result<bool> wait_ns(std::int64_t) override {
        std::this_thread::sleep_for(std::chrono::microseconds(100));
        return false;
    }
    // Once, when it has been met. After a second look the first has had its effect.
    bool notice() { return has_met_ && noticed_++ == 0; }

    // All but the last, after which all lines but enable are inactive.
    Edges run() const { return {writes_.begin(), writes_.end() - 1}; }

private:
    gpio::Clock& clock_;
    Edges writes_;
    gpio::LineMask levels_ = 0;
    std::int64_t met_ns_ = 0;
    std::atomic<bool> has_met_{false};
    std::atomic<int> noticed_{0};
};

// One that steps 640 times a mm, up to 30,000 times a second.
config::Printer fine_machine() {
    config::Printer printer = machine_of(Kinematics::cartesian);
    for (std::size_t i = 0; i < 3; ++i)
        printer.axes[i] = {640, 50, 500, -2'000, 2'000, false, {}, {}, {}};
    printer.endstops = {};
    printer.endstops[0].input = config::Pin{"c", 1u, false};
    printer.homing.settle_ms = 0;
    printer.start_mm = {5, 6, 7};
    return printer;
}

std::vector<motion::Move> along_x(const config::Printer& printer, double way_mm) {
    const auto& [x, y, z] = printer.start_mm;
    return {{motion::Line{{x, y, z}, {x + way_mm, y, z}}, 48}};
}

// What the executor makes of edges that all are there, asked `requests` times to stop in the write of that number.
Edges executed(const config::Printer& printer, const Edges& edges, std::size_t meets_at,
               int requests) {
    HurriedClock clock;
    RecordedLines bench(clock, edges.size() + 8);
    run::StopRequests stop{0};
    bench.meets_at = meets_at;
    bench.met = [&] { stop += requests; };
    run::ExecutorTiming timing = run::executor_timing(printer);
    timing.braking_ns = std::llround(2 * 48.0 / 500 * 1e9);
    run::Executor executor(bench, clock, timing, stop);
    REQUIRE(executor.execute(edges).ok());
    REQUIRE(bench.write(0, 0).ok());
    return bench.run();
}

}  // namespace

TEST_CASE("move stream 3: the edges of moves that turn are those of all moves at once") {
    for (const Kinematics kinematics :
         {Kinematics::cartesian, Kinematics::corexy, Kinematics::delta}) {
        for (const bool is_smooth : {false, true}) {
            CAPTURE(static_cast<int>(kinematics));
            CAPTURE(is_smooth);
            config::Printer printer = machine_of(kinematics);
            printer.start_mm = {1, 2, 30};
            printer.backlash_mm = {0, is_smooth ? 0.1 : 0, 0};
            if (is_smooth) printer.max_jerk_mm_s3 = 50'000;
            const motion::Point a{1, 2, 30}, b{40, 12, 31}, c{35, -4, 30};
            const std::vector<motion::Move> moves{
                {motion::Line{a, b}, 80}, {motion::Line{b, c}, 120}, {motion::Line{c, a}, 60}};
            const Edges all = all_edges(printer, moves);
            REQUIRE(all.size() > 10'000);
            auto stream = MoveStream::create(printer, moves);
            REQUIRE(stream.ok());
            Edges pieces;
            std::size_t longest = 0;
            for (bool more = true; more;) {
                const std::size_t before = pieces.size();
                more = stream->next(pieces);
                longest = std::max(longest, pieces.size() - before);
            }
            check_same(pieces, all);
            CHECK(longest < 10'000);
        }
    }
}

TEST_CASE("mover 5: a move that the planner refuses is refused before anything moves") {
    for (const bool is_board : {false, true}) {
        const config::Printer printer = fine_machine();
        HurriedClock clock;
        RecordedLines bench(clock, 100);
        run::StopSource stop;
        if (is_board) stop = [] { return 0u; };
        Mover mover(printer, bench, clock, nullptr, stop);
        std::vector<motion::Move> moves = along_x(printer, 50);
        moves.push_back({motion::Line{{0, 0, 0}, {2 * motion::Planner::farthest_mm, 0, 0}}, 48});
        const auto moved = mover.run(printer, moves);
        REQUIRE_FALSE(moved.ok());
        CHECK(moved.error().status == ExitStatus::machine);
        REQUIRE(bench.write(0, 0).ok());
        CHECK(bench.run().empty());
    }
}

TEST_CASE(
    "mover 5: a metre in small steps takes no more memory than the ring has, and has all its "
    "edges" *
    doctest::test_suite("long")) {
    const config::Printer printer = fine_machine();
    const std::vector<motion::Move> moves = along_x(printer, 1'000);
    const Edges all = all_edges(printer, moves);
    REQUIRE(all.size() > 1'200'000);
    for (const bool is_board : {false, true}) {
        CAPTURE(is_board);
        HurriedClock clock;
        RecordedLines bench(clock, all.size() + 8);
        bench.waits = is_board;
        run::StopSource stop;
        if (is_board) stop = [] { return 0u; };
        Mover mover(printer, bench, clock, nullptr, stop);
        allocations = 0;
        const std::size_t before = held_bytes;
        most_held_bytes = before;
        const auto moved = mover.run(printer, moves);
        counts_allocations = false;
        CHECK(allocations == 0);  // in the thread that writes
        REQUIRE(moved.ok());
        const std::size_t ring_bytes = run::EventFlow::ring_events * sizeof(run::LineEvent);
        CHECK(most_held_bytes - before < (is_board ? ring_bytes : 0) + 200'000);
        CHECK(moved->counts[0] == 640'000);
        check_same(bench.run(), all);
    }
}

TEST_CASE(
    "mover 1, 5: a contact that closes on the way brings it to rest as if all edges were there") {
    const config::Printer printer = fine_machine();
    const std::vector<motion::Move> moves = along_x(printer, -300);
    const Edges all = all_edges(printer, moves);
    const std::size_t closes_at = all.size() / 3;
    for (const bool is_board : {false, true}) {
        CAPTURE(is_board);
        HurriedClock clock;
        RecordedLines bench(clock, all.size() + 8);
        bench.waits = is_board;
        bench.is_contact = true;
        bench.meets_at = closes_at;
        run::StopSource stop;
        if (is_board) stop = [] { return 0u; };
        Mover mover(printer, bench, clock, &bench, stop);
        const auto moved = mover.run(printer, moves, Contacts(1));
        REQUIRE_MESSAGE(moved.ok(), moved.error().message);
        // With virtual time inputs are looked at before the next write.
        const Edges expected = executed(printer, all, is_board ? closes_at : closes_at + 1, 1);
        CHECK(expected.size() > closes_at + 1'000);
        CHECK(expected.size() < all.size() / 2);
        check_same(bench.run(), expected);
        REQUIRE(moved->at_contact[0]);
        CHECK((*moved->at_contact[0])[0] == -static_cast<std::int64_t>(closes_at) / 2);
        counts_allocations = false;
    }
}

TEST_CASE(
    "mover 3, 5: asked to stop on the way, once or twice, it does as if all edges were there") {
    const config::Printer printer = fine_machine();
    const std::vector<motion::Move> moves = along_x(printer, 300);
    const Edges all = all_edges(printer, moves);
    const std::size_t asked_at = all.size() / 2 + 1;
    for (const unsigned requests : {1u, 2u}) {
        CAPTURE(requests);
        HurriedClock clock;
        RecordedLines bench(clock, all.size() + 8);
        bench.waits = true;
        bench.meets_at = asked_at;
        Mover mover(printer, bench, clock, nullptr, [&] { return bench.notice() ? requests : 0u; });
        const auto moved = mover.run(printer, moves);
        REQUIRE_FALSE(moved.ok());
        CHECK(moved.error().status == ExitStatus::stopped);
        const Edges expected = executed(printer, all, asked_at, static_cast<int>(requests));
        CHECK((expected.size() < asked_at + 3) == (requests == 2));
        CHECK(expected.size() < all.size() * 2 / 3);
        check_same(bench.run(), expected);
        counts_allocations = false;
    }
}
