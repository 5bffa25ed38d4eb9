// What life.h (1, 2, 4, 5) says of pauses that the file asks for, and of ways that cannot be planned: tick by tick, and in
// simulations.

#include <doctest/doctest.h>

#include "target/run/patient_printer.h"
#include "target/run/resumed_life.h"
#include "target/run/simulate.h"

using namespace lyr;
using namespace lyr::run;
using namespace lyr::tests;

namespace {

// What the attendant tells as long as the path waits in a pause of its own.
HeatNow waiting(bool is_warm = true) {
    HeatNow now;
    now.reached = is_warm;
    now.pause = format::PauseReason::user;
    return now;
}

// The desk's wishes are carried out, and the disk has taken what is noted.
PrintStatus settled(Resumed& print, double time_s, bool is_warm = true) {
    PrintStatus status;
    for (int i = 0; i < 3; ++i) {
        print.desk.take();
        print.desk.publish(waiting(is_warm));
        status = print.after(time_s);
        while (!print.writer->is_idle()) std::this_thread::yield();
    }
    return status;
}

void rest_for_file(Resumed& print) {
    begin_path(print);
    print.desk.publish(waiting());
    REQUIRE(print.after(3).state == PrintState::pausing);
    print.course.at_rest.store(true);
    print.after(4);
    print.end_trip();
    REQUIRE(print.after(5).state == PrintState::paused);
}

// Back on the path, which may go on.
void check_left(Resumed& print, double time_s) {
    print.end_trip();
    CHECK(print.after(time_s).state == PrintState::printing);
    CHECK(print.desk.take().pause_is_over);
}

Diagnostic ending(const std::function<void(SimulationJob&)>& change, PrintStatus& status) {
    const auto pausing = [](const Pen& pen) {
        draw_square(pen);
        pen.layer.pause(format::PauseReason::user);
        draw_square(pen);
    };
    PrintControl control;
    SimulationJob job{write_print("file_pause", {pausing}), parking_printer(), {}, {}, {}};
    job.no_heat = true;
    job.control = &control;
    change(job);
    const Result<SimulationReport> report = simulate(job);
    REQUIRE_FALSE(report.ok());
    status = control.status();
    return report.error();
}

}  // namespace

TEST_CASE("life 2: a pause of the file that heat did not let leave within an hour is left later") {
    Resumed print(true, "file_hour");
    rest_for_file(print);
    print.after(6, Resume{});
    settled(print, 7, false);
    const PrintStatus rests = settled(print, 8 + longest_wait_s, false);
    CHECK(rests.state == PrintState::paused);
    CHECK(rests.message.find("within an hour") != std::string::npos);
    CHECK(print.course.trip.load() == nullptr);
    CHECK_FALSE(print.desk.take().pause_is_over);
    print.after(9 + longest_wait_s, Resume{});
    settled(print, 10 + longest_wait_s);
    check_left(print, 11 + longest_wait_s);
}

TEST_CASE("life 1: a pause on the way back from one of the file does not let the path go on") {
    Resumed print(true, "file_again");
    rest_for_file(print);
    print.after(6, Resume{});
    settled(print, 7);
    print.after(8, Pause{});
    print.end_trip();
    CHECK(print.after(9).state == PrintState::pausing);
    CHECK_FALSE(print.desk.take().pause_is_over);
    print.end_trip();
    print.after(10);
    print.after(11, Resume{});
    settled(print, 12);
    check_left(print, 13);
}

TEST_CASE(
    "life 1: a user's pause after one of the file leaves the next one of the file to be left") {
    Resumed print(true, "file_then_user");
    rest_for_file(print);
    print.after(6, Resume{});
    settled(print, 7);
    check_left(print, 8);
    print.course.at_rest.store(false);
    print.desk.publish({});
    print.after(9, Pause{});
    print.course.at_rest.store(true);
    print.after(10);
    print.end_trip();
    print.after(11, Resume{});
    print.heated(12);
    print.end_trip();
    CHECK(print.after(13).state == PrintState::printing);
    CHECK_FALSE(print.desk.take().pause_is_over);
}

