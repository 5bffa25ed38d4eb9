// Prints that end otherwise than planned, and what a pause leaves as it was.

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "target/gpio/mock_chip.h"
#include "target/run/patient_printer.h"
#include "target/run/print.h"
#include "target/run/print_files.h"
#include "target/run/simulate.h"

using namespace lyr;
using namespace lyr::run;
using namespace lyr::tests;

TEST_CASE("print 3: lines that cannot be released are told") {
    class Sticky final : public gpio::GpioChip {
    public:
        explicit Sticky(const gpio::Clock& clock) : inner_(16, clock, {}) {}
        std::size_t line_count() const override { return inner_.line_count(); }
        Status write(gpio::LineMask changed, gpio::LineMask levels) override {
            return inner_.write(changed, levels);
        }
        Status release() override {
            return Diagnostic{Severity::error, ExitStatus::machine, "the lines stick", {}};
        }

    private:
        gpio::MockChip inner_;
    };
    gpio::MonotonicClock clock;
    Sticky chip(clock);
    const std::string file = write_print("sticky", {[](const Pen& pen) {
                                             pen.path();
                                             pen.travel(0, 0);
                                             pen.line(1, 0);
                                         }});
    const auto report = print({file, nearby_printer(), true, {}}, chip, clock);
    REQUIRE_FALSE(report.ok());
    CHECK(report.error().message.find("the lines stick") != std::string::npos);
}

TEST_CASE(
    "print 1: a file that changes while it is printed brings the head to rest before that is "
    "told") {
    config::Printer printer = nearby_printer();
    const std::string file =
        write_print("changed_under_way", std::vector<Drawing>(40, draw_square));
    gpio::MonotonicClock clock;
    std::vector<gpio::LineWrite> writes;
    bool changed = false;
    gpio::MockChip chip(16, clock, [&](const gpio::LineWrite& write) {
        writes.push_back(write);
        if (changed || writes.size() < 4000) return;
        changed = true;
        std::ofstream(file, std::ios::app) << ' ';
    });
    PrintJob job{file, printer, true, {}};
    const auto report = print(job, chip, clock);
    REQUIRE_FALSE(report.ok());
    // The steps of an axis come further and further apart.
    std::vector<std::int64_t> rises;
    gpio::LineMask before = 0;
    for (const gpio::LineWrite& write : writes) {
        if (write.levels & ~before & all_step_bits) rises.push_back(write.time_ns);
        before = write.levels;
    }
    REQUIRE(rises.size() > 50);
    const auto gap = [&](std::size_t back) {
        return (rises[rises.size() - back] - rises[rises.size() - back - 10]) / 10;
    };
    CHECK(gap(1) > 3 * gap(rises.size() / 2));
}

TEST_CASE("life 1: a pause leaves the play of the axes as the path had it") {
    const std::string file = write_print("played", {draw_arcs, draw_square});
    config::Printer printer = config::generic_printer();
    printer.pause.park_mm = {{5, 120}};
    printer.backlash_mm = {0.1, 0.2, 0.05};
    const auto with = [&](const std::string& script) {
        SimulationJob job{file, printer, {}, {}, {}};
        job.no_heat = true;
        job.script = *parse_script(script, "script");
        return simulate(job);
    };
    const auto plain = with("");
    for (const double share : {0.31, 0.52, 0.77}) {
        const auto paused =
            with(std::to_string(plain->print_time_s * share) + " pause\n100 resume");
        REQUIRE_MESSAGE(paused.ok(), (paused.ok() ? "" : paused.error().message));
        CHECK(paused->positions == plain->positions);
        CHECK(paused->trip_steps == plain->trip_steps);
    }
}
