// What life.h (2, 7, 8) says of a print that goes on after it was cut off, until its path begins: tick by tick, with
// heaters that nobody tends.

#include <doctest/doctest.h>

#include <filesystem>

#include "target/run/life.h"
#include "target/run/print_files.h"

using namespace lyr;
using namespace lyr::run;
using namespace lyr::tests;

namespace {

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

    explicit Resumed(bool is_lifted, const std::string& name)
        : journal(std::filesystem::temp_directory_path() / ("lyr_" + name + ".journal")) {
        std::filesystem::remove(journal);
        printer.start_mm = {35, 25, is_lifted ? found_mm + 5 : 11.5};
        Result<Journal> opened = Journal::open(journal);
        REQUIRE(opened.ok());
        writer.emplace(std::move(*opened));
        life.begin_with({{}, 2, found_mm, {}}, is_lifted);
        life.keep_journal(&*writer, {});
    }
    ~Resumed() { std::filesystem::remove(journal); }

    PrintStatus after(double time_s, std::optional<Command> command = {}) {
        if (command) REQUIRE(control.post(*command));
        life.tick(begin_s + time_s);
        return control.status();
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

}  // namespace

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
    print.after(0);
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