TEST_CASE("life 4: a cancel in a pause of the file takes heat away, and the path does not go on") {
    Resumed print(true, "file_cancel");
    rest_for_file(print);
    print.after(6, Cancel{});
    CHECK(print.life.ended_by() == "cancelled; the head is parked");
    CHECK(print.control.stop_requests() == 1);
    CHECK(print.course.trip.load() == nullptr);
    const HeatWish wish = print.desk.take();
    CHECK(wish.standby[config::heater_tool]);
    CHECK_FALSE(wish.pause_is_over);
}

TEST_CASE("life 4: who gives up in a pause of the file has the head at its park place") {
    for (const bool is_signal : {false, true}) {
        PrintStatus end;
        const Diagnostic why = ending(
            [&](SimulationJob& job) {
                if (is_signal)
                    job.line_faults.signals_s = {60};
                else
                    job.script = {{60, Cancel{}}};
            },
            end);
        CHECK(why.status == ExitStatus::stopped);
        CHECK(why.message.find(is_signal ? "stopped on request" : "cancelled") !=
              std::string::npos);
        CHECK(end.is_position_known);
        CHECK(end.position_mm[0] == doctest::Approx(5).epsilon(0.01));
        CHECK(end.position_mm[1] == doctest::Approx(120).epsilon(0.01));
    }
}

TEST_CASE("life 5: a head that cannot be parked rests where it is, and nothing is pushed for it") {
    Resumed print(true, "no_way_out");
    begin_path(print);
    print.printer.pause.speed_mm_s = 0;
    print.after(3, Pause{});
    print.course.at_rest.store(true);
    const PrintStatus parks = print.after(4);
    CHECK(parks.message.find("the head stays where it is") != std::string::npos);
    CHECK(print.course.trip.load() == nullptr);
    const PrintStatus rests = print.after(5);
    CHECK(rests.state == PrintState::paused);
    print.printer.pause.speed_mm_s = 100;
    print.after(6, Resume{});
    print.heated(7);
    CHECK(print.end_trip() == StepPositions{});
    CHECK(print.after(8).state == PrintState::printing);
}

TEST_CASE("life 5: a way back that cannot be made leaves the print at rest until it can") {
    Resumed print(true, "no_way_back");
    rest(print, false);
    print.printer.pause.speed_mm_s = 0;
    print.after(8, Resume{});
    const PrintStatus rests = print.heated(9);
    CHECK(rests.state == PrintState::paused);
    CHECK(rests.message.find("the head stays where it is") != std::string::npos);
    print.printer.pause.speed_mm_s = 100;
    print.after(10, Resume{});
    print.heated(11);
    CHECK(print.end_trip()[config::axis_z] < 0);
    CHECK(print.after(12).state == PrintState::printing);
}

TEST_CASE("life 5: a resumption whose lift cannot be made rests until it can") {
    Resumed print(false, "no_lift");
    print.printer.pause.speed_mm_s = 0;
    CHECK(print.heated(1).state == PrintState::paused);
    CHECK(print.course.trip.load() == nullptr);
    print.printer.pause.speed_mm_s = 100;
    print.after(2, Resume{});
    print.heated(3);
    CHECK(print.end_trip()[config::axis_z] > 0);
}

TEST_CASE("life 5: filament that cannot be moved is neither out nor in by that") {
    Resumed print(true, "no_filament_way");
    rest(print, false);
    const double mm_s = std::exchange(print.printer.filament.speed_mm_s, 0);
    CHECK(print.after(6, ChangeFilament{}).state == PrintState::paused);
    CHECK(print.course.trip.load() == nullptr);
    print.printer.filament.speed_mm_s = mm_s;
    print.after(7, ChangeFilament{});
    CHECK(print.end_trip()[config::axis_e] < 0);
    print.after(8);
    print.printer.filament.speed_mm_s = 0;
    print.after(9, Resume{});
    CHECK(print.heated(10).state == PrintState::paused);
    CHECK(print.course.trip.load() == nullptr);
    print.printer.filament.speed_mm_s = mm_s;
    print.after(11, Resume{});
    print.heated(12);
    CHECK(print.end_trip()[config::axis_e] > 0);
}
