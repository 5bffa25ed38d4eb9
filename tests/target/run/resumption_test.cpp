// Contract of target/run/resumption.h, by number, and what life.h (7, 8) and print.h (6 to 8) say: prints that are cut off,
// and go on.

#include "target/run/resumption.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>

#include "target/gpio/mock_chip.h"
#include "target/run/cut_off.h"
#include "target/run/patient_printer.h"
#include "target/run/print.h"
#include "target/run/print_files.h"

using namespace lyr;
using namespace lyr::run;
using namespace lyr::tests;

namespace {

// Absolute, in mm, as the steps say.
double end_mm(const SimulationReport& report, std::size_t axis) {
    return report.printer.start_mm[axis] +
           static_cast<double>(report.positions[axis]) / report.printer.axes[axis].steps_per_mm;
}

void write_entry(const config::Printer& printer, const std::string& file, std::uint32_t layer,
                 std::optional<std::int64_t> rest_nm = {},
                 std::optional<std::array<std::int32_t, 2>> place_um = {}) {
    JournalEntry entry;
    entry.layer = layer;
    entry.rest_nm = rest_nm;
    entry.place_um = place_um;
    write_journal(printer, file, entry);
}

}  // namespace

TEST_CASE(
    "resumption 1, 3: from any layer a print goes on as it would have, and ends where it would "
    "have" *
    doctest::test_suite("long")) {
    const config::Printer printer = config::generic_printer();
    const std::string file = write_print(
        "resume", {draw_square, draw_arcs, draw_hatch, draw_climb, draw_circles, draw_wipes}, {},
        [](format::LayerState& state) {
            state.temperatures.push_back({{format::HeaterKind::tool, 0}, 210});
        });
    const Result<SimulationReport> whole = simulate({file, printer, {}, {}, {}});
    REQUIRE(whole.ok());
    for (const std::uint32_t layer : {0u, 1u, 2u, 4u, 6u}) {
        for (const bool is_parked : {false, true}) {
            CAPTURE(layer);
            write_entry(printer, file, layer,
                        is_parked ? std::optional(std::int64_t{6'500'000}) : std::nullopt);
            const Result<Resumption> found = find_resumption(printer, file);
            REQUIRE_MESSAGE(found.ok(), (found.ok() ? "" : to_string(found.error())));
            CHECK(found->first_layer == std::max(1u, layer) - 1);
            const double z_mm = is_parked ? 6.5 : 0.2 * layer;
            CHECK(found->stopped_z_mm == doctest::Approx(z_mm));
            CHECK(lifted(printer, *found).start_mm[2] == doctest::Approx(z_mm + 5));
            SimulationJob job{file, printer, {}, {}, {}};
            job.resumption = *found;
            const Result<SimulationReport> resumed = simulate(job);
            REQUIRE_MESSAGE(resumed.ok(), (resumed.ok() ? "" : to_string(resumed.error())));
            CHECK(resumed->within_limits());
            // Lifted by 5 mm, and nothing else was moved aside.
            StepPositions moved_aside = whole->trip_steps;
            moved_aside[config::axis_z] += 2'000;
            CHECK(resumed->trip_steps == moved_aside);
            for (std::size_t axis = 0; axis < 3; ++axis)
                CHECK(end_mm(*resumed, axis) == doctest::Approx(end_mm(*whole, axis)));
            CHECK(resumed->paused_s + resumed->waited_s > 30);
        }
    }
    std::filesystem::remove(file + ".journal");
}

