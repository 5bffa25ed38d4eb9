// Contract of target/run/checks_beside.h, by number.

#include "target/run/checks_beside.h"

#include <doctest/doctest.h>

#include "target/run/file_path.h"
#include "target/run/print_files.h"
#include "target/run/step_stream.h"

using namespace lyr;
using namespace lyr::run;
using namespace lyr::tests;

namespace {

// Some batches long.
std::string long_print() {
    return write_print("beside", std::vector<Drawing>(12, draw_arcs));
}

CurveSource curves_of(FilePath& path) {
    return [&path](PathCurve& curve) { return path.next(curve); };
}

FilePath path_of(const std::string& file, const config::Printer& printer) {
    Result<format::Reader> reader = format::Reader::open(file);
    REQUIRE(reader.ok());
    return FilePath(std::move(*reader), printer.start_mm, 1.75);
}

// The steps as planned, but for the one that is left out. Returns how many there are.
template <class Checks>
std::size_t feed(Checks& checks, const std::string& file, const config::Printer& printer,
                 std::size_t left_out, StepPositions& at) {
    Result<StepStream> stream = StepStream::open(file, printer, 1.75);
    REQUIRE(stream.ok());
    std::size_t count = 0;
    for (bool more = true; more;) {
        std::vector<Step> steps;
        more = *stream->next(steps);
        checks.expect(stream->moves(), {});
        for (const Step& step : steps) {
            if (++count == left_out) continue;
            checks.step({step.time_ns, step.axis, at, step.positive});
            at[step.axis] += step.positive ? 1 : -1;
        }
    }
    return count;
}

}  // namespace

TEST_CASE("checks beside 1, 2: on a thread of their own they say what they say here" *
          doctest::test_suite("long")) {
    const std::string file = long_print();
    config::Printer crossed = config::generic_printer();
    crossed.kinematics = config::Kinematics::corexy;
    for (const config::Printer& printer : {config::generic_printer(), crossed})
        for (const std::size_t left_out : {0, 5000, 60'000}) {
            CAPTURE(left_out);
            FilePath here = path_of(file, printer), there = path_of(file, printer);
            StepChecks plain(printer, curves_of(here));
            ChecksBeside beside(printer, curves_of(there));
            StepPositions plain_at{}, beside_at{};
            const std::size_t steps = feed(plain, file, printer, left_out, plain_at);
            CHECK(steps > (ChecksBeside::most_waiting + 1) * ChecksBeside::steps_in_batch);
            CHECK(feed(beside, file, printer, left_out, beside_at) == steps);
            CHECK(plain.finish(plain_at).ok());
            CHECK(beside.finish(beside_at).ok());
            CHECK(beside.checks().off_plan() == plain.off_plan());
            CHECK(beside.checks().off_file().steps == plain.off_file().steps);
            CHECK(beside.checks().off_file().worst_at_mm == plain.off_file().worst_at_mm);
            CHECK((plain.off_plan()[config::axis_x] > 0.9 ||
                   plain.off_plan()[config::axis_y] > 0.9 ||
                   plain.off_plan()[config::axis_e] > 0.9) == (left_out > 0));
        }
}

TEST_CASE("checks beside 3: what is not finished is left, and an error of the file is told" *
          doctest::test_suite("long")) {
    const std::string file = long_print();
    const config::Printer printer = config::generic_printer();
    FilePath path = path_of(file, printer);
    StepPositions at{};
    {
        ChecksBeside left(printer, curves_of(path));
        feed(left, file, printer, 0, at);
    }
    const Diagnostic broken{Severity::error, ExitStatus::input, "the file is broken", {}};
    ChecksBeside failing(printer, [&](PathCurve&) -> Result<bool> { return broken; });
    at = {};
    feed(failing, file, printer, 0, at);
    const Status finished = failing.finish(at);
    REQUIRE(!finished.ok());
    CHECK(finished.error().message == broken.message);
}
