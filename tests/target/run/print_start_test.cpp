// What goes before the path of a print, and what may happen meanwhile: contract of target/run/print.h, by number.

#include <doctest/doctest.h>

#include <fstream>
#include <thread>

#include "target/gpio/mock_chip.h"
#include "target/run/print.h"
#include "target/run/print_files.h"

using namespace lyr;
using namespace lyr::run;
using namespace lyr::tests;

namespace {

constexpr std::size_t start_lines = 8;

config::Printer starting_printer() {
    config::Printer printer = config::generic_printer();
    printer.pulse.late_limit_ns = 10'000'000'000;
    printer.heaters = {};
    return printer;
}

void draw_stroke(const Pen& pen) {
    pen.path(80);
    pen.travel(0, 0);
    pen.line(4, 0);
    pen.line(0, 0);
}

// Far outside of any range.
void draw_far(const Pen& pen) {
    pen.path(80);
    pen.travel(0, 0);
    pen.line(10'000, 0);
}

// As a copy over it does: the same file, other bytes.
void overwrite(const std::string& file, const std::string& from) {
    std::ofstream(file, std::ios::binary | std::ios::trunc)
        << std::ifstream(from, std::ios::binary).rdbuf();
}

}  // namespace

TEST_CASE("print 1: a file that was replaced after its inspection was printed uninspected") {
    gpio::MonotonicClock clock;
    for (const bool in_place : {false, true}) {
        const std::string file = write_print("inspected", {draw_stroke});
        const std::string other = write_print("not_inspected", {draw_far});
        std::vector<gpio::LineWrite> writes;
        gpio::MockChip chip(start_lines, clock, gpio::recorder(writes));
        PrintJob job{file, starting_printer(), true, {}};
        job.checked = [&] {
            in_place ? overwrite(file, other) : std::filesystem::rename(other, file);
        };
        const Result<PrintReport> refused = print(job, chip, clock);
        REQUIRE_FALSE(refused.ok());
        CHECK(refused.error().status == ExitStatus::input);
        CHECK(refused.error().message.find("changed after it was inspected") != std::string::npos);
        CHECK(writes.empty());
    }
}

TEST_CASE("print 1: a file that is written to while it is printed brings the head to rest") {
    const std::string file = write_print("written_to", std::vector<Drawing>(60, draw_square));
    const std::string other = write_print("not_inspected", {draw_far});
    gpio::MonotonicClock clock;
    std::vector<gpio::LineWrite> writes;
    gpio::MockChip chip(start_lines, clock, gpio::recorder(writes));
    PrintJob job{file, starting_printer(), true, {}};
    job.progress = [&](const Progress& now) {
        if (now.time_s > 0.2) overwrite(file, other);
    };
    const Result<PrintReport> ended = print(job, chip, clock);
    REQUIRE_FALSE(ended.ok());
    CHECK(ended.error().message.find("changed after it was inspected") != std::string::npos);
    CHECK(writes.back().levels == 0);
    std::int64_t x = 0, most = 0;
    gpio::LineMask before = 0;
    for (const gpio::LineWrite& write : writes) {
        if (~before & write.levels & step_bit(0)) x += write.levels & direction_bit(0) ? 1 : -1;
        before = write.levels;
        most = std::max(most, x);
    }
    CHECK(static_cast<double>(most) / job.printer.axes[0].steps_per_mm < 65);
}
