#include "target/control/request.h"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "target/config/heater.h"

using namespace lyr;
using namespace lyr::control;
using nlohmann::json;

namespace {

Request good(const std::string& line) {
    const auto read = read_request(line);
    if (const auto* refusal = std::get_if<Refusal>(&read)) FAIL(line << ": " << refusal->message);
    return std::get<Request>(read);
}

Commands commands_of(const std::string& line) {
    return std::get<Commands>(good(line).wish);
}

void check_refused(const std::string& line, ErrorCode code, const std::string& part,
                   const std::string& id = "null") {
    CAPTURE(line);
    const auto read = read_request(line);
    const auto* refusal = std::get_if<Refusal>(&read);
    REQUIRE(refusal != nullptr);
    CHECK(name_of(refusal->code) == name_of(code));
    CHECK_MESSAGE(refusal->message.find(part) != std::string::npos, refusal->message);
    CHECK(refusal->id == id);
    // Whatever the line, the answer is one line of JSON that says the same.
    const std::string answer = refusal_line(*refusal);
    CHECK(answer.find('\n') == std::string::npos);
    const json parsed = json::parse(answer, nullptr, false);
    REQUIRE(parsed.is_object());
    CHECK(parsed["ok"] == false);
    CHECK(parsed["error"]["code"] == name_of(code));
    CHECK(parsed["error"]["message"] == refusal->message);
}

}  // namespace

TEST_CASE("request 1: each command is read as what it says") {
    CHECK(std::holds_alternative<GetStatus>(good(R"({"command":"status"})").wish));
    CHECK(
        std::get<Subscribe>(good(R"({"command":"subscribe","interval_s":0.5})").wish).interval_s ==
        0.5);
    CHECK(std::get<Subscribe>(good(R"({"interval_s":0,"command":"subscribe"})").wish).interval_s ==
          0);
    CHECK(commands_of(R"({"command":"pause"})") == Commands{run::Pause{}});
    CHECK(commands_of(R"({"command":"resume"})") == Commands{run::Resume{}});
    CHECK(commands_of(R"({"command":"cancel"})") == Commands{run::Cancel{}});
    CHECK(commands_of(R"({"command":"stop"})") == Commands{run::EmergencyStop{}});
    CHECK(commands_of(R"({"command":"change_filament"})") == Commands{run::ChangeFilament{}});
    CHECK(commands_of(R"({"command":"set","speed":1.2,"bed_c":60,"tool_c":0,"fan":1})") ==
          Commands{run::SetTemperature{config::heater_tool, 0},
                   run::SetTemperature{config::heater_bed, 60}, run::SetFan{1},
                   run::SetSpeedFactor{1.2}});
}

TEST_CASE("request 1: the id comes back as it was given") {
    for (const std::string id : {"0", "-7", "9007199254740993", "18446744073709551615", "\"a\"",
                                 "\"\"", R"("q\"\\\n\u0001é")"}) {
        const Request request = good(R"({"command":"pause","id":)" + id + "}");
        CHECK(json::parse(request.id) == json::parse(id));
        CHECK(json::parse(done_line(request.id)) == json{{"id", json::parse(id)}, {"ok", true}});
    }
    CHECK(good(R"({"command":"pause","id":null})").id == "null");
    CHECK(good(R"({"command":"pause"})").id == "null");
}

