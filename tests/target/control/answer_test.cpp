#include "target/control/answer.h"

#include <doctest/doctest.h>

#include <random>

#include "target/control/dispatcher.h"
#include "target/control/link.h"
#include "target/control/scene.h"
#include "target/control/server.h"

using namespace lyr;
using namespace lyr::control;
using namespace lyr::tests;

namespace {

run::PrintStatus status_in(const std::string& line) {
    const auto answer = read_answer(line);
    REQUIRE(answer);
    REQUIRE(std::holds_alternative<Told>(*answer));
    return std::get<Told>(*answer).status;
}

}  // namespace

TEST_CASE("answer 2: a status is read back as it was") {
    const config::Printer printer = config::generic_printer();
    for (std::size_t i = 0; i < run::print_state_names.size(); ++i) {
        run::PrintStatus status;
        status.state = static_cast<run::PrintState>(i);
        status.message = "a \"message\" \\ with ü";
        status.file = "/a/b.lyr";
        status.layer = 7;
        status.layers = 900;
        status.position_mm = {1.25, -3, 0.2};
        status.is_position_known = i % 2 == 0;
        status.time_s = 12.34;
        status.elapsed_s = 99.5;
        status.estimated_s = i % 3 ? 1000 : 0;
        status.heaters[config::heater_bed] = {true, 59.9, 60};
        status.fan = 0.5;
        status.speed_factor = 1.2;
        status.filament_mm = 123.4;
        run::PrintControl print;
        print.publish(status);
        const Dispatcher dispatcher(print, printer);
        const run::PrintStatus read = status_in(dispatcher.status_event());
        CHECK(read.state == status.state);
        CHECK(read.message == status.message);
        CHECK(read.file == status.file);
        CHECK(read.layer == status.layer);
        CHECK(read.layers == status.layers);
        CHECK(read.is_position_known == status.is_position_known);
        if (read.is_position_known) CHECK(read.position_mm == status.position_mm);
        CHECK(read.time_s == status.time_s);
        CHECK(read.elapsed_s == status.elapsed_s);
        CHECK(read.estimated_s == status.estimated_s);
        CHECK(read.heaters[config::heater_bed].temperature_c == 59.9);
        CHECK(read.heaters[config::heater_bed].target_c == 60);
        CHECK_FALSE(read.heaters[config::heater_tool].is_present);
        CHECK(read.fan == status.fan);
        CHECK(read.speed_factor == status.speed_factor);
        CHECK(read.filament_mm == status.filament_mm);
    }
}

TEST_CASE("answer 1: any bytes give an answer or none") {
    run::PrintControl print;
    const config::Printer printer = config::generic_printer();
    const std::string whole = Dispatcher(print, printer).status_event();
    std::mt19937 random(8);
    for (int round = 0; round < 3000; ++round) {
        std::string line = whole;
        for (int i = 0; i < 3; ++i)
            line[random() % line.size()] = "{}[]\",:0e-\\\xff"[random() % 12];
        const auto answer = read_answer(line);
        if (answer && std::holds_alternative<Told>(*answer))
            REQUIRE_FALSE(text_of(std::get<Told>(*answer)).empty());
    }
    for (const char* line : {"", "1", "[]", "{}", "{\"ok\":false}", "{\"status\":1}", "null"})
        CHECK_FALSE(read_answer(line));
}

TEST_CASE("link 2: lyrrun that is still checking a large file is said to be, and so if many ask") {
    const std::string path = socket_path("large");
    const auto listener = Listener::open(path);
    REQUIRE(listener.ok());
    const auto is_told = [](const Result<Link>& link) {
        return !link.ok() && link.error().message.find("a large file") != std::string::npos;
    };
    CHECK(is_told(Link::open(path)));
    std::vector<Link> waiting;
    for (bool full = false; !full;) {
        Result<Link> link = Link::reach(path);
        full = !link.ok();
        if (full)
            CHECK(is_told(link));
        else
            waiting.push_back(std::move(*link));
        REQUIRE(waiting.size() < 100);
    }
}

TEST_CASE("link 1: asks and is answered; what is no server of this protocol is told") {
    const std::string path = socket_path("link");
    run::PrintControl print;
    const config::Printer printer = config::generic_printer();
    Dispatcher dispatcher(print, printer);
    CHECK(Link::open(path).error().message.find("no printer is at work") != std::string::npos);
    {
        auto listener = Listener::open(path);
        REQUIRE(listener.ok());
        const Server server(std::move(*listener), dispatcher);
        Result<Link> link = Link::open(path);
        REQUIRE(link.ok());
        CHECK(link->greeting().printer == printer.name);
        REQUIRE(link->send(R"({"command":"resume"})").ok());
        const auto refused = link->next();
        REQUIRE(refused.ok());
        CHECK(std::get<Refused>(*refused).code == "wrong_state");
    }
    for (const std::string said :
         {"HTTP/1.1 200 OK\n", "{\"greeting\":\"lyrrun\",\"protocol\":99}\n", ""}) {
        auto listener = Listener::open(path);
        REQUIRE(listener.ok());
        std::thread other([&] {
            pollfd waiting{listener->descriptor(), POLLIN, 0};
            ::poll(&waiting, 1, 10'000);
            const int socket = listener->accept();
            (void)!::write(socket, said.data(), said.size());
            ::close(socket);
        });
        const Result<Link> link = Link::open(path);
        other.join();
        REQUIRE_FALSE(link.ok());
        CHECK(link.error().status == ExitStatus::machine);
    }
}
