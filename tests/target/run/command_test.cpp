// Contracts of target/run/command.h and print_control.h, by number.

#include "target/run/command.h"

#include <doctest/doctest.h>

#include <thread>

#include "target/run/print_control.h"

using namespace lyr;
using namespace lyr::run;

namespace {

std::vector<std::string> words_of(const std::string& text) {
    std::vector<std::string> words;
    for (std::size_t from = 0; from < text.size();) {
        const std::size_t to = std::min(text.find(' ', from), text.size());
        words.push_back(text.substr(from, to - from));
        from = to + 1;
    }
    return words;
}

}  // namespace

TEST_CASE("command 1, 2: each command reads back as itself") {
    const std::vector<Command> commands{Pause{},
                                        Resume{},
                                        ChangeFilament{},
                                        Cancel{},
                                        EmergencyStop{},
                                        SetTemperature{config::heater_tool, 215.5},
                                        SetTemperature{config::heater_chamber, 0},
                                        SetFan{0.35},
                                        SetSpeedFactor{0.1},
                                        SetSpeedFactor{3}};
    for (const Command& command : commands) {
        const ParsedCommand parsed = parse_command(words_of(text_of(command)));
        REQUIRE(std::holds_alternative<Command>(parsed));
        CHECK(std::get<Command>(parsed) == command);
    }
}

TEST_CASE("command 1: what makes no sense comes back as a complaint") {
    const auto complaint = [](const std::string& text) {
        const ParsedCommand parsed = parse_command(words_of(text));
        const auto* found = std::get_if<std::string>(&parsed);
        return found ? *found : std::string();
    };
    CHECK(complaint("") == "expected a command");
    CHECK(complaint("pasue") == "unknown command \"pasue\"; did you mean `pause`?");
    CHECK(complaint("pause now") == "`pause` takes nothing");
    CHECK(complaint("set tool") == "`set` takes a heater and a temperature");
    CHECK(complaint("set nose 20").find("tool, bed or chamber") != std::string::npos);
    CHECK(complaint("set tool hot").find("from 0 to 1000") != std::string::npos);
    CHECK(complaint("set tool -1").find("from 0 to 1000") != std::string::npos);
    CHECK(complaint("set tool nan").find("from 0 to 1000") != std::string::npos);
    CHECK(complaint("fan 1.1").find("from 0 to 1") != std::string::npos);
    CHECK(complaint("speed 0.09").find("from 0.1 to 3") != std::string::npos);
    CHECK(complaint("speed 3.1").find("from 0.1 to 3") != std::string::npos);
}

TEST_CASE("command 3: a script is read in the order of time, and complains with its line") {
    const auto script = parse_script("# a print\n 90 resume\n60.5 pause # for lunch\n\n", "s.txt");
    REQUIRE(script.ok());
    REQUIRE(script->size() == 2);
    CHECK((*script)[0].time_s == 60.5);
    CHECK((*script)[0].command == Command(Pause{}));
    CHECK((*script)[1].command == Command(Resume{}));
    const auto line_of = [](const char* text) {
        const auto wrong = parse_script(text, "s.txt");
        REQUIRE_FALSE(wrong.ok());
        CHECK(wrong.error().status == ExitStatus::input);
        CHECK(wrong.error().where.file == "s.txt");
        return wrong.error().where.line;
    };
    CHECK(line_of("1 pause\n-1 resume") == 2);
    CHECK(line_of("pause") == 1);
    CHECK(line_of("\n\n1") == 3);
    CHECK(line_of("1 pause\n2 jump") == 2);
}

TEST_CASE("print control 1, 3: commands come out once and in order, between two threads") {
    PrintControl control;
    constexpr int count = 20'000;
    std::thread user([&] {
        for (int i = 0; i < count;)
            if (control.post(SetTemperature{0, static_cast<double>(i)}))
                ++i;
            else
                std::this_thread::yield();
    });
    int expected = 0, wrong = 0;
    while (expected < count) {
        const std::optional<Command> command = control.take();
        if (command) wrong += std::get<SetTemperature>(*command).target_c != expected++;
        PrintStatus status;
        status.time_s = expected;
        status.message = std::to_string(expected);
        control.publish(std::move(status));
        const PrintStatus now = control.status();
        wrong += now.message != std::to_string(static_cast<int>(now.time_s));
    }
    user.join();
    CHECK(wrong == 0);
    CHECK_FALSE(control.take());
}

TEST_CASE("print control 1, 2: a full queue takes an emergency stop only, and that comes first") {
    PrintControl control;
    for (std::size_t i = 0; i < PrintControl::most_waiting; ++i) CHECK(control.post(Pause{}));
    CHECK_FALSE(control.post(Resume{}));
    CHECK(control.stop_requests() == 0);
    CHECK(control.post(EmergencyStop{}));
    CHECK(control.stop_requests() >= 2);
    CHECK(*control.take() == Command(EmergencyStop{}));
    CHECK(*control.take() == Command(Pause{}));
}
