// What life.h (1, 2, 4, 7) says of what comes between a rest and the path: tick by tick.

#include <doctest/doctest.h>

#include "target/run/resumed_life.h"

using namespace lyr;
using namespace lyr::run;
using namespace lyr::tests;

namespace {

// All heat is there, and the tool is this warm.
PrintStatus heated_to(Resumed& print, double time_s, double tool_c) {
    PrintStatus status;
    for (int i = 0; i < 3; ++i) {
        print.desk.take();
        HeatNow now;
        now.reached = true;
        now.heaters[config::heater_tool] = {true, tool_c, tool_c};
        print.desk.publish(now);
        status = print.after(time_s);
        while (!print.writer->is_idle()) std::this_thread::yield();
    }
    return status;
}

bool is_cold(Resumed& print) {
    const HeatWish wish = print.desk.take();
    return wish.standby[config::heater_tool] && wish.standby[config::heater_bed];
}

}  // namespace

TEST_CASE("life 4: a cancel while filament was pushed in let the tool go cold and pushed on") {
    Resumed print(true, "cancel_loading");
    rest(print, true);
    set_out(print);
    CHECK(print.after(10, Cancel{}).state == PrintState::stopping);
    CHECK_FALSE(is_cold(print));
    // No way back to the part.
    CHECK(print.end_trip()[config::axis_z] == 0);
    print.after(11);
    CHECK(print.course.trip.load() == nullptr);
    CHECK(is_cold(print));
    CHECK(print.life.is_cancelled());
    CHECK(print.life.ended_by() == "cancelled; the head is parked");
}

TEST_CASE("life 4: a cancel on the way back lets the heaters go once the filament is pushed") {
    Resumed print(true, "cancel_returning");
    begin_path(print);
    pause_path(print);
    print.after(6, Resume{});
    print.heated(7);
    REQUIRE(print.course.trip.load() != nullptr);
    CHECK(print.after(8, Cancel{}).state == PrintState::stopping);
    CHECK_FALSE(is_cold(print));
    CHECK(print.end_trip()[config::axis_z] < 0);
    CHECK(print.after(9).state == PrintState::stopping);
    CHECK(is_cold(print));
    CHECK(print.end_trip()[config::axis_z] > 0);
    print.after(10);
    CHECK(print.life.ended_by() == "cancelled; the head is parked");
}

TEST_CASE("life 4: a cancel that a signal cut short said that the head is parked") {
    Resumed print(true, "cancel_cut");
    begin_path(print);
    print.after(3, Cancel{});
    print.course.at_rest.store(true);
    print.after(4);
    REQUIRE(print.course.trip.load() != nullptr);
    // What is cut short is not taken off.
    ++print.control.stop_requests();
    CHECK(print.after(5).state == PrintState::stopping);
    CHECK_FALSE(print.life.ended_by());
    CHECK(print.life.is_cancelled());
}

TEST_CASE("life 2: filament was pushed with a tool that the file had let go cold") {
    for (const bool is_changed : {false, true}) {
        CAPTURE(is_changed);
        Resumed print(true, "cold_load");
        rest(print, is_changed);
        print.printer.heaters[config::heater_tool] =
            config::generic_printer().heaters[config::heater_tool];
        print.after(8, Resume{});
        const PrintStatus cold = heated_to(print, 9, 90);
        CHECK(cold.state == PrintState::paused);
        CHECK(cold.message.find("too cold to push filament") != std::string::npos);
        CHECK(print.course.trip.load() == nullptr);
        print.after(10, SetTemperature{config::heater_tool, 210});
        print.after(11, Resume{});
        CHECK(heated_to(print, 12, 210).state == PrintState::resuming);
        CHECK(print.course.trip.load() != nullptr);
    }
}

