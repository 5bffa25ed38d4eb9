// What life.h (2, 7, 8) says of a print that goes on after it was cut off, until its path begins: tick by tick, with
// heaters that nobody tends.

#include "target/run/resumed_life.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <thread>

using namespace lyr;
using namespace lyr::run;
using namespace lyr::tests;

TEST_CASE("life 7: a resumption that ended before its path began forgot the height at rest") {
    for (const bool is_lifted : {false, true})
        for (const int ticks : {0, 1, 5}) {
            CAPTURE(is_lifted);
            CAPTURE(ticks);
            Resumed print(is_lifted, "forgot_height");
            for (int i = 0; i < ticks; ++i) print.after(i);
            print.life.note_rest();
            const JournalEntry entry = print.noted();
            CHECK(entry.layer == 3);
            REQUIRE(entry.rest_nm);
            CHECK(*entry.rest_nm == (is_lifted ? 11'500'000 : 6'500'000));
        }
}

TEST_CASE("life 7: a pause while a resumed print heated noted a height of 0") {
    Resumed print(false, "paused_at_0");
    print.after(0);
    CHECK(print.after(1, Pause{}).state == PrintState::paused);
    CHECK(print.after(2).state == PrintState::paused);
    CHECK(print.noted().rest_nm == 6'500'000);
}

TEST_CASE("life 7: once a resumed print is on its path, no height at rest is noted") {
    Resumed print(true, "on_its_path");
    print.heated(0);
    print.course.started.store(true);
    print.after(1);
    CHECK(!print.noted().rest_nm);
}

TEST_CASE("life 2: a resume waited for its heaters without end, and kept them on") {
    Resumed print(false, "without_end");
    CHECK(print.after(0).state == PrintState::resuming);
    CHECK(print.after(longest_wait_s - 1).state == PrintState::resuming);
    const auto all_off = [&] {
        const HeatWish wish = print.desk.take();
        return wish.standby[0] && wish.standby[1] && wish.standby[2];
    };
    CHECK(!all_off());
    const PrintStatus status = print.after(longest_wait_s + 1);
    CHECK(status.state == PrintState::paused);
    CHECK(status.message.find("within an hour") != std::string::npos);
    CHECK(all_off());
    print.after(longest_wait_s + 2);
    CHECK(all_off());
    // And once more, for an hour of its own.
    CHECK(print.after(2 * longest_wait_s, Resume{}).state == PrintState::resuming);
    CHECK(!all_off());
    CHECK(print.after(3 * longest_wait_s - 1).state == PrintState::resuming);
    CHECK(print.after(3 * longest_wait_s + 1).state == PrintState::paused);
}

TEST_CASE("life 5: filament was unloaded before the path began, and never loaded") {
    Resumed print(false, "never_loaded");
    print.after(0);
    const PrintStatus status = print.after(1, ChangeFilament{});
    CHECK(status.state == PrintState::paused);
    CHECK(status.message.find("once the path has begun") != std::string::npos);
    CHECK(print.course.trip.load() == nullptr);
}