TEST_CASE("request 1: every line that is no request has one clear refusal") {
    using enum ErrorCode;
    for (const char* line : {"", " ", "{", "}", "{\"command\":\"pause\"", "pause", "{'command':1}",
                             "{\"command\":\"pause\"}x", "{\"command\":\"pau\xff\"}", "nan",
                             "{\"command\":\"set\",\"fan\":1e999}", "{\"a\":01}", "{\"a\" 1}",
                             "{\"a\":1,}", "{\"command\":\"pause\"}{}", "\"\\ud800\""})
        check_refused(line, bad_json, "no JSON; byte ");
    check_refused(std::string("{\"command\":\"pause\0\"}", 20), bad_json, "no JSON");
    for (const char* line : {"1", "null", "true", "\"pause\"", "[]", "[{\"command\":\"pause\"}]"})
        check_refused(line, bad_request, "no JSON object");
    for (const char* line :
         {"{}", "{\"command\":1}", "{\"command\":null}", "{\"comand\":\"pause\"}"})
        check_refused(line, bad_request, "the member command");
    check_refused(R"({"id":1,"command":"puase"})", unknown_command, "did you mean pause?", "1");
    check_refused(R"({"command":""})", unknown_command, "unknown command");
    check_refused(R"({"command":"pause","at":3,"id":"x"})", bad_request, "no member \"at\"",
                  "\"x\"");
    check_refused(R"({"command":"pause","command":"stop"})", bad_request, "stands twice");
    check_refused(R"({"id":3,"command":"pause","id":3})", bad_request, "stands twice", "3");
    check_refused(R"({"id":5,"command":{"a":1}})", bad_request, "holds an object", "5");
    check_refused(R"({"id":5,"command":[]})", bad_request, "holds a list", "5");
    check_refused(R"({"id":1.5,"command":"pause"})", bad_value, "id must be");
    check_refused(R"({"id":true,"command":"pause"})", bad_value, "id must be");
    check_refused(R"({"command":"pause","id":")" + std::string(63, 'x') + "\"}", bad_value,
                  "up to 62 bytes");
}

TEST_CASE("request 1: values out of their ranges are refused with the range") {
    using enum ErrorCode;
    check_refused(R"({"command":"set"})", bad_request, "set needs one of");
    check_refused(R"({"command":"set","toll_c":200})", bad_request, "no member \"toll_c\"");
    check_refused(R"({"command":"set","tool_c":200,"bde_c":60})", bad_request, "\"bde_c\"");
    check_refused(R"({"command":"set","tool_c":"200"})", bad_value, "tool_c must be a number");
    check_refused(R"({"command":"set","tool_c":-1})", bad_value, "from 0 to 1000");
    check_refused(R"({"command":"set","bed_c":1001})", bad_value, "from 0 to 1000");
    check_refused(R"({"command":"set","fan":1.01})", bad_value, "from 0 to 1");
    check_refused(R"({"command":"set","fan":true})", bad_value, "fan");
    check_refused(R"({"command":"set","speed":0.05})", bad_value, "from 0.1 to 3");
    check_refused(R"({"command":"set","fan":0.5,"speed":4})", bad_value, "speed");
    check_refused(R"({"command":"subscribe"})", bad_request, "interval_s");
    for (const char* value : {"-1", "0.05", "3601", "null", "\"1\""})
        check_refused(R"({"command":"subscribe","interval_s":)" + std::string(value) + "}",
                      bad_value, "from 0.1 to 3600, or 0");
}

TEST_CASE("request 1: any bytes give a request or a refusal") {
    std::mt19937 random(6);
    const std::string whole =
        R"({"id":"a\u00e9","command":"set","tool_c":210.5,"bed_c":60,"fan":0.25,"speed":1e0})";
    std::size_t read_whole = 0;
    for (int round = 0; round < 20'000; ++round) {
        std::string line = round % 4 ? whole : std::string(random() % 40, ' ');
        const std::size_t changes = 1 + random() % 4;
        for (std::size_t i = 0; i < changes && !line.empty(); ++i) {
            const std::size_t at = random() % line.size();
            switch (random() % 3) {
                case 0:
                    line[at] = static_cast<char>(random());
                    break;
                case 1:
                    line.erase(at, random() % 8);
                    break;
                default:
                    line.insert(at, 1, "{}[]\",:0e-\\"[random() % 11]);
            }
        }
        const auto read = read_request(line);
        if (const auto* refusal = std::get_if<Refusal>(&read)) {
            REQUIRE(json::parse(refusal_line(*refusal), nullptr, false).is_object());
            continue;
        }
        ++read_whole;
        const Request& request = std::get<Request>(read);
        REQUIRE(json::accept(request.id));
        if (const auto* commands = std::get_if<Commands>(&request.wish))
            for (const run::Command& command : *commands)
                if (const auto* set = std::get_if<run::SetTemperature>(&command))
                    REQUIRE((set->target_c >= 0 && set->target_c <= 1000));
    }
    // Both kinds occur.
    CHECK(read_whole > 100);
    CHECK(read_whole < 19'000);
}