TEST_CASE(
    "life 1: a pause that the file asks for was skipped when a user's pause came just before") {
    Resumed print(true, "swallowed");
    begin_path(print);
    print.after(3, Pause{});
    HeatNow waits;
    waits.reached = true;
    waits.pause = format::PauseReason::filament_change;
    print.desk.publish(waits);
    print.course.at_rest.store(true);
    print.after(4);
    print.end_trip();
    print.after(5);
    print.after(6, Resume{});
    const auto settle = [&](double time_s) {
        PrintStatus status;
        for (int i = 0; i < 3; ++i) {
            print.desk.take();
            print.desk.publish(waits);
            status = print.after(time_s);
            while (!print.writer->is_idle()) std::this_thread::yield();
        }
        return status;
    };
    settle(7);
    print.end_trip();
    CHECK(print.after(8).state == PrintState::printing);
    CHECK_FALSE(print.desk.take().pause_is_over);
    print.course.at_rest.store(false);
    const PrintStatus asked = print.after(9);
    CHECK(asked.state == PrintState::pausing);
    CHECK(asked.message.find("another filament") != std::string::npos);
    print.course.at_rest.store(true);
    print.after(10);
    print.end_trip();
    print.after(11);  // draws it out
    print.end_trip();
    print.after(12);
    print.after(13, Resume{});
    settle(14);  // pushes the next one in
    print.end_trip();
    settle(15);  // goes back
    print.end_trip();
    CHECK(print.after(16).state == PrintState::printing);
    CHECK(print.desk.take().pause_is_over);
}

TEST_CASE("life: a print was resumed while its sensor said that there is no filament") {
    Resumed print(true, "no_filament");
    bool is_there = false;
    print.life.lacks_filament = [&] { return !is_there; };
    rest(print, true);
    const PrintStatus refused = print.after(8, Resume{});
    CHECK(refused.state == PrintState::paused);
    CHECK(refused.message.find("there is none") != std::string::npos);
    is_there = true;
    CHECK(print.after(9, Resume{}).state == PrintState::resuming);
}

TEST_CASE("life 7: a resumption that was stopped while it lifted took the layer for its height") {
    Resumed print(false, "stopped_lifting");
    print.heated(1);
    REQUIRE(print.course.trip.load() != nullptr);
    // Cut off here, it is as low as it was found.
    while (!print.writer->is_idle()) std::this_thread::yield();
    const auto cut = read_journal(print.journal);
    REQUIRE((cut.ok() && *cut));
    CHECK((*cut)->rest_nm == 6'500'000);
    // Stopped here, it is half a millimetre higher.
    print.course.trip_steps[config::axis_z] += 200;
    CHECK(print.after(1).position_mm[2] == doctest::Approx(7));
    print.course.trip.store(nullptr);
    print.life.note_rest();
    CHECK(print.noted().rest_nm == 7'000'000);
}

TEST_CASE("life 7: a resumption that was stopped once it was lifted knows how high") {
    Resumed print(false, "stopped_lifted");
    print.heated(1);
    print.end_trip();
    print.after(2);
    print.life.note_rest();
    CHECK(print.noted().rest_nm == 11'500'000);
}

TEST_CASE("life 3: a temperature that was set in a long pause had no effect") {
    Resumed print(true, "set_in_pause");
    begin_path(print);
    pause_path(print);
    print.printer.heaters[config::heater_tool] =
        config::generic_printer().heaters[config::heater_tool];
    const double tool_off_s = print.printer.pause.tool_off_s;
    const double long_s = 10 + print.printer.pause.bed_off_s;
    print.after(long_s);
    REQUIRE(is_cold(print));
    print.after(long_s + 1, SetTemperature{config::heater_tool, 210});
    const HeatWish wish = print.desk.take();
    CHECK(wish.targets_c[config::heater_tool] == 210);
    CHECK_FALSE(wish.standby[config::heater_tool]);
    CHECK(wish.standby[config::heater_bed]);
    print.after(long_s + 2 + tool_off_s);
    CHECK(is_cold(print));
}

