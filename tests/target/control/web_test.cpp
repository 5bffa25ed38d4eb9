// The page's server, asked by hand-written requests.

#include <arpa/inet.h>
#include <doctest/doctest.h>
#include <netinet/in.h>
#include <sys/stat.h>
#include <zlib.h>

#include <atomic>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "target/control/scene.h"
#include "target/control/server.h"
#include "target/control/session.h"
#include "target/control/web/history.h"
#include "target/control/web/token.h"
#include "target/control/web/web_page.h"

using namespace lyr;
using namespace lyr::control;
using namespace lyr::tests;
using nlohmann::json;

namespace {

constexpr const char* token = "0123456789abcdef";

struct Answered {
    int status = 0;  // 0: no answer
    std::string headers, body;
};

class Browser {
public:
    Browser(std::uint16_t port, bool six = false, std::uint32_t address = INADDR_LOOPBACK)
        : socket_(::socket(six ? AF_INET6 : AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_in four{};
        four.sin_family = AF_INET;
        four.sin_port = htons(port);
        four.sin_addr.s_addr = htonl(address);
        sockaddr_in6 long_one{};
        long_one.sin6_family = AF_INET6;
        long_one.sin6_port = htons(port);
        long_one.sin6_addr = in6addr_loopback;
        const auto* to = six ? reinterpret_cast<const sockaddr*>(&long_one)
                             : reinterpret_cast<const sockaddr*>(&four);
        connected = ::connect(socket_, to, six ? sizeof long_one : sizeof four) == 0;
    }
    ~Browser() { ::close(socket_); }
    Browser(const Browser&) = delete;
    Browser& operator=(const Browser&) = delete;

    void send(const std::string& bytes) const {
        (void)!::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    }
    Answered answer() const {
        std::string all;
        std::size_t length = std::string::npos;
        while (all.size() < length) {
            pollfd waiting{socket_, POLLIN, 0};
            char bytes[4096];
            if (::poll(&waiting, 1, 10'000) <= 0) return {};
            const ssize_t count = ::recv(socket_, bytes, sizeof bytes, 0);
            if (count <= 0) break;
            all.append(bytes, static_cast<std::size_t>(count));
            const std::size_t end = all.find("\r\n\r\n");
            const std::size_t at = all.find("Content-Length: ");
            if (end != std::string::npos && at < end)
                length = end + 4 + std::stoul(all.substr(at + 16));
        }
        const std::size_t end = all.find("\r\n\r\n");
        if (end == std::string::npos || all.size() < 12) return {};
        return {std::stoi(all.substr(9, 3)), all.substr(0, end), all.substr(end + 4)};
    }

    bool connected = false;

private:
    int socket_;
};

struct Scene {
    std::string file = socket_path("web") + ".lyr";
    run::PrintControl print;
    config::Printer printer = config::generic_printer();
    Dispatcher dispatcher{print, printer};
    std::optional<Server> server;
    Relay relay{socket_path("web")};
    std::optional<WebPage> page;
    std::uint16_t port = 0;
    std::atomic<bool> over{false};
    std::thread serving;

    Scene() {
        std::ofstream(file, std::ios::binary) << std::string("LYR\x1a\0\1", 6);
        run::PrintStatus status;
        status.state = run::PrintState::printing;
        status.file = file;
        status.heaters[config::heater_tool] = {true, 200, 210};
        print.publish(status);
        serve_print();
        Result<WebPage> opened = WebPage::open({0, token}, relay);
        REQUIRE(opened.ok());
        page.emplace(std::move(*opened));
        port = static_cast<std::uint16_t>(std::stoi(page->address().substr(17)));
        serving = std::thread([this] {
            while (!over) page->serve(std::chrono::milliseconds(20));
        });
        REQUIRE(becomes([this] { return !status_now()["status"].is_null(); }));
    }
    ~Scene() {
        over = true;
        serving.join();
    }
    void serve_print() {
        auto listener = Listener::open(socket_path("web"));
        REQUIRE(listener.ok());
        server.emplace(std::move(*listener), dispatcher);
    }
    json status_now() const { return json::parse(ask("GET /status").body); }
    static bool becomes(const std::function<bool()>& condition) {
        for (int i = 0; i < 1000; ++i) {
            if (condition()) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        return false;
    }
    std::string host() const { return "127.0.0.1:" + std::to_string(port); }

    Answered ask(const std::string& first, const std::string& headers = "",
                 const std::string& body = "", const std::string& as_host = "") const {
        const Browser browser(port);
        REQUIRE(browser.connected);
        browser.send(
            first + " HTTP/1.1\r\nHost: " + (as_host.empty() ? host() : as_host) + "\r\n" +
            (headers.find("Accept-Encoding") == std::string::npos ? "Accept-Encoding: gzip, br\r\n"
                                                                  : "") +
            headers +
            (body.empty() ? "" : "Content-Length: " + std::to_string(body.size()) + "\r\n") +
            "\r\n" + body);
        return browser.answer();
    }
    Answered command(const std::string& headers, const std::string& body = R"({"command":"pause"})",
                     const std::string& as_host = "") const {
        return ask("POST /command", headers, body, as_host);
    }
};

const std::string with_token = std::string("Authorization: Bearer ") + token + "\r\n";

}  // namespace

TEST_CASE("web page: who did not ask for gzip was sent it") {
    const Scene scene;
    for (const char* accepted : {"", "br", "identity", "gzip;q=0", "gzip;q=0, br"}) {
        CAPTURE(accepted);
        const Answered plain =
            scene.ask("GET /", std::string("Accept-Encoding: ") + accepted + "\r\n");
        CHECK(plain.status == 406);
        CHECK(plain.headers.find("Content-Encoding") == std::string::npos);
        CHECK(plain.body.find("curl --compressed") != std::string::npos);
    }
    for (const char* accepted : {"gzip", "br, gzip;q=0.5", "deflate, gzip;q=1.0, *;q=0.5"})
        CHECK(scene.ask("GET /", std::string("Accept-Encoding: ") + accepted + "\r\n").status ==
              200);
}

TEST_CASE("web page: gives the page, the status and the print") {
    const Scene scene;
    const Answered page = scene.ask("GET /");
    CHECK(page.status == 200);
    CHECK(page.headers.find("Content-Encoding: gzip") != std::string::npos);
    CHECK(page.headers.find("frame-ancestors 'none'") != std::string::npos);
    CHECK(page.headers.find("Access-Control") == std::string::npos);
    CHECK(page.body.size() < 64'000);
    std::string html(1 << 20, '\0');
    z_stream stream{};
    REQUIRE(inflateInit2(&stream, 16 + MAX_WBITS) == Z_OK);
    std::string packed = page.body;
    stream.next_in = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_in = static_cast<uInt>(packed.size());
    stream.next_out = reinterpret_cast<Bytef*>(html.data());
    stream.avail_out = static_cast<uInt>(html.size());
    CHECK(inflate(&stream, Z_FINISH) == Z_STREAM_END);
    html.resize(stream.total_out);
    inflateEnd(&stream);
    CHECK(html.starts_with("<!DOCTYPE html>"));
    CHECK(html.find("lyr.planStage = ") != std::string::npos);
    CHECK(html.find("@scripts@") == std::string::npos);
    const Answered status = scene.ask("GET /status");
    CHECK(status.status == 200);
    const json told = json::parse(status.body);
    CHECK(told["status"]["state"] == "printing");
    CHECK(told["history"]["samples"][0][1] == 200);
    CHECK(json::parse(scene.ask("GET /status?since=" + told["history"]["next"].dump())
                          .body)["history"]["samples"]
              .empty());
    const Answered print = scene.ask("GET /print.lyr");
    CHECK(print.status == 200);
    CHECK(print.body == std::string("LYR\x1a\0\1", 6));
    std::ofstream(scene.file, std::ios::binary) << "secret: 1234";
    CHECK(scene.ask("GET /print.lyr").status == 404);
    CHECK(scene.ask("GET /etc/passwd").status == 404);
    CHECK(scene.ask("GET /../../etc/passwd").status == 404);
    CHECK(scene.ask("DELETE /").status == 405);
    CHECK(scene.ask("POST /status", with_token, "{}").status == 405);
}

TEST_CASE("web page 1: reached at both addresses of this machine and at no other") {
    const Scene scene;
    CHECK_FALSE(Browser(scene.port, false, INADDR_LOOPBACK + 1).connected);
    const Browser six(scene.port, true);
    if (!six.connected) return;  // a machine without IPv6
    six.send("GET /status HTTP/1.1\r\nHost: [::1]:" + std::to_string(scene.port) + "\r\n\r\n");
    CHECK(six.answer().status == 200);
}

TEST_CASE("web page 2: nothing is controlled without the token") {
    Scene scene;
    for (const std::string& headers : {std::string(), std::string("Authorization: Bearer \r\n"),
                                       std::string("Authorization: Bearer 0123456789abcdeF\r\n"),
                                       std::string("Authorization: Bearer 0123456789abcde\r\n"),
                                       std::string("Authorization: Bearer 0123456789abcdef0\r\n"),
                                       std::string("Authorization: Basic 0123456789abcdef\r\n"),
                                       std::string("Cookie: token=0123456789abcdef\r\n")}) {
        const Answered refused = scene.command(headers);
        CHECK(refused.status == 403);
        CHECK(json::parse(refused.body)["error"]["code"] == "forbidden");
    }
    CHECK(scene.ask(std::string("POST /command?token=") + token, "", R"({"command":"stop"})")
              .status == 403);
    CHECK_FALSE(scene.print.take());
    const Answered done = scene.command(with_token);
    CHECK(done.status == 200);
    CHECK(json::parse(done.body)["ok"] == true);
    CHECK(scene.print.take() == run::Command(run::Pause{}));
    CHECK(json::parse(scene.command(with_token, "rubbish").body)["error"]["code"] == "bad_json");
    // Two lines in one would be answered by two.
    CHECK(json::parse(scene.command(with_token, "{\"command\":\n\"status\"}").body)["ok"] == true);
    CHECK(json::parse(scene.command(with_token, "{\"command\":\"pause\"}\n{\"command\":\"stop\"}")
                          .body)["error"]["code"] == "bad_json");
    CHECK_FALSE(scene.print.take());
}

TEST_CASE("web page 3: what another site's page asks is refused, with the token too") {
    Scene scene;
    for (const char* host :
         {"evil.example", "evil.example:80", "127.0.0.1", "127.0.0.1:1", "localhost"}) {
        CHECK(scene.command(with_token, R"({"command":"pause"})", host).status == 403);
        CHECK(scene.ask("GET /", "", "", host).status == 403);
        CHECK(scene.ask("GET /print.lyr", "", "", host).status == 403);
    }
    for (const char* origin :
         {"http://evil.example", "null", "https://127.0.0.1", "http://127.0.0.1"}) {
        const std::string header = std::string("Origin: ") + origin + "\r\n";
        CHECK(scene.command(with_token + header).status == 403);
        CHECK(scene.ask("GET /status", header).status == 403);
    }
    CHECK(scene.command(with_token + "Sec-Fetch-Site: cross-site\r\n").status == 403);
    CHECK(scene.ask("GET /print.lyr", "Sec-Fetch-Site: same-site\r\n").status == 403);
    CHECK_FALSE(scene.print.take());
    // A link to the page is no harm.
    CHECK(scene.ask("GET /", "Sec-Fetch-Site: cross-site\r\n").status == 200);
    CHECK(scene
              .command(with_token + "Origin: http://" + scene.host() +
                       "\r\nSec-Fetch-Site: same-origin\r\n")
              .status == 200);
    CHECK(scene
              .command(with_token, R"({"command":"pause"})",
                       "localhost:" + std::to_string(scene.port))
              .status == 200);
}

TEST_CASE("web page 4: what is too long, half or noise keeps nobody waiting") {
    Scene scene;
    CHECK(scene.command(with_token, std::string(most_line_bytes + 1, ' ')).status == 413);
    CHECK(scene.command(with_token, std::string(100'000, 'x')).status != 200);
    const Answered wide = scene.ask("GET /" + std::string(100'000, 'a'));
    CHECK(wide.status != 200);
    std::vector<std::unique_ptr<Browser>> slow;
    for (int i = 0; i < 12; ++i) {
        slow.push_back(std::make_unique<Browser>(scene.port));
        slow.back()->send("POST /command HTTP/1.1\r\nContent-Length: 5000\r\nHo");
    }
    std::mt19937 random(4);
    for (int i = 0; i < 30; ++i) {
        const Browser browser(scene.port);
        std::string noise;
        for (int k = 0; k < 300; ++k) noise += static_cast<char>(random() % 8 ? random() : '\n');
        browser.send(noise);
    }
    CHECK(scene.ask("GET /status").status == 200);
    CHECK(scene.command(with_token).status == 200);
}

TEST_CASE("relay 3: the page stays when the print goes, and shows the next one") {
    Scene scene;
    CHECK(scene.status_now()["print"] == 1);
    scene.server.reset();
    CHECK(scene.becomes([&] { return scene.status_now()["connected"] == false; }));
    CHECK(scene.status_now()["status"]["state"] == "printing");
    CHECK(json::parse(scene.command(with_token).body)["error"]["code"] == "wrong_state");
    scene.serve_print();
    CHECK(scene.becomes([&] { return scene.status_now()["print"] == 2; }));
    CHECK(scene.becomes([&] { return !scene.status_now()["history"]["samples"].empty(); }));
    CHECK(json::parse(scene.command(with_token).body)["ok"] == true);
}

TEST_CASE("relay 1: a print that does not greet yet does not freeze the page") {
    Scene scene;
    scene.server.reset();
    REQUIRE(scene.becomes([&] { return scene.status_now()["connected"] == false; }));
    auto listener = Listener::open(socket_path("web"));
    REQUIRE(listener.ok());
    // Longer than until the next look for prints.
    const auto from = std::chrono::steady_clock::now();
    std::chrono::steady_clock::duration longest{};
    for (auto now = from; now - from < std::chrono::seconds(3);) {
        CHECK(scene.status_now()["connected"] == false);
        const auto answered = std::chrono::steady_clock::now();
        longest = std::max(longest, answered - now);
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        now = std::chrono::steady_clock::now();
    }
    CHECK(longest < std::chrono::milliseconds(1500));
    // One connection waits all the time.
    std::size_t waiting = 0;
    for (int client = listener->accept(); client >= 0; client = listener->accept()) {
        ++waiting;
        ::close(client);
    }
    CHECK(waiting == 1);
    scene.server.emplace(std::move(*listener), scene.dispatcher);
    CHECK(scene.becomes([&] { return scene.status_now()["print"] == 2; }));
}

TEST_CASE("history: an hour is kept; who was away gets what is left") {
    History history;
    run::PrintStatus status;
    status.heaters[config::heater_bed] = {true, std::numeric_limits<double>::quiet_NaN(), 60};
    const auto read = [&](std::uint64_t since) { return json::parse(history.since(since)); };
    CHECK(read(0)["samples"].empty());
    for (int i = 0; i < 10; ++i) {
        status.elapsed_s = 0.4 * i;
        history.take(status);
    }
    CHECK(read(0)["samples"].size() == 4);
    CHECK(read(0)["samples"][0] == json({0, nullptr, nullptr, nullptr, 60.0, nullptr, nullptr}));
    for (std::size_t i = 0; i < 2 * History::most_samples; ++i) {
        status.elapsed_s = 10 + static_cast<double>(i);
        history.take(status);
    }
    const std::uint64_t next = read(0)["next"];
    CHECK(next == 2 * History::most_samples + 4);
    CHECK(read(0)["samples"].size() == History::most_samples);
    CHECK(read(next - 3)["samples"].size() == 3);
    CHECK(read(next - 3)["samples"][2][0] == 10 + 2 * History::most_samples - 1);
    CHECK(read(std::numeric_limits<std::uint64_t>::max())["samples"].empty());
}

TEST_CASE("token 1, 3: random ones differ; a token is equal to itself alone") {
    const auto one = random_token(), other = random_token();
    REQUIRE(one.ok());
    REQUIRE(other.ok());
    CHECK(one->size() == 32);
    CHECK(*one != *other);
    CHECK(is_token(*one, *one));
    for (std::size_t i = 0; i < one->size(); ++i) {
        std::string wrong = *one;
        wrong[i] = static_cast<char>(wrong[i] ^ 1);
        CHECK_FALSE(is_token(wrong, *one));
        CHECK_FALSE(is_token(one->substr(0, i), *one));
    }
    CHECK_FALSE(is_token(*one + "0", *one));
    CHECK_FALSE(is_token(*one + std::string(1, '\0'), *one));
}

TEST_CASE("token 2: from a file that nobody else may read, which is made where there is none") {
    const std::string path = socket_path("token");
    std::filesystem::remove(path);
    const auto made = token_in(path);
    REQUIRE(made.ok());
    struct stat found {};
    REQUIRE(::stat(path.c_str(), &found) == 0);
    CHECK((found.st_mode & 0777) == 0600);
    const auto again = token_in(path);
    REQUIRE(again.ok());
    CHECK(*again == *made);
    for (const mode_t mode : {0640, 0604, 0660, 0644}) {
        REQUIRE(::chmod(path.c_str(), mode) == 0);
        CHECK(token_in(path).error().message.find("chmod 600") != std::string::npos);
    }
    REQUIRE(::chmod(path.c_str(), 0600) == 0);
    for (const std::string& bad : {std::string(), std::string("short"), std::string(300, 'a'),
                                   std::string("0123456789abcdef\n0"), std::string(20, '\0')}) {
        std::ofstream(path, std::ios::binary | std::ios::trunc) << bad;
        CHECK(token_in(path).error().status == ExitStatus::input);
    }
    CHECK(token_in("/").error().status == ExitStatus::input);
    CHECK(token_in("/nonexistent/token").error().status == ExitStatus::output);
}