TEST_CASE(
    "resumption 4: a crooked bed's difference between the layer's begin and start_mm counts") {
    config::Printer printer = config::generic_printer();
    const std::string file = write_print("crooked", {draw_square, draw_arcs, draw_square});
    write_entry(printer, file, 2);
    const Result<Resumption> flat = find_resumption(printer, file);
    REQUIRE(flat.ok());
    // A plane: of the same slope everywhere, and as high at the start as the mesh's other corner is far.
    constexpr double slope = 0.01, width_mm = 200;
    printer.mesh.area_mm = {0, 0, width_mm, width_mm};
    printer.mesh.heights_mm = {{0, slope * width_mm}, {0, slope * width_mm}};
    printer.start_mm = {150, 20, 0.2};
    write_entry(printer, file, 2);
    const Result<Resumption> crooked = find_resumption(printer, file);
    REQUIRE(crooked.ok());
    CHECK(crooked->stopped_z_mm ==
          doctest::Approx(flat->stopped_z_mm + slope * (flat->state.start_x_mm - 150)));
    // Where it was in the layer is noted.
    write_entry(printer, file, 2, {}, std::array<std::int32_t, 2>{120'000, 45'500});
    const Result<Resumption> within = find_resumption(printer, file);
    REQUIRE(within.ok());
    CHECK(within->stopped_z_mm == doctest::Approx(flat->stopped_z_mm + slope * (120 - 150)));
    // Where it was parked its height is known, and counts from start_mm already.
    write_entry(printer, file, 2, 6'500'000);
    const Result<Resumption> parked = find_resumption(printer, file);
    REQUIRE(parked.ok());
    CHECK(parked->stopped_z_mm == doctest::Approx(6.5));
    std::filesystem::remove(file + ".journal");
}

TEST_CASE("resumption 3: a print cut off before its first layer went on a layer's height too low") {
    config::Printer printer = config::generic_printer();
    const std::string file = write_print("before_path", {draw_square, draw_arcs});
    printer.mesh.area_mm = {0, 0, 200, 200};
    printer.mesh.heights_mm = {{0, 2}, {0, 2}};
    for (const double start_mm : {0.0, 10.0}) {
        printer.start_mm = {150, 20, start_mm};
        for (const auto& place_um : {std::optional<std::array<std::int32_t, 2>>(),
                                     std::optional(std::array<std::int32_t, 2>{120'000, 45'500})}) {
            write_entry(printer, file, 0, {}, place_um);
            const Result<Resumption> found = find_resumption(printer, file);
            REQUIRE(found.ok());
            CHECK(found->first_layer == 0);
            CHECK(found->stopped_z_mm == start_mm);
        }
    }
    std::filesystem::remove(file + ".journal");
}

