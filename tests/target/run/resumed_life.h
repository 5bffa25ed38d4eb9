// A print that goes on after it was cut off, tick by tick, with heaters that nobody tends.

#pragma once

#include <doctest/doctest.h>

#include <filesystem>
#include <thread>

#include "scratch.h"
#include "target/run/life.h"
#include "target/run/print_files.h"

namespace lyr::tests {

using namespace lyr::run;

constexpr double found_mm = 6.5, begin_s = 100'000;

struct Resumed {
    config::Printer printer = config::generic_printer();
    PrintControl control;
    Course course;
    LayerLog layers;
    HeatDesk desk;
    std::string journal;
    std::optional<JournalWriter> writer;
    Life life{printer, control, course, layers, desk, {"p.lyr", 6, 0}};

    explicit Resumed(bool is_lifted, const std::string& name, const JournalEntry& entry = {})
        : journal(lyr::tests::scratch(name + ".journal")) {
        std::filesystem::remove(journal);
        printer.start_mm = {35, 25, is_lifted ? found_mm + 5 : 11.5};
        Result<Journal> opened = Journal::open(journal);
        REQUIRE(opened.ok());
        writer.emplace(std::move(*opened));
        life.begin_with({entry, 2, found_mm, {}, entry.drawn_back_um / 1e3}, is_lifted);
        life.keep_journal(&*writer, {});
    }
    ~Resumed() { std::filesystem::remove(journal); }

    PrintStatus after(double time_s, std::optional<Command> command = {}) {
        if (command) REQUIRE(control.post(*command));
        life.tick(begin_s + time_s);
        return control.status();
    }
    // All heat is there, and the disk has taken what is noted.
    PrintStatus heated(double time_s) {
        desk.take();
        HeatNow now;
        now.reached = true;
        desk.publish(now);
        for (int i = 0; i < 2; ++i) {
            after(time_s);
            while (!writer->is_idle()) std::this_thread::yield();
        }
        return after(time_s);
    }
    // The motion has made it.
    StepPositions end_trip() {
        const Trip* trip = course.trip.load();
        REQUIRE(trip);
        StepPositions steps{};
        gpio::LineMask before = course.levels.load();
        for (const LineEvent& event : *trip) {
            for (std::size_t i = 0; i < steps.size(); ++i)
                if (~before & event.levels & step_bit(i))
                    steps[i] += (event.levels & direction_bit(i)) != 0 ? 1 : -1;
            before = event.levels;
        }
        for (std::size_t i = 0; i < steps.size(); ++i) course.trip_steps[i] += steps[i];
        course.trip.store(nullptr);
        return steps;
    }
    // As a cut of the power would leave it.
    JournalEntry noted() {
        writer.reset();
        const auto entry = read_journal(journal);
        REQUIRE(entry.ok());
        REQUIRE(entry->has_value());
        return **entry;
    }
};

// On its path, and about to be asked for something.
inline void begin_path(Resumed& print) {
    print.printer.heaters = {};
    print.heated(0);
    REQUIRE(print.after(1).state == PrintState::printing);
    print.course.started.store(true);
    print.course.at_rest.store(false);
    print.after(2);
}

inline void pause_path(Resumed& print) {
    print.after(3, Pause{});
    print.course.at_rest.store(true);
    print.after(4);
    print.end_trip();
    REQUIRE(print.after(5).state == PrintState::paused);
}

// At the park place, also with the filament drawn out.
inline void rest(Resumed& print, bool is_changed) {
    begin_path(print);
    pause_path(print);
    if (!is_changed) return;
    print.after(6, ChangeFilament{});
    print.end_trip();
    REQUIRE(print.after(7).state == PrintState::paused);
}

// From there, warm: the next trip is under way.
inline void set_out(Resumed& print) {
    print.after(8, Resume{});
    print.heated(9);
    REQUIRE(print.course.trip.load() != nullptr);
}

}  // namespace lyr::tests
