// Contract of target/run/stream_beside.h, by number.

#include "target/run/stream_beside.h"

#include <doctest/doctest.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <limits>

#include "target/run/print_files.h"

using namespace lyr;
using namespace lyr::run;
using namespace lyr::tests;

namespace {

constexpr std::int64_t unlimited_ns = std::numeric_limits<std::int64_t>::max(),
                       half_second_ns = 500'000'000;

// Several groups long, and of more moves than are planned ahead.
void draw_teeth(const Pen& pen) {
    draw_arcs(pen);
    for (int i = 0; i < 120; ++i) pen.line(i % 2, 0.1 * i);
}

std::string print_of_teeth() {
    return write_print("stream_beside", std::vector<Drawing>(16, draw_teeth));
}

EventStream stream_of(const std::string& file, const config::Printer& printer) {
    Result<EventStream> stream = EventStream::open(file, printer, 1.75);
    REQUIRE(stream.ok());
    return std::move(*stream);
}

bool same(const LineEvent& a, const LineEvent& b) {
    return a.time_ns == b.time_ns && a.levels == b.levels;
}

bool same(const std::vector<LineEvent>& a, const std::vector<LineEvent>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const LineEvent& x, const LineEvent& y) { return same(x, y); });
}

// All events, the factor of the file's speeds being `faster` from the n-th portion on; a slow reader lets the thread run
// ahead as far as it may.
std::vector<LineEvent> read(const std::string& file, const config::Printer& printer,
                            std::int64_t longest_group_ns, std::size_t n, float faster,
                            bool slowly) {
    std::atomic<float> factor{1};
    StreamBeside beside(stream_of(file, printer), factor, longest_group_ns);
    std::vector<LineEvent> events;
    for (std::size_t i = 0;; ++i) {
        if (i == n) factor = faster;
        if (slowly) std::this_thread::sleep_for(std::chrono::milliseconds(2));
        const Portion& portion = beside.next();
        REQUIRE(portion.more.ok());
        events.insert(events.end(), portion.events.begin(), portion.events.end());
        if (!*portion.more) return events;
    }
}

}  // namespace

TEST_CASE("stream beside 1: portions are those of the stream, and bring the same along" *
          doctest::test_suite("long")) {
    const std::string file = print_of_teeth();
    config::Printer crossed = config::generic_printer();
    crossed.kinematics = config::Kinematics::corexy;
    for (const config::Printer& printer : {config::generic_printer(), crossed})
        for (const std::int64_t longest_group_ns :
             {std::int64_t{1}, half_second_ns, unlimited_ns}) {
            EventStream plain = stream_of(file, printer);
            const std::atomic<float> factor{1};
            StreamBeside beside(stream_of(file, printer), factor, longest_group_ns);
            std::size_t portions = 0, moves = 0, layers = 0;
            for (bool more = true; more; ++portions) {
                std::vector<LineEvent> events;
                more = *plain.next(events);
                const Portion& portion = beside.next();
                REQUIRE(portion.more.ok());
                REQUIRE(*portion.more == more);
                CHECK(same(portion.events, events));
                REQUIRE(portion.moves.size() == plain.steps().moves().size());
                for (std::size_t i = 0; i < portion.moves.size(); ++i)
                    CHECK(portion.moves[i].start_ns == plain.steps().moves()[i].start_ns);
                CHECK(portion.begun.size() == plain.steps().begun().size());
                CHECK(portion.layer == plain.steps().layer());
                CHECK(portion.shifts.size() == plain.schedule().take_shifts().size());
                CHECK(portion.shift_ns == plain.schedule().shift_ns());
                moves += portion.moves.size();
                layers += portion.begun.size();
            }
            CHECK(portions > (StreamBeside::ahead + 1) * StreamBeside::batches_in_group);
            CHECK(moves > 100);
            CHECK(layers == 16);
        }
}

TEST_CASE(
    "stream beside 2: a change of speed shows at the same event, whichever thread is quicker" *
    doctest::test_suite("long")) {
    const std::string file = print_of_teeth();
    const config::Printer printer = config::generic_printer();
    const std::vector<LineEvent> plain = read(file, printer, half_second_ns, 5, 1, false);
    const std::vector<LineEvent> faster = read(file, printer, half_second_ns, 5, 1.5F, false);
    CHECK(faster.back().time_ns < plain.back().time_ns);
    CHECK(same(read(file, printer, half_second_ns, 5, 1.5F, true), faster));
}

TEST_CASE("stream beside 3: what nobody takes is left undone, and an error comes in its place") {
    const std::string file = print_of_teeth();
    const config::Printer printer = config::generic_printer();
    const std::atomic<float> factor{1};
    { const StreamBeside left(stream_of(file, printer), factor, unlimited_ns); }
    {
        StreamBeside begun(stream_of(file, printer), factor, unlimited_ns);
        CHECK(begun.next().more.ok());
    }
    std::ifstream in(file, std::ios::binary);
    std::string bytes((std::istreambuf_iterator<char>(in)), {});
    bytes[bytes.size() * 3 / 4] ^= 1;
    const std::string damaged = file + ".damaged";
    std::ofstream(damaged, std::ios::binary) << bytes;
    StreamBeside beside(stream_of(damaged, printer), factor, unlimited_ns);
    std::size_t portions = 0;
    Result<bool> more = true;
    for (; more.ok() && *more; ++portions) more = beside.next().more;
    REQUIRE(!more.ok());
    CHECK(more.error().status == ExitStatus::input);
    CHECK(portions > 1);
}