TEST_CASE("life 7: a stop while filament was pushed in said in the journal that it is there") {
    for (const bool is_changed : {false, true}) {
        CAPTURE(is_changed);
        Resumed print(true, "stopped_pushing");
        rest(print, is_changed);
        set_out(print);
        // A signal, half a millimetre on.
        const double steps_per_mm = print.printer.axes[config::axis_e].steps_per_mm;
        print.course.trip_steps[config::axis_e] += std::llround(0.5 * steps_per_mm);
        ++print.control.stop_requests();
        print.after(10);
        print.life.note_rest();
        const JournalEntry noted = print.noted();
        CHECK(noted.is_unloaded == is_changed);
        CHECK(noted.rest_nm == 16'500'000);
        if (!is_changed) CHECK(noted.drawn_back_um == 1'500);
    }
}

TEST_CASE("life 1: a pause took a change of filament back that was under way") {
    for (const bool is_parking : {false, true}) {
        CAPTURE(is_parking);
        Resumed print(true, "taken_back");
        begin_path(print);
        print.after(3, ChangeFilament{});
        if (!is_parking) print.after(4, Pause{});
        print.course.at_rest.store(true);
        print.after(5);
        if (is_parking) print.after(6, Pause{});
        print.end_trip();
        CHECK(print.after(7).state == PrintState::pausing);
        CHECK(print.end_trip()[config::axis_e] < 0);
        print.after(8);
        CHECK(print.noted().is_unloaded);
    }
}

TEST_CASE("life 1: a pause on the way back from a change of filament draws nothing out") {
    Resumed print(true, "not_again");
    rest(print, true);
    set_out(print);
    print.end_trip();
    print.heated(10);
    print.after(11, Pause{});
    print.end_trip();
    print.after(12);
    print.end_trip();
    CHECK(print.after(13).state == PrintState::paused);
    CHECK(print.course.trip.load() == nullptr);
    CHECK_FALSE(print.noted().is_unloaded);
}

TEST_CASE("life 7: a stop on the way to the park place asked for filament that was still in") {
    for (const bool draws_out : {false, true}) {
        CAPTURE(draws_out);
        Resumed print(true, "stopped_parking");
        begin_path(print);
        print.after(3, ChangeFilament{});
        print.course.at_rest.store(true);
        print.after(4);
        if (draws_out) {
            print.end_trip();
            print.after(5);
        }
        REQUIRE(print.course.trip.load() != nullptr);
        // A millimetre of filament on.
        print.course.trip_steps[config::axis_e] -=
            std::llround(print.printer.axes[config::axis_e].steps_per_mm);
        ++print.control.stop_requests();
        print.after(6);
        print.life.note_rest();
        const JournalEntry noted = print.noted();
        CHECK(noted.is_unloaded == draws_out);
        CHECK(noted.rest_nm == (draws_out ? 16'500'000 : 11'500'000));
        if (!draws_out) CHECK(noted.drawn_back_um == 1'000);
    }
}

TEST_CASE("life 7: an emergency stop in a rest threw the height away that the journal knew") {
    for (const bool is_on_path : {false, true}) {
        CAPTURE(is_on_path);
        Resumed print(true, "emergency");
        begin_path(print);
        if (!is_on_path) pause_path(print);
        print.after(6, EmergencyStop{});
        // Homing would spoil that height.
        CHECK((print.life.ended_by()->find("--resume") == std::string::npos) == is_on_path);
        const JournalEntry noted = print.noted();
        CHECK(noted.rest_nm == (is_on_path ? std::nullopt : std::optional(16'500'000)));
        if (!is_on_path) CHECK(noted.drawn_back_um == 2'000);
    }
}

TEST_CASE("life 2: filament was drawn out and pushed in while the tool that was off cooled down") {
    const auto tell = [](Resumed& print, double tool_c, double target_c) {
        HeatNow now;
        now.reached = true;
        now.heaters[config::heater_tool] = {true, tool_c, target_c};
        print.desk.take();
        print.desk.publish(now);
    };
    Resumed print(true, "cooling");
    begin_path(print);
    pause_path(print);
    print.printer.heaters[config::heater_tool] =
        config::generic_printer().heaters[config::heater_tool];
    tell(print, 205, 0);
    const PrintStatus cold = print.after(6, ChangeFilament{});
    CHECK(cold.message.find("too cold to move filament") != std::string::npos);
    CHECK(print.course.trip.load() == nullptr);
    tell(print, 205, 210);
    print.after(7, ChangeFilament{});
    print.end_trip();
    print.after(8);
    print.after(9, Resume{});
    tell(print, 205, 0);
    const PrintStatus still = print.after(10);
    CHECK(still.message.find("too cold to push filament") != std::string::npos);
    CHECK(print.course.trip.load() == nullptr);
    print.after(11, Resume{});
    tell(print, 205, 210);
    print.after(12);
    CHECK(print.end_trip()[config::axis_e] > 0);
}
