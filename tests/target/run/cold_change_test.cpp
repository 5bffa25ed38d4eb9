// What life.h (2, 3, 7) says of a tool that is off or goes off in a pause, and of a disk that takes no journal: tick by
// tick.

#include <doctest/doctest.h>

#include "target/run/full_disk.h"
#include "target/run/resumed_life.h"

using namespace lyr;
using namespace lyr::run;
using namespace lyr::tests;

namespace {

// The heaters' thread has carried out what was asked, and tells this of the tool.
void tell_tool(Resumed& print, double tool_c, double target_c) {
    HeatNow now;
    now.reached = true;
    now.heaters[config::heater_tool] = {true, tool_c, target_c};
    print.desk.take();
    print.desk.publish(now);
}

void give_tool(Resumed& print) {
    print.printer.heaters[config::heater_tool] =
        config::generic_printer().heaters[config::heater_tool];
}

}  // namespace

TEST_CASE(
    "life 7: a print left its rest, and a journal that could not be written said it is there") {
    for (const bool is_mended : {false, true}) {
        CAPTURE(is_mended);
        Resumed print(true, "full_disk");
        rest(print, false);
        {
            const FullDisk full;
            print.after(8, Resume{});
            const PrintStatus rests = print.heated(9);
            CHECK(rests.state == PrintState::paused);
            CHECK(rests.message.find("resume once more") != std::string::npos);
            CHECK(print.course.trip.load() == nullptr);
            CHECK(print.after(10).state == PrintState::paused);
            if (!is_mended) {
                print.after(11, Resume{});
                print.heated(12);
                CHECK(print.course.trip.load() != nullptr);
            }
        }
        if (!is_mended) continue;
        set_out(print);
        while (!print.writer->is_idle()) std::this_thread::yield();
        CHECK_FALSE((*read_journal(print.journal))->rest_nm);
        // The next rest asks again: it was passed over in silence once.
        print.end_trip();
        REQUIRE(print.after(13).state == PrintState::printing);
        print.course.at_rest.store(false);
        print.after(14);
        print.after(15, Pause{});
        print.course.at_rest.store(true);
        print.after(16);
        print.end_trip();
        REQUIRE(print.after(17).state == PrintState::paused);
        while (!print.writer->is_idle()) std::this_thread::yield();
        const FullDisk again;
        print.after(18, Resume{});
        CHECK(print.heated(19).state == PrintState::paused);
        CHECK(print.course.trip.load() == nullptr);
        // And an emergency stop there promises no height that is not on the disk.
        print.after(20, EmergencyStop{});
        CHECK(print.life.ended_by()->find("--resume") == std::string::npos);
    }
}

TEST_CASE("life 2: filament was drawn out by a tool that had just been switched off") {
    Resumed print(true, "just_off");
    begin_path(print);
    pause_path(print);
    give_tool(print);
    int refusals = 0;
    print.life.hear_of_refusal = [&](const std::string&) { ++refusals; };
    tell_tool(print, 205, 210);
    REQUIRE(print.control.post(SetTemperature{config::heater_tool, 0}));
    print.after(6, ChangeFilament{});
    CHECK(print.course.trip.load() == nullptr);
    CHECK(refusals == 0);
    tell_tool(print, 205, 0);
    CHECK(print.after(7).message.find("too cold to move filament") != std::string::npos);
    CHECK(print.course.trip.load() == nullptr);
    CHECK(refusals == 1);
    // And the other way round: one that has just been switched on is no reason to refuse.
    REQUIRE(print.control.post(SetTemperature{config::heater_tool, 210}));
    print.after(8, ChangeFilament{});
    CHECK(refusals == 1);
    tell_tool(print, 205, 210);
    print.after(9);
    CHECK(print.end_trip()[config::axis_e] < 0);
}

TEST_CASE("life 2: a resume takes a change of filament back that has not begun") {
    Resumed print(true, "taken_back_early");
    begin_path(print);
    pause_path(print);
    give_tool(print);
    REQUIRE(print.control.post(SetTemperature{config::heater_tool, 210}));
    REQUIRE(print.control.post(ChangeFilament{}));
    CHECK(print.after(6, Resume{}).state == PrintState::resuming);
    tell_tool(print, 205, 210);
    print.after(7);
    CHECK(print.course.trip.load() == nullptr);
}

TEST_CASE("life 3: where a pause lets the tool go cold at once, filament could not be changed") {
    Resumed print(true, "off_at_once");
    begin_path(print);
    give_tool(print);
    print.printer.pause.tool_off_s = 0;
    tell_tool(print, 205, 210);
    print.after(3, ChangeFilament{});
    CHECK_FALSE(print.desk.take().standby[config::heater_tool]);
    print.course.at_rest.store(true);
    tell_tool(print, 205, 210);
    print.after(4);
    print.end_trip();
    print.after(5);
    CHECK(print.end_trip()[config::axis_e] < 0);
    // It is out: the tool may go cold now.
    print.after(6);
    print.after(7);
    CHECK(print.desk.take().standby[config::heater_tool]);
    // What is set by hand stays for long enough to change filament by hand.
    print.after(10, SetTemperature{config::heater_tool, 210});
    CHECK_FALSE(print.desk.take().standby[config::heater_tool]);
    print.after(10 + Life::least_held_s - 1);
    CHECK_FALSE(print.desk.take().standby[config::heater_tool]);
    print.after(10 + Life::least_held_s + 1);
    CHECK(print.desk.take().standby[config::heater_tool]);
}

TEST_CASE("life 3: a change of filament that never came to rest kept the tool hot for ever") {
    Resumed print(true, "never_at_rest");
    begin_path(print);
    give_tool(print);
    tell_tool(print, 205, 210);
    print.after(3, ChangeFilament{});
    print.after(3 + print.printer.pause.tool_off_s - 1);
    CHECK_FALSE(print.desk.take().standby[config::heater_tool]);
    print.after(3 + print.printer.pause.tool_off_s + 1);
    CHECK(print.desk.take().standby[config::heater_tool]);
}

TEST_CASE("life 3: what was set for a change of filament was forgotten when it was drawn out") {
    Resumed print(true, "set_for_change");
    begin_path(print);
    give_tool(print);
    print.printer.pause.tool_off_s = 0;
    pause_path(print);
    print.after(10, SetTemperature{config::heater_tool, 210});
    tell_tool(print, 205, 210);
    print.after(60, ChangeFilament{});
    print.end_trip();
    print.after(70);
    print.after(71);
    CHECK_FALSE(print.desk.take().standby[config::heater_tool]);
    print.after(10 + Life::least_held_s + 1);
    CHECK(print.desk.take().standby[config::heater_tool]);
}

TEST_CASE("life 7: an emergency stop in the lift promised the height from before it") {
    Resumed print(false, "stopped_in_lift");
    print.heated(1);
    REQUIRE(print.course.trip.load() != nullptr);
    print.after(2, EmergencyStop{});
    CHECK(print.life.ended_by()->find("--resume") == std::string::npos);
}
