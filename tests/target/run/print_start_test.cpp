// What goes before the path of a print, and what may happen meanwhile: contract of target/run/print.h, by number.

#include <doctest/doctest.h>

#include <atomic>
#include <csignal>
#include <fstream>
#include <functional>
#include <thread>

#include "scratch.h"
#include "target/gpio/mock_chip.h"
#include "target/gpio/mock_inputs.h"
#include "target/run/cut_off.h"
#include "target/run/inspect.h"
#include "target/run/patient_printer.h"
#include "target/run/print.h"
#include "target/run/print_files.h"

using namespace lyr;
using namespace lyr::run;
using namespace lyr::tests;

namespace {

constexpr std::size_t start_lines = 8;

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
        PrintJob job{file, patient_printer(), true, {}};
        job.checked = [&](const Diagnostics&) {
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
    PrintJob job{file, patient_printer(), true, {}};
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

namespace {

// Homing, as far as its being asked to stop goes: for a second, unless it is.
Status home_for_a_second(const StopSource& stop, unsigned& asked,
                         const std::function<void()>& meanwhile) {
    for (int i = 0; i < 1'000 && asked == 0; ++i) {
        if (i == 100) meanwhile();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        asked += stop();
    }
    if (asked == 0) return Done{};
    return Diagnostic{Severity::error, ExitStatus::stopped, "stopped on request", {}};
}

struct Homed {
    Result<PrintReport> report = PrintReport{};
    unsigned asked = 0;
    PrintStatus meanwhile, end;
    std::size_t writes = 0;
};

// What `disturb` does while it homes.
Homed print_and_disturb(const std::function<void(PrintControl&, gpio::MockInputs&)>& disturb) {
    Homed homed;
    config::Printer printer = patient_printer();
    printer.inputs[config::input_emergency] = config::Pin{"gpiochip0", 20U, false};
    gpio::MonotonicClock clock;
    std::vector<gpio::LineWrite> writes;
    gpio::MockChip chip(start_lines, clock, gpio::recorder(writes));
    auto lines = std::make_unique<gpio::MockInputs>(1, clock);
    gpio::MockInputs& input = *lines;
    Result<Buttons> buttons = Buttons::start(printer, std::move(lines));
    REQUIRE(buttons.ok());
    PrintControl control;
    PrintJob job{write_print("homing", {draw_stroke}), printer, true, {}};
    job.control = &control;
    bool begun = false;
    job.begun = [&] { begun = true; };
    job.before = [&](gpio::GpioChip&, gpio::Clock&, const StopSource& stop, const NoteRisen&) {
        CHECK(begun);
        return home_for_a_second(stop, homed.asked, [&] {
            homed.meanwhile = control.status();
            disturb(control, input);
        });
    };
    homed.report = print(job, chip, clock, nullptr, &*buttons);
    homed.end = control.status();
    homed.writes = writes.size();
    CHECK(chip.levels() == 0);
    return homed;
}

}  // namespace

TEST_CASE("print 6, 9: an emergency was not heard while a print homes") {
    const Homed by_line =
        print_and_disturb([](PrintControl&, gpio::MockInputs& input) { input.set(0, true); });
    const Homed by_command = print_and_disturb(
        [](PrintControl& control, gpio::MockInputs&) { control.post(EmergencyStop{}); });
    for (const Homed* homed : {&by_line, &by_command}) {
        CHECK(homed->asked == 2);
        CHECK(homed->meanwhile.message == "homing before the print");
        CHECK(homed->meanwhile.layers == 1);
        CHECK_FALSE(homed->meanwhile.is_position_known);
        REQUIRE_FALSE(homed->report.ok());
        CHECK(homed->report.error().status == ExitStatus::stopped);
        CHECK(homed->report.error().message.find("emergency stop") != std::string::npos);
        CHECK(homed->end.state == PrintState::stopped);
        CHECK(homed->writes == 1);  // the release
    }
}

TEST_CASE(
    "print 4, 6, 10: a signal and a cancel stop a print that homes, and did not say that its place "
    "is lost") {
    const Homed by_signal =
        print_and_disturb([](PrintControl&, gpio::MockInputs&) { std::raise(SIGTERM); });
    const Homed by_command =
        print_and_disturb([](PrintControl& control, gpio::MockInputs&) { control.post(Cancel{}); });
    for (const Homed* homed : {&by_signal, &by_command}) {
        CHECK(homed->asked == 1);
        REQUIRE_FALSE(homed->report.ok());
        CHECK(homed->report.error().status == ExitStatus::stopped);
        CHECK(homed->report.error().message.find("before the path began") != std::string::npos);
        CHECK(homed->report.error().message.find("position of the head is lost") !=
              std::string::npos);
        CHECK(homed->writes == 1);
    }
    CHECK(by_command.report.error().message.starts_with("cancelled; it was homing"));
}

TEST_CASE("print 6: what else is asked for while a print homes waits for its path") {
    const Homed homed = print_and_disturb(
        [](PrintControl& control, gpio::MockInputs&) { control.post(SetSpeedFactor{2}); });
    CHECK(homed.asked == 0);
    CHECK(homed.report.ok());
    CHECK(homed.end.speed_factor == 2);
}

TEST_CASE("print 2: heaters were not refreshed before the path, and their keeper gave them up") {
    config::Printer printer = patient_printer();
    config::Heater bed = config::default_heater(config::heater_bed);
    bed.sensor.kind = config::SensorKind::celsius;
    bed.sensor.celsius_per_unit = 1;
    printer.heaters[config::heater_bed] = bed;
    std::atomic<int> reads{0};
    std::vector<thermal::HeaterPort> ports;
    ports.push_back({config::heater_bed, bed, std::make_unique<thermal::MockSensor>([&] {
                         ++reads;
                         return Result<double>(25.0);
                     })});
    Heating heating;
    std::vector<thermal::Output> outputs;
    outputs.push_back({thermal::LineOutput{0, thermal::SlowPwm(1)}, true});
    heating.stage = std::make_unique<thermal::PowerStage>(std::move(outputs), nullptr);
    heating.control =
        std::make_unique<thermal::HeatControl>(std::move(ports), false, *heating.stage);
    gpio::MonotonicClock clock;
    gpio::MockChip chip(start_lines, clock, {});
    PrintJob job{write_print("refreshed", {draw_stroke}), printer, false, {}};
    int before = 0;
    job.before = [&](gpio::GpioChip&, gpio::Clock&, const StopSource& stop, const NoteRisen&) {
        unsigned asked = 0;
        const Status homed = home_for_a_second(stop, asked, [] {});
        before = reads;
        return homed;
    };
    CHECK(print(job, chip, clock, &heating).ok());
    CHECK(before >= 5);
}

TEST_CASE("print: what the print warns of was said after it, and not at all if it was stopped") {
    gpio::MonotonicClock clock;
    gpio::MockChip chip(start_lines, clock, {});
    PrintJob job{write_print("warned", {draw_stroke}), patient_printer(), true, {}};
    job.journal = "/nonexistent/journal";
    Diagnostics told;
    job.checked = [&](const Diagnostics& notes) {
        told = notes;
        CHECK(chip.levels() == 0);
    };
    const Result<PrintReport> report = print(job, chip, clock);
    REQUIRE(report.ok());
    REQUIRE_FALSE(told.empty());
    CHECK(told[0].message.find("cannot be resumed") != std::string::npos);
    CHECK(report->told == told.size());
    CHECK(report->warnings.size() == told.size());
}

TEST_CASE("print 7: a print that is refused leaves no journal, and the one before as it was") {
    PrintJob job{write_print("not_begun", {draw_stroke}), patient_printer(), true, {}};
    job.journal = job.file + ".journal";
    std::filesystem::remove(job.journal);
    // Its lines are not there.
    CHECK_FALSE(print(job).ok());
    CHECK_FALSE(std::filesystem::exists(job.journal));
    write_journal(job.printer, job.file, resting_at(7.4));
    CHECK_FALSE(print(job).ok());
    CHECK(find_resumption(job.printer, job.file).ok());
    std::filesystem::remove(job.journal);
}

TEST_CASE(
    "print 7: a print begun anew that ended while it homed left the height at which the one before "
    "had rested") {
    gpio::MonotonicClock clock;
    gpio::MockChip chip(start_lines, clock, {});
    PrintJob job{write_print("anew", {draw_stroke}), patient_printer(), true, {}};
    job.journal = job.file + ".journal";
    bool has_begun = false;
    job.before = [&](gpio::GpioChip&, gpio::Clock&, const StopSource&, const NoteRisen&) -> Status {
        has_begun = true;
        // As a kill or a loss of power leaves it.
        CHECK_FALSE(find_resumption(job.printer, job.file).ok());
        return Diagnostic{Severity::error, ExitStatus::machine, "no endstop", {}};
    };
    write_journal(job.printer, job.file, resting_at(7.4));
    CHECK_FALSE(print(job, chip, clock).ok());
    CHECK(has_begun);
    CHECK_FALSE(std::filesystem::exists(job.journal));
}

TEST_CASE(
    "print 7: a print left the height at which that of another file had rested on its printer") {
    config::Printer printer = patient_printer();
    const std::filesystem::path folder = lyr::tests::scratch_folder("others");
    printer.recovery_folder = folder;
    const std::string rested = write_print("rested", {draw_stroke});
    const std::string elsewhere = write_print("elsewhere", {draw_stroke});
    config::Printer neighbour = printer;
    neighbour.name = "neighbour";
    write_journal(printer, rested, resting_at(7.4));
    write_journal(neighbour, elsewhere, resting_at(7.4));
    PrintJob job{write_print("other", {draw_stroke}), printer, true, {}};
    job.journal = journal_path(printer, job.file);
    job.forgets_others = true;
    const std::string journal = journal_path(printer, rested);
    gpio::MonotonicClock clock;
    bool has_begun = false;
    job.before = [&](gpio::GpioChip&, gpio::Clock&, const StopSource&, const NoteRisen&) -> Status {
        CHECK_FALSE(std::filesystem::exists(journal));
        has_begun = true;
        return Done{};
    };
    {
        // One that is being printed, or whose keeper lives on.
        const Result<Journal> held = Journal::open(journal);
        gpio::MockChip chip(start_lines, clock, {});
        const Result<PrintReport> refused = print(job, chip, clock);
        REQUIRE_FALSE(refused.ok());
        CHECK(refused.error().message.find("nothing has moved") != std::string::npos);
        CHECK_FALSE(has_begun);
        CHECK(find_resumption(printer, rested).ok());
    }
    gpio::MockChip chip(start_lines, clock, {});
    const Result<PrintReport> report = print(job, chip, clock);
    REQUIRE(report.ok());
    CHECK(has_begun);
    REQUIRE_FALSE(report->warnings.empty());
    CHECK(report->warnings[0].where.file == journal);
    CHECK(report->warnings[0].message.find("cannot be resumed") != std::string::npos);
    CHECK(find_resumption(neighbour, elsewhere).ok());
    std::filesystem::remove_all(folder);
}

TEST_CASE("inspect 2: a path too slow for the format began to print, and ended in a riddle") {
    const std::string file = write_print("still", {draw_stroke, [](const Pen& pen) {
                                                       pen.path(0.0001);
                                                       pen.travel(0, 0);
                                                       pen.line(4, 0);
                                                   }});
    const Result<Inspection> refused = inspect(file, patient_printer());
    REQUIRE_FALSE(refused.ok());
    CHECK(refused.error().status == ExitStatus::input);
    CHECK(refused.error().where.layer == 2);
    CHECK(refused.error().message.find("steps of 0.01 mm/s") != std::string::npos);
}

TEST_CASE(
    "print 7: a resumption that ended while it homed forgot how high it had lifted the head") {
    const std::string file = write_print("homing_again", {draw_stroke});
    gpio::MonotonicClock clock;
    for (const bool is_cancelled : {false, true}) {
        CAPTURE(is_cancelled);
        gpio::MockChip chip(start_lines, clock, {});
        const config::Printer printer = patient_printer();
        PrintControl control;
        PrintJob job{file, printer, true, {}};
        job.control = &control;
        job.journal = file + ".journal";
        JournalEntry entry;
        entry.file = *identity_of(file);
        entry.printer = identity_of(printer);
        entry.layer = entry.layers = 1;
        {
            Result<Journal> journal = Journal::open(job.journal);
            REQUIRE(journal.ok());
            REQUIRE(journal->write(entry).ok());
        }
        Resumption resumption;
        resumption.entry = entry;
        resumption.stopped_z_mm = 7;
        job.resumption = resumption;
        job.is_lifted = true;
        job.before = [&](gpio::GpioChip&, gpio::Clock&, const StopSource&,
                         const NoteRisen&) -> Before {
            if (is_cancelled) control.post(Cancel{});
            return {Diagnostic{Severity::error, ExitStatus::machine, "no endstop", {}}, 3.25};
        };
        CHECK_FALSE(print(job, chip, clock).ok());
        const auto kept = read_journal(job.journal);
        REQUIRE(kept.ok());
        CHECK(kept->has_value() != is_cancelled);
        if (*kept) CHECK((*kept)->rest_nm == 10'250'000);
    }
}

TEST_CASE("demands: a file that pauses was printed where no command could reach the print") {
    const std::string file = write_print("unreachable", {[](const Pen& pen) {
                                             draw_stroke(pen);
                                             pen.layer.pause(format::PauseReason::user);
                                             pen.line(3, 0);
                                         }});
    gpio::MonotonicClock clock;
    gpio::MockChip chip(start_lines, clock, {});
    PrintControl control;
    PrintJob job{file, patient_printer(), true, {}};
    job.control = &control;
    job.is_reachable = false;
    const Result<PrintReport> report = print(job, chip, clock);
    REQUIRE_FALSE(report.ok());
    CHECK(report.error().status == ExitStatus::unsupported);
    CHECK(report.error().message.find("nobody could tell it to go on") != std::string::npos);
}