// A line of 3 mm in 1.5 s over a bed that rises by 0.02 mm for each mm: 24 steps of z.
TEST_CASE(
    "resumption 4: a print cut in the middle of a layer over a bed mesh was off by the bed's") {
    config::Printer printer = nearby_printer();
    printer.mesh.area_mm = {0, 0, 200, 200};
    printer.mesh.heights_mm = {{0, 4}, {0, 4}};
    const std::string file = write_print("cut", {[](const Pen& pen) {
                                             pen.path(2);
                                             pen.line(3, 0);
                                         }});
    const std::string journal = file + ".journal";
    std::filesystem::remove(journal);
    gpio::MonotonicClock clock;
    std::vector<gpio::LineWrite> writes;
    gpio::MockChip chip(line_count, clock, gpio::recorder(writes));
    PrintControl control;
    // What a cut of the power leaves behind.
    std::optional<JournalEntry> cut;
    PrintJob job{file, printer, false, [&](const Progress&) {
                     const auto entry = read_journal(journal);
                     if (!entry.ok() || !*entry || !(*entry)->place_um || cut) return;
                     if ((*(*entry)->place_um)[0] < 35'500) return;  // it begins at 35 mm
                     cut = **entry;
                     std::raise(SIGTERM);
                 }};
    job.control = &control;
    job.journal = journal;
    REQUIRE_FALSE(print(job, chip, clock).ok());
    REQUIRE(cut);
    CHECK(cut->layer == 1);
    std::int64_t z_steps = 0;
    gpio::LineMask before = 0;
    for (const gpio::LineWrite& write : writes) {
        if (~before & write.levels & step_bit(config::axis_z))
            z_steps += (write.levels & direction_bit(config::axis_z)) != 0 ? 1 : -1;
        before = write.levels;
    }
    const double z_mm = static_cast<double>(z_steps) / printer.axes[config::axis_z].steps_per_mm;
    const Result<Resumption> found = find_resumption(printer, file);
    REQUIRE(found.ok());
    CHECK(found->entry.rest_nm.has_value());
    CHECK(found->stopped_z_mm == doctest::Approx(printer.start_mm[2] + z_mm));
    const double gone_mm = std::hypot((*cut->place_um)[0] / 1e3 - found->state.start_x_mm,
                                      (*cut->place_um)[1] / 1e3 - found->state.start_y_mm);
    CHECK(gone_mm > 0.5);
    CHECK(gone_mm < 3);
    std::filesystem::remove(journal);
}

TEST_CASE("resumption 2: a print that was under way was said to be cut off") {
    const config::Printer printer = config::generic_printer();
    const std::string file = write_print("under_way", {draw_square});
    write_journal(printer, file, {});
    {
        const Result<Journal> kept = Journal::open(journal_path(printer, file));
        REQUIRE(kept.ok());
        const Status refused = check_cut_off(printer, file);
        REQUIRE_FALSE(refused.ok());
        CHECK(refused.error().message.find("being printed now") != std::string::npos);
    }
    CHECK(check_cut_off(printer, file).ok());
    std::filesystem::remove(journal_path(printer, file));
}

TEST_CASE("resumption 2: no journal, or another file, is refused") {
    const config::Printer printer = config::generic_printer();
    const std::string file = write_print("resume_other", {draw_square, draw_arcs});
    std::filesystem::remove(file + ".journal");
    const auto refusal = [&] {
        const Result<Resumption> found = find_resumption(printer, file);
        REQUIRE_FALSE(found.ok());
        CHECK(found.error().status == ExitStatus::input);
        return found.error().message;
    };
    CHECK(refusal().find("no journal") != std::string::npos);
    write_entry(printer, file, 2);
    CHECK(find_resumption(printer, file).ok());
    write_print("resume_other", {draw_square, draw_circles});
    CHECK(refusal().find("changed") != std::string::npos);
    write_print("resume_other", {draw_square, draw_arcs});
    CHECK(find_resumption(printer, file).ok());
    std::filesystem::resize_file(file + ".journal", 20);
    CHECK(refusal().find("damaged") != std::string::npos);
    std::filesystem::resize_file(file + ".journal", 0);
    CHECK(refusal().find("nothing in it") != std::string::npos);
    std::filesystem::remove(file + ".journal");
    config::Printer elsewhere = printer;
    elsewhere.recovery_folder = "/var/lib/lyr";
    CHECK(journal_path(elsewhere, "/home/a/part.lyr") == "/var/lib/lyr/part.lyr.journal");
}

TEST_CASE("resumption 2: that the latest entry was lost was passed over in silence") {
    const config::Printer printer = config::generic_printer();
    const std::string file = write_print("resume_lost", {draw_square, draw_arcs});
    {
        Result<Journal> journal = Journal::open(journal_path(printer, file));
        REQUIRE(journal.ok());
        JournalEntry entry;
        entry.file = *identity_of(file);
        entry.printer = identity_of(printer);
        entry.layer = 1;
        REQUIRE(journal->write(entry).ok());
        entry.layer = 2;
        REQUIRE(journal->write(entry).ok());
    }
    CHECK(find_resumption(printer, file)->first_layer == 1);
    CHECK(lost_entry(printer, file).empty());
    {
        // The second one is in front.
        std::fstream torn(journal_path(printer, file), std::ios::in | std::ios::out);
        torn.seekp(60) << "torn";
    }
    CHECK(find_resumption(printer, file)->first_layer == 0);
    const Diagnostics lost = lost_entry(printer, file);
    REQUIRE(lost.size() == 1);
    CHECK(lost[0].severity == Severity::warning);
    CHECK(to_string(lost[0]).find(".journal: warning: one of its two") != std::string::npos);
}

TEST_CASE("resumption 2: a print was resumed with the file of any other printer") {
    const config::Printer printer = config::generic_printer();
    const std::string file = write_print("resume_printer", {draw_square, draw_arcs});
    write_entry(printer, file, 2);
    config::Printer mended = printer, other = printer;
    for (config::Axis& axis : mended.axes) axis.max_speed_mm_s /= 2;
    mended.heaters[config::heater_tool]->guard.high_c -= 20;
    CHECK(find_resumption(mended, file).ok());
    other.axes[config::axis_x].steps_per_mm = 160;
    const Result<Resumption> refused = find_resumption(other, file);
    REQUIRE_FALSE(refused.ok());
    CHECK(refused.error().status == ExitStatus::input);
    CHECK(refused.error().message.find("other steps_per_mm;") != std::string::npos);
    std::filesystem::remove(file + ".journal");
}

TEST_CASE(
    "print 7: a print that is killed at any time leaves a journal; done or cancelled leaves none") {
    const config::Printer printer = nearby_printer();
    const std::string file = write_print("journalled", std::vector<Drawing>(3, draw_small));
    const std::string journal = file + ".journal";
    std::filesystem::remove(journal);
    const auto print_with = [&](PrintControl& control, ProgressSink progress) {
        gpio::MonotonicClock clock;
        gpio::MockChip chip(line_count, clock, {});
        PrintJob job{file, printer, false, std::move(progress)};
        job.control = &control;
        job.journal = journal;
        Result<PrintReport> report = print(job, chip, clock);
        CHECK(chip.released());
        return report;
    };
    PrintControl done, killed, cancelled;
    CHECK(print_with(done, {}).ok());
    CHECK_FALSE(std::filesystem::exists(journal));
    CHECK(done.status().state == PrintState::done);
    CHECK(done.status().layer == 3);
    bool sent = false;
    const Result<PrintReport> stopped = print_with(killed, [&](const Progress& now) {
        if (now.layer >= 2 && !sent) std::raise(SIGTERM), sent = true;
    });
    REQUIRE_FALSE(stopped.ok());
    CHECK(killed.status().state == PrintState::stopped);
    CHECK(killed.status().is_position_known);
    const Result<Resumption> found = find_resumption(printer, file);
    REQUIRE(found.ok());
    CHECK(found->first_layer + 1 >= 2);
    CHECK(found->first_layer + 1 == killed.status().layer);
    const Result<PrintReport> ended = print_with(cancelled, [&](const Progress& now) {
        if (now.layer >= 2) cancelled.post(Cancel{});
    });
    REQUIRE_FALSE(ended.ok());
    CHECK(ended.error().message.find("cancelled") != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(journal));
}

// The lock on /dev/full is one for the machine: emulated tests of two processors would keep it from each other.
TEST_CASE("print 7: a journal that cannot be written is a warning, and the print is made" *
          doctest::test_suite("long")) {
    const config::Printer printer = nearby_printer();
    const std::string file = write_print("no_journal", {draw_small});
    gpio::MonotonicClock clock;
    gpio::MockChip chip(line_count, clock, {});
    PrintJob job{file, printer, false, {}};
    job.journal = "/nonexistent/folder/journal";
    const Result<PrintReport> report = print(job, chip, clock);
    REQUIRE(report.ok());
    REQUIRE_FALSE(report->warnings.empty());
    CHECK(report->warnings[0].severity == Severity::warning);
    CHECK(report->warnings[0].message.find("cannot be resumed") != std::string::npos);
    PrintControl control;
    job.control = &control;
    gpio::MockChip third(line_count, clock, {});
    CHECK(print(job, third, clock).ok());
    CHECK(control.status().message.find("cannot write the journal") != std::string::npos);
    CHECK(control.status().message.find("loss of power") != std::string::npos);
    // By another name: what is not its own to remove.
    const std::string device = file + ".full";
    std::filesystem::remove(device);
    std::filesystem::create_symlink("/dev/full", device);
    job.journal = device;
    gpio::MockChip again(line_count, clock, {});
    CHECK(print(job, again, clock).ok());
    CHECK(control.status().message.find("cannot write the journal") != std::string::npos);
    CHECK(std::filesystem::is_symlink(device));
    std::filesystem::remove(device);
}

TEST_CASE("print 7: a print of the same file took another printer's journal away") {
    const config::Printer printer = nearby_printer();
    const std::string file = write_print("neighbour", {draw_small});
    config::Printer other = printer;
    other.name = "neighbour";
    write_entry(other, file, 4);
    const auto before = read_journal(file + ".journal");
    PrintControl control;
    gpio::MonotonicClock clock;
    gpio::MockChip chip(line_count, clock, {});
    PrintJob job{file, printer, false, {}};
    job.control = &control;
    job.journal = file + ".journal";
    const Result<PrintReport> report = print(job, chip, clock);
    REQUIRE(report.ok());
    REQUIRE_FALSE(report->warnings.empty());
    const std::string& told = report->warnings[0].message;
    CHECK(told.find("another printer (other name)") != std::string::npos);
    CHECK(told.find("cannot be resumed") != std::string::npos);
    CHECK(report->told >= 1);
    CHECK(control.status().message == told);
    const auto after = read_journal(file + ".journal");
    REQUIRE((after.ok() && *after));
    CHECK(*after == *before);
    // Its own goes when it is done.
    write_entry(printer, file, 4);
    gpio::MockChip again(line_count, clock, {});
    CHECK(print(job, again, clock).ok());
    CHECK_FALSE(std::filesystem::exists(file + ".journal"));
}

TEST_CASE("print 7: a journal that nobody can go on from is replaced, and that is told") {
    const config::Printer printer = nearby_printer();
    const std::string file = write_print("replaced", {draw_small});
    const auto told = [&] {
        gpio::MonotonicClock clock;
        gpio::MockChip chip(line_count, clock, {});
        PrintJob job{file, printer, false, {}};
        job.journal = file + ".journal";
        const Result<PrintReport> report = print(job, chip, clock);
        REQUIRE(report.ok());
        CHECK_FALSE(std::filesystem::exists(job.journal));
        return report->warnings.empty() ? std::string() : report->warnings[0].message;
    };
    std::ofstream(file + ".journal") << "LYRJRNL1";
    CHECK(told().find("another version of lyrrun; it is replaced") != std::string::npos);
    std::ofstream(file + ".journal") << std::string(500, 'x');
    CHECK(told().find("no entry is whole; it is replaced") != std::string::npos);
    write_entry(printer, file, 1);
    CHECK(told().find("it is replaced") == std::string::npos);
    write_entry(printer, file, 1);
    write_print("replaced", {[](const Pen& pen) {
                    pen.path();
                    pen.line(1, 0);
                }});
    CHECK(told().find("of another file of this name; it is replaced") != std::string::npos);
}

TEST_CASE("print 6: pauses, in a real print's threads, leave the path as it is") {
    const config::Printer printer = nearby_printer();
    const std::string file = write_print("paused", std::vector<Drawing>(2, draw_small));
    const auto path_of = [&](bool pauses) {
        gpio::MonotonicClock clock;
        std::vector<gpio::LineWrite> writes;
        gpio::MockChip chip(line_count, clock, gpio::recorder(writes));
        PrintControl control;
        int calls = 0;
        PrintJob job{file, printer, false, [&](const Progress&) {
                         ++calls;
                         if (pauses && calls == 1) control.post(Pause{});
                         if (control.status().state == PrintState::paused) control.post(Resume{});
                     }};
        job.control = &control;
        const Result<PrintReport> report = print(job, chip, clock);
        REQUIRE_MESSAGE(report.ok(), (report.ok() ? "" : report.error().message));
        CHECK((report->paused_s > 0.1) == pauses);
        CHECK(control.status().state == PrintState::done);
        StepPositions at{};
        gpio::LineMask before = 0;
        for (const gpio::LineWrite& write : writes) {
            for (std::size_t i = 0; i < at.size(); ++i)
                if (~before & write.levels & step_bit(i))
                    at[i] += (write.levels & direction_bit(i)) != 0 ? 1 : -1;
            before = write.levels;
        }
        return std::pair(at, writes.size());
    };
    const auto [plain_end, plain_writes] = path_of(false);
    const auto [paused_end, paused_writes] = path_of(true);
    CHECK(plain_end == paused_end);
    CHECK(paused_writes > plain_writes + 200);
}