TEST_CASE("life 8: filament that was drawn out is put in before the path, the head lifted") {
    for (const bool is_lifted : {false, true}) {
        CAPTURE(is_lifted);
        JournalEntry entry;
        entry.is_unloaded = true;
        Resumed print(is_lifted, "unloaded", entry);
        print.after(0);
        print.heated(1);
        if (!is_lifted) CHECK(print.end_trip()[config::axis_z] == 2'000);
        const PrintStatus rests = is_lifted ? print.after(2) : print.heated(2);
        CHECK(rests.state == PrintState::paused);
        CHECK(rests.message.find("put it in") != std::string::npos);
        CHECK(rests.position_mm[2] == doctest::Approx(11.5));
        CHECK(print.course.wanted_pace.load() == 0);
        // Again and again, and in a pause of its own, it stays so.
        CHECK(print.after(3, Pause{}).state == PrintState::paused);
        CHECK(print.after(4, Resume{}).state == PrintState::resuming);
        CHECK(print.heated(5).state == PrintState::resuming);
        const StepPositions loaded = print.end_trip();
        CHECK(loaded[config::axis_z] == 0);
        CHECK(static_cast<double>(loaded[config::axis_e]) /
                  print.printer.axes[config::axis_e].steps_per_mm ==
              doctest::Approx(110).epsilon(1e-3));
        print.heated(6);
        CHECK(print.after(7).state == PrintState::printing);
        CHECK(print.course.wanted_pace.load() == 1);
        CHECK_FALSE(print.noted().is_unloaded);
    }
}

TEST_CASE("life 7: until filament is in again the journal says that it is out, and how high") {
    for (const int ticks : {0, 1, 2, 3}) {
        CAPTURE(ticks);
        JournalEntry entry;
        entry.is_unloaded = true;
        Resumed print(false, "still_out", entry);
        if (ticks > 0) print.heated(1);  // lifts
        if (ticks > 1) print.end_trip(), print.after(2);
        if (ticks > 2) print.after(3, Resume{}), print.heated(4);  // loads
        if (ticks != 1) print.after(5);
        const JournalEntry noted = print.noted();
        CHECK(noted.is_unloaded);
        // A lift that is under way is not known.
        if (ticks != 1) CHECK(noted.rest_nm == (ticks > 1 ? 11'500'000 : 6'500'000));
    }
}

TEST_CASE("life 7: a pause notes how far the filament is drawn back, by the path and by itself") {
    Resumed print(true, "drawn_back");
    print.printer.heaters = {};
    print.heated(0);
    CHECK(print.after(1).state == PrintState::printing);
    const LayerBegin begin{0, 4, 1, 0.75f};
    print.layers.begin(std::span(&begin, 1), 0);
    print.course.started.store(true);
    print.after(2);
    print.after(3, Pause{});
    print.course.at_rest.store(true);
    CHECK(print.after(4).state == PrintState::pausing);
    print.end_trip();
    CHECK(print.after(5).state == PrintState::paused);
    print.after(6);
    const JournalEntry parked = print.noted();
    CHECK(parked.layer == 4);
    CHECK(parked.drawn_back_um == 2'750);
    CHECK(parked.rest_nm == 16'500'000);
    CHECK_FALSE(parked.is_unloaded);
}

TEST_CASE("life 7: while filament is changed at the park place the height there is noted") {
    for (const int turns : {0, 1, 2, 3, 4}) {
        CAPTURE(turns);
        Resumed print(true, "changed");
        begin_path(print);
        pause_path(print);
        print.after(6, ChangeFilament{});  // draws it out
        if (turns > 0) print.end_trip(), print.after(7);
        if (turns > 1) print.after(8, Resume{}), print.heated(9);  // pushes the next one in
        if (turns > 2) {
            CHECK(print.end_trip()[config::axis_z] == 0);
            print.heated(10);  // goes back
        }
        if (turns > 3) {
            CHECK(print.end_trip()[config::axis_z] < 0);
            print.after(11);
        }
        print.after(12);
        const JournalEntry noted = print.noted();
        CHECK(noted.is_unloaded == (turns < 3));
        CHECK(noted.rest_nm.has_value() == (turns < 3));
        if (noted.rest_nm) CHECK(*noted.rest_nm == 16'500'000);
    }
}

TEST_CASE("life 7: power lost between a resume and the way back forgot the height at rest") {
    for (const bool is_settled : {false, true}) {
        CAPTURE(is_settled);
        Resumed print(true, "between");
        begin_path(print);
        pause_path(print);
        print.after(6, Resume{});
        if (is_settled) print.heated(7);
        CHECK((print.course.trip.load() != nullptr) == is_settled);
        const JournalEntry noted = print.noted();
        // Noted for too long it would be taken for the height of a head that is lower already.
        CHECK(noted.rest_nm == (is_settled ? std::nullopt : std::optional(16'500'000)));
    }
}

TEST_CASE("life 7: the head waits where it rests until the disk has it that it leaves") {
    for (int i = 0; i < 50; ++i) {
        Resumed print(true, "slow_disk");
        begin_path(print);
        pause_path(print);
        print.after(6, Resume{});
        HeatNow now;
        now.reached = true;
        print.desk.take();
        print.desk.publish(now);
        int ticks = 0;
        for (; !print.course.trip.load(); ++ticks)
            REQUIRE(print.after(7 + 1e-3 * ticks).state == PrintState::resuming);
        CHECK(ticks > 1);
        const auto written = read_journal(print.journal);
        REQUIRE((written.ok() && *written));
        CHECK(!(*written)->rest_nm);
    }
}

TEST_CASE(
    "life 1: a pause and a change while filament is pushed in take their turn where it rests") {
    for (const Command& command :
         {Command(Pause{}), Command(ChangeFilament{}), Command(Cancel{})}) {
        CAPTURE(command.index());
        Resumed print(true, "pushed_in");
        rest(print, true);
        set_out(print);
        print.after(10, command);
        CHECK(print.end_trip()[config::axis_z] == 0);
        const PrintStatus now = print.after(11);
        const bool changes = std::holds_alternative<ChangeFilament>(command);
        const bool cancels = std::holds_alternative<Cancel>(command);
        CHECK((print.course.trip.load() != nullptr) == changes);
        CHECK(now.state == (cancels   ? PrintState::stopping
                            : changes ? PrintState::pausing
                                      : PrintState::paused));
        CHECK(print.life.is_cancelled() == cancels);
        if (!cancels) CHECK(print.noted().is_unloaded == changes);
    }
}

TEST_CASE("life 7: a print said that it rests, and noted how high a tick later") {
    Resumed print(true, "tick_later");
    begin_path(print);
    pause_path(print);
    CHECK(print.noted().rest_nm == 16'500'000);
}

TEST_CASE("life 1: a pause right after a resume took the motion for still at rest") {
    Resumed print(true, "still_at_rest");
    begin_path(print);
    pause_path(print);
    print.after(6, Resume{});
    print.heated(7);
    print.end_trip();
    REQUIRE(print.after(8).state == PrintState::printing);
    CHECK(print.after(8.02, Pause{}).state == PrintState::pausing);
    // The motion has not seen that it may go on: it must, first.
    CHECK(print.course.trip.load() == nullptr);
    CHECK(print.course.wanted_pace.load() > 0);
    print.course.at_rest.store(false);
    print.after(8.04);
    CHECK(print.course.trip.load() == nullptr);
    CHECK(print.course.wanted_pace.load() == 0);
    print.course.at_rest.store(true);
    print.after(8.06);
    CHECK(print.course.trip.load() != nullptr);
}

TEST_CASE("life 3: a pause of a path of which no more came kept all heat on for ever") {
    Resumed print(true, "no_more_comes");
    begin_path(print);
    print.after(3, Pause{});
    const double tool_off_s = print.printer.pause.tool_off_s;
    print.after(tool_off_s);
    CHECK_FALSE(print.desk.take().standby[config::heater_tool]);
    print.after(4 + tool_off_s);
    CHECK(print.desk.take().standby[config::heater_tool]);
    CHECK_FALSE(print.desk.take().standby[config::heater_bed]);
    print.after(4 + print.printer.pause.bed_off_s);
    CHECK(print.desk.take().standby[config::heater_bed]);
}

TEST_CASE("life 7: the path draws back now and then, which a cut on its way is not to believe") {
    Resumed print(true, "on_path");
    print.heated(0);
    print.after(1);
    const LayerBegin begin{0, 4, 1, 0.75f};
    print.layers.begin(std::span(&begin, 1), 0);
    print.course.started.store(true);
    print.after(2);
    CHECK(print.noted().drawn_back_um == 0);
}

TEST_CASE("life 7: how far into the print it was cut off counted since the last resumption") {
    JournalEntry entry;
    entry.time_ns = 5'000'000'000;
    Resumed print(true, "time", entry);
    print.heated(0);
    CHECK(print.after(1).time_s == doctest::Approx(5));
    const LayerBegin begin{0, 4, 1, 0};
    print.layers.begin(std::span(&begin, 1), 0);
    print.course.started.store(true);
    print.course.time_ns.store(3'000'000'000);
    CHECK(print.after(2).time_s == doctest::Approx(8));
    CHECK(print.noted().time_ns == 8'000'000'000);
}

TEST_CASE("life 8: a resumed print reported a pause as long as the board had been on") {
    Resumed print(true, "long_pause");
    print.heated(0);
    print.heated(7);
    CHECK(print.after(8).state == PrintState::printing);
    CHECK(print.life.paused_s() < 10);
}
