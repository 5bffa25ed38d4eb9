#include "target/control/server.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>

#include "target/control/scene.h"

using namespace lyr;
using namespace lyr::control;
using namespace lyr::tests;
using nlohmann::json;
using namespace std::chrono_literals;

namespace {

struct ServedPrint {
    std::string path;
    run::PrintControl print;
    config::Printer printer = config::generic_printer();
    Dispatcher dispatcher{print, printer};
    std::optional<Server> server;

    explicit ServedPrint(const std::string& name) : path(socket_path(name)) {
        run::PrintStatus status;
        status.state = run::PrintState::printing;
        print.publish(status);
        auto listener = Listener::open(path);
        REQUIRE(listener.ok());
        server.emplace(std::move(*listener), dispatcher);
    }
};

std::string code_of(const std::string& line) {
    const json answer = json::parse(line, nullptr, false);
    if (!answer.is_object()) return line;
    return answer["ok"] == true ? "ok" : answer["error"]["code"].get<std::string>();
}

constexpr const char* status_line = "{\"command\":\"status\"}\n";

}  // namespace

TEST_CASE("server: greets, answers in order, and goes on after what is wrong") {
    ServedPrint scene("answers");
    Connection client(scene.path);
    CHECK(json::parse(client.line())["protocol"] == protocol_version);
    client.send("{\"id\":1,\"command\":\"status\"}\nrubbish\n" + std::string(10'000, 'x') +
                "\n{\"id\":2,\"comm");
    CHECK(json::parse(client.line())["id"] == 1);
    CHECK(code_of(client.line()) == "bad_json");
    CHECK(code_of(client.line()) == "line_too_long");
    client.send("and\":\"pause\"}\n");
    CHECK(json::parse(client.line()) == json{{"id", 2}, {"ok", true}});
    CHECK(scene.print.take() == run::Command(run::Pause{}));
}

TEST_CASE("server 3: who has only stopped sending gets all answers, then the end") {
    ServedPrint scene("half");
    Connection client(scene.path);
    std::string lines;
    for (int i = 0; i < 500; ++i) lines += status_line;
    client.send(lines);
    client.end_sending();
    (void)client.line();
    for (int i = 0; i < 500; ++i) REQUIRE(code_of(client.line()) == "ok");
    CHECK(client.line() == "(end)");
}

TEST_CASE(
    "server 2: sixteen silent clients kept an emergency stop out; the longest silent one gives "
    "way") {
    ServedPrint scene("many");
    std::vector<std::unique_ptr<Connection>> clients;
    for (std::size_t i = 0; i < Server::most_clients; ++i) {
        clients.push_back(std::make_unique<Connection>(scene.path));
        REQUIRE(json::parse(clients.back()->line()).contains("greeting"));
    }
    // The first has a subscription, the second has spoken: the third has been silent for longest.
    clients[0]->send("{\"id\":1,\"command\":\"subscribe\",\"interval_s\":10}\n");
    CHECK(code_of(clients[0]->line()) == "ok");
    clients[1]->send(status_line);
    CHECK(code_of(clients[1]->line()) == "ok");
    for (const std::size_t silent : {2, 3}) {
        clients.push_back(std::make_unique<Connection>(scene.path));
        Connection& more = *clients.back();
        REQUIRE(json::parse(more.line()).contains("greeting"));
        CHECK(code_of(clients[silent]->line()) == "too_many_clients");
        CHECK(clients[silent]->line() == "(end)");
        more.send("{\"id\":1,\"command\":\"stop\"}\n");
        CHECK(code_of(more.line()) == "ok");
        CHECK(scene.print.stop_requests().load() >= 2);
    }
    clients[15]->send(status_line);
    CHECK(code_of(clients[15]->line()) == "ok");
}

TEST_CASE("server 1: a client that sends and never reads keeps nobody waiting") {
    ServedPrint scene("deaf");
    Connection deaf(scene.path), other(scene.path);
    (void)other.line();
    // More than all buffers on the way hold; what does not fit is not sent.
    std::string flood;
    for (int i = 0; i < 50'000; ++i) flood += status_line;
    std::size_t sent = 0;
    for (;;) {
        const ssize_t count =
            ::send(deaf.socket(), flood.data() + sent, flood.size() - sent, MSG_DONTWAIT);
        if (count <= 0) {
            pollfd room{deaf.socket(), POLLOUT, 0};
            if (::poll(&room, 1, 100) <= 0) break;
            continue;
        }
        sent += static_cast<std::size_t>(count);
        REQUIRE(sent < flood.size());
    }
    for (int i = 0; i < 100; ++i) {
        const auto begun = std::chrono::steady_clock::now();
        other.send(status_line);
        REQUIRE(code_of(other.line()) == "ok");
        CHECK(std::chrono::steady_clock::now() - begun < 1s);
    }
}

TEST_CASE("server 4: a subscriber is told in its interval, and once more at the end") {
    ServedPrint scene("subscribed");
    Connection client(scene.path);
    (void)client.line();
    client.send("{\"command\":\"subscribe\",\"interval_s\":0.1}\n");
    CHECK(code_of(client.line()) == "ok");
    const auto begun = std::chrono::steady_clock::now();
    for (int i = 0; i < 5; ++i) {
        const json event = json::parse(client.line());
        CHECK(event["event"] == "status");
        CHECK(event["status"]["state"] == "printing");
    }
    CHECK(std::chrono::steady_clock::now() - begun > 350ms);
    run::PrintStatus over;
    over.state = run::PrintState::done;
    scene.print.publish(over);
    scene.server.reset();
    std::string line, last;
    while ((line = client.line()) != "(end)") last = line;
    CHECK(json::parse(last)["status"]["state"] == "done");
    CHECK_FALSE(std::filesystem::exists(scene.path));
}

TEST_CASE("server 1: random bytes from several clients, and the next one is served") {
    ServedPrint scene("noise");
    std::mt19937 random(3);
    for (int round = 0; round < 60; ++round) {
        Connection client(scene.path);
        std::string noise;
        for (std::size_t i = 0; i < random() % 20'000; ++i)
            noise += static_cast<char>(random() % 40 ? random() : '\n');
        client.send(noise);
        if (round % 3 == 0) (void)client.line();
    }
    Connection client(scene.path);
    CHECK(json::parse(client.line()).contains("greeting"));
    client.send(status_line);
    CHECK(code_of(client.line()) == "ok");
    CHECK_FALSE(scene.print.take());
}
