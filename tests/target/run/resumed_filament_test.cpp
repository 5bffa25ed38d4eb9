// What resumption.h (5), life.h (7, 8) and print.h (7) say of the filament of prints that were cut off.

#include <doctest/doctest.h>

#include <csignal>
#include <filesystem>

#include "target/gpio/mock_chip.h"
#include "target/run/cut_off.h"
#include "target/run/patient_printer.h"
#include "target/run/print.h"
#include "target/run/print_files.h"

using namespace lyr;
using namespace lyr::run;
using namespace lyr::tests;

namespace {

void draw_first_stroke(const Pen& pen) {
    pen.path(80);
    pen.line(4, 0);
}

// In mm of filament.
double pushed_mm(const config::Printer& printer, std::int64_t steps) {
    return static_cast<double>(steps) / printer.axes[config::axis_e].steps_per_mm;
}

}  // namespace

TEST_CASE("resumption 5: the first line of a resumed print lacked what a pause had drawn back") {
    const config::Printer printer = config::generic_printer();
    const Drawing drawing = [](const Pen& pen) {
        pen.layer.unretract();
        draw_square(pen);
        pen.layer.retract();
    };
    const std::string file =
        write_print("resume_filament", {drawing, drawing, drawing}, {}, [](auto& state) {
            state.retracted_mm = state.retract_length_mm = 0.5;
            state.temperatures.push_back({{format::HeaterKind::tool, 0}, 210});
        });
    // Of the extruder, in mm.
    const auto resumed_mm = [&](std::int32_t drawn_back_um) {
        JournalEntry entry;
        entry.layer = 2;
        entry.drawn_back_um = drawn_back_um;
        write_journal(printer, file, entry);
        SimulationJob job{file, printer, {}, {}, {}};
        const Result<Resumption> found = find_resumption(printer, file);
        REQUIRE(found.ok());
        job.resumption = *found;
        const Result<SimulationReport> resumed = simulate(job);
        REQUIRE_MESSAGE(resumed.ok(), (resumed.ok() ? "" : to_string(resumed.error())));
        CHECK(resumed->within_limits());
        return pushed_mm(printer, resumed->positions[config::axis_e]);
    };
    // As far as the layer's begin has it: then the file is followed as it is.
    const double as_in_file_mm = resumed_mm(500);
    CHECK(resumed_mm(0) == doctest::Approx(as_in_file_mm - 0.5).epsilon(1e-4));
    CHECK(resumed_mm(2'500) == doctest::Approx(as_in_file_mm + 2).epsilon(1e-4));
    std::filesystem::remove(file + ".journal");
}

TEST_CASE("resumption 5: after a loss of power in a change of filament the print went on without") {
    const config::Printer printer = config::generic_printer();
    const std::string file =
        write_print("resume_unloaded", {draw_square, draw_square}, {}, [](auto& state) {
            state.temperatures.push_back({{format::HeaterKind::tool, 0}, 210});
        });
    JournalEntry entry;
    entry.layer = 2;
    entry.rest_nm = 6'500'000;
    entry.drawn_back_um = 2'000;
    entry.is_unloaded = true;
    write_journal(printer, file, entry);
    const Result<Resumption> found = find_resumption(printer, file);
    REQUIRE(found.ok());
    CHECK(found->drawn_back_mm == 0);
    CHECK(text_of(*found, file).find("the filament drawn out") != std::string::npos);
    SimulationJob job{file, printer, {}, {}, {}};
    job.resumption = *found;
    const Result<SimulationReport> rests = simulate(job);
    REQUIRE_FALSE(rests.ok());
    CHECK(rests.error().message.find("the print rests") != std::string::npos);
    job.script = {{600, Resume{}}};
    const Result<SimulationReport> resumed = simulate(job);
    REQUIRE_MESSAGE(resumed.ok(), (resumed.ok() ? "" : to_string(resumed.error())));
    CHECK(resumed->within_limits());
    // At the end it is drawn back, and the head lifted, once more.
    CHECK(pushed_mm(printer, resumed->trip_steps[config::axis_e]) ==
          doctest::Approx(printer.filament.load_mm + printer.filament.purge_mm -
                          printer.pause.retract_mm)
              .epsilon(1e-4));
    CHECK(resumed->trip_steps[config::axis_z] == 2 * 2'000);
    std::filesystem::remove(file + ".journal");
}

// The same in a print's threads, all heaters off: what is pushed before and on the path.
TEST_CASE("print 7: a print in real time begins with the filament as the journal has it") {
    config::Printer printer = nearby_printer();
    printer.filament = {2, 2, 1, 20};
    const std::string file = write_print("resume_real", {draw_first_stroke, draw_first_stroke});
    const auto resumed_mm = [&](std::int32_t drawn_back_um, bool is_unloaded) {
        JournalEntry entry;
        entry.layer = 2;
        entry.drawn_back_um = drawn_back_um;
        entry.is_unloaded = is_unloaded;
        write_journal(printer, file, entry);
        gpio::MonotonicClock clock;
        std::vector<gpio::LineWrite> writes;
        gpio::MockChip chip(line_count, clock, gpio::recorder(writes));
        PrintControl control;
        int rests = 0;
        PrintJob job{file, printer, false, [&](const Progress& now) {
                         CHECK(now.time_s >= 5);  // it was cut off then
                         if (control.status().state != PrintState::paused) return;
                         ++rests;
                         control.post(Resume{});
                     }};
        job.control = &control;
        job.journal = file + ".journal";
        const Result<Resumption> found = find_resumption(printer, file);
        REQUIRE(found.ok());
        job.resumption = *found;
        const Result<PrintReport> report = print(job, chip, clock);
        REQUIRE_MESSAGE(report.ok(), (report.ok() ? "" : report.error().message));
        CHECK((rests > 0) == is_unloaded);
        CHECK(report->paused_s < 100);
        CHECK_FALSE(std::filesystem::exists(job.journal));
        std::int64_t steps = 0;
        gpio::LineMask before = 0;
        for (const gpio::LineWrite& write : writes) {
            if (~before & write.levels & step_bit(config::axis_e))
                steps += (write.levels & direction_bit(config::axis_e)) != 0 ? 1 : -1;
            before = write.levels;
        }
        return pushed_mm(printer, steps);
    };
    const double plain_mm = resumed_mm(0, false);
    CHECK(resumed_mm(1'500, false) == doctest::Approx(plain_mm + 1.5).epsilon(1e-3));
    CHECK(resumed_mm(1'500, true) == doctest::Approx(plain_mm + 3).epsilon(1e-3));
}

// Stopped while the file has the filament drawn back, and while it is pushed.
TEST_CASE("life 7: how far the path had drawn the filament back was not noted") {
    const config::Printer printer = nearby_printer();
    const std::string file = write_print("drawn_back", {[](const Pen& pen) {
                                             pen.path(40);
                                             pen.line(1, 0);
                                             pen.layer.dwell(1'000);
                                             pen.layer.retract();
                                             pen.layer.dwell(2'000);
                                             pen.layer.unretract();
                                             pen.line(2, 0);
                                         }},
                                         {}, [](auto& state) { state.retract_length_mm = 0.8; });
    for (const bool is_drawn_back : {false, true}) {
        gpio::MonotonicClock clock;
        gpio::MockChip chip(line_count, clock, {});
        bool sent = false;
        PrintJob job{file, printer, false, [&](const Progress& now) {
                         if (now.time_s <= (is_drawn_back ? 0.95 : 0)) return;
                         if (!sent) std::raise(SIGTERM);
                         sent = true;
                     }};
        job.journal = file + ".journal";
        REQUIRE_FALSE(print(job, chip, clock).ok());
        const auto entry = read_journal(job.journal);
        REQUIRE((entry.ok() && *entry));
        CHECK((*entry)->rest_nm.has_value());
        CHECK((*entry)->drawn_back_um == (is_drawn_back ? 800 : 0));
        std::filesystem::remove(job.journal);
    }
}
