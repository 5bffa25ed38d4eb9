#include "target/control/dispatcher.h"

#include <doctest/doctest.h>

#include <limits>
#include <nlohmann/json.hpp>

using namespace lyr;
using namespace lyr::control;
using nlohmann::json;
using run::PrintState;

namespace {

struct Scene {
    run::PrintControl print;
    config::Printer printer = config::generic_printer();
    Dispatcher dispatcher{print, printer};

    explicit Scene(PrintState state = PrintState::printing) {
        run::PrintStatus status;
        status.state = state;
        status.file = "part \"1\"\n.lyr";
        status.layer = 3;
        status.layers = 10;
        status.heaters[config::heater_tool] = {true, 209.96, 210};
        status.heaters[config::heater_bed] = {true, std::numeric_limits<double>::quiet_NaN(), 60};
        status.estimated_s = 100;
        print.publish(status);
    }

    json answer(const std::string& line, Subscription* subscription = nullptr) {
        return json::parse(dispatcher.answer(line, subscription));
    }
    std::string code(const std::string& line) {
        const json answered = answer(line);
        return answered["ok"] == true ? "ok" : answered["error"]["code"].get<std::string>();
    }
};

}  // namespace

TEST_CASE("dispatcher: greeting and status are JSON, whatever names hold") {
    Scene scene;
    scene.printer.name = "a\x1b[31m\xff\"\xed\xa0\x80";
    const json greeting = json::parse(scene.dispatcher.greeting());
    CHECK(greeting["greeting"] == "lyrrun");
    CHECK(greeting["protocol"] == protocol_version);
    CHECK(greeting["printer"] == "a\\x1b[31m\\xff\"\\xed\\xa0\\x80");
    const json answered = scene.answer(R"({"id":4,"command":"status"})");
    CHECK(answered["id"] == 4);
    const json& status = answered["status"];
    CHECK(status["state"] == "printing");
    CHECK(status["file"] == "part \"1\"\\n.lyr");
    CHECK(status["layer"] == 3);
    CHECK(status["heaters"]["tool"]["temperature_c"] == 210.0);
    CHECK(status["heaters"]["bed"]["temperature_c"].is_null());
    CHECK_FALSE(status["heaters"].contains("chamber"));
    CHECK(status["estimated_s"] == 100);
    const json event = json::parse(scene.dispatcher.status_event());
    CHECK(event["event"] == "status");
    CHECK(event["status"] == status);
}

TEST_CASE("dispatcher 2: a set of several for which the queue has too little room sets none") {
    Scene scene;
    for (std::size_t i = 1; i < run::PrintControl::most_waiting; ++i)
        REQUIRE(scene.code(R"({"command":"set","fan":0.5})") == "ok");
    CHECK(scene.code(R"({"command":"set","tool_c":215,"bed_c":60})") == "busy");
    std::size_t waiting = 0;
    for (; const auto command = scene.print.take(); ++waiting)
        CHECK(*command == run::Command(run::SetFan{0.5}));
    CHECK(waiting == run::PrintControl::most_waiting - 1);
}

TEST_CASE("dispatcher 1: an accepted command is on its way to the print, in its order") {
    Scene scene;
    CHECK(scene.code(R"({"command":"set","speed":1.5,"tool_c":200})") == "ok");
    CHECK(scene.code(R"({"command":"pause"})") == "ok");
    CHECK(scene.print.take() == run::Command(run::SetTemperature{config::heater_tool, 200}));
    CHECK(scene.print.take() == run::Command(run::SetSpeedFactor{1.5}));
    CHECK(scene.print.take() == run::Command(run::Pause{}));
    CHECK_FALSE(scene.print.take());
    for (std::size_t i = 0; i < run::PrintControl::most_waiting; ++i)
        REQUIRE(scene.code(R"({"command":"set","fan":0.5})") == "ok");
    CHECK(scene.code(R"({"command":"set","fan":0.5})") == "busy");
    for (int i = 0; i < 1000; ++i) REQUIRE(scene.code(R"({"command":"stop"})") == "ok");
    CHECK(scene.print.take() == run::Command(run::EmergencyStop{}));
    CHECK(scene.print.take() == run::Command(run::SetFan{0.5}));
}

TEST_CASE("dispatcher 2: what cannot be done is refused and nothing of it is done") {
    Scene scene;
    CHECK(scene.code(R"({"command":"resume"})") == "wrong_state");
    CHECK(scene.code(R"({"command":"set","fan":1,"chamber_c":50})") == "no_such_heater");
    CHECK(scene.code(R"({"command":"set","fan":1,"tool_c":271})") == "bad_value");
    CHECK(scene.answer(R"({"command":"set","tool_c":271})")["error"]["message"]
              .get<std::string>()
              .find("goes up to 270") != std::string::npos);
    CHECK(scene.code(R"({"command":"subscribe","interval_s":1})") == "unknown_command");
    // Filament would be pushed cold; when the print rests it is not.
    CHECK(scene.code(R"({"command":"set","tool_c":100})") == "wrong_state");
    CHECK_FALSE(scene.print.take());
    CHECK(scene.code(R"({"command":"set","tool_c":270})") == "ok");
    CHECK(Scene(PrintState::paused).code(R"({"command":"set","tool_c":0})") == "ok");
}

TEST_CASE("dispatcher 2: a print without heat switches no fan") {
    Scene scene;
    run::PrintStatus status = scene.print.status();
    for (run::HeaterNow& heater : status.heaters) heater.is_present = false;
    scene.print.publish(status);
    CHECK(scene.code(R"({"command":"set","fan":0.5})") == "bad_value");
    CHECK(scene.code(R"({"command":"set","speed":1.5})") == "ok");
}

TEST_CASE("dispatcher 2: no resume while filament is drawn out") {
    Scene scene(PrintState::pausing);
    run::PrintStatus status = scene.print.status();
    status.draws_out = true;
    scene.print.publish(status);
    CHECK(scene.code(R"({"command":"resume"})") == "wrong_state");
    CHECK(scene.code(R"({"command":"change_filament"})") == "ok");
}

TEST_CASE("dispatcher 2: which command in which state") {
    const std::vector<std::pair<const char*, const char*>> allowed{
        // heating, printing, pausing, paused, resuming, stopping, done, failed, stopped
        {"pause", "yynnynnnn"}, {"resume", "nnyynnnnn"},          {"cancel", "yyyyynnnn"},
        {"stop", "yyyyyyyyy"},  {"change_filament", "yyyyynnnn"}, {"status", "yyyyyyyyy"},
    };
    for (const auto& [command, states] : allowed)
        for (std::size_t i = 0; i < run::print_state_names.size(); ++i) {
            CAPTURE(command);
            CAPTURE(run::print_state_names[i]);
            Scene scene(static_cast<PrintState>(i));
            CHECK(scene.code(std::string(R"({"command":")") + command + "\"}") ==
                  (states[i] == 'y' ? "ok" : "wrong_state"));
        }
}

TEST_CASE("dispatcher: subscribe sets the interval, 0 ends it") {
    Scene scene;
    Subscription subscription;
    CHECK(scene.answer(R"({"command":"subscribe","interval_s":0.5})", &subscription)["ok"] == true);
    CHECK(subscription.interval == std::chrono::milliseconds(500));
    CHECK(scene.answer(R"({"command":"subscribe","interval_s":9999})", &subscription)["ok"] ==
          false);
    CHECK(subscription.interval == std::chrono::milliseconds(500));
    CHECK(scene.answer(R"({"command":"subscribe","interval_s":0})", &subscription)["ok"] == true);
    CHECK_FALSE(subscription.interval);
}
