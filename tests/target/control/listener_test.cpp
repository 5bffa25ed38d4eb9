#include "target/control/listener.h"

#include <doctest/doctest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <thread>

#include "target/control/scene.h"

using namespace lyr;
using namespace lyr::control;
using namespace lyr::tests;

namespace {

std::string refusal_of(const std::string& path) {
    const auto listener = Listener::open(path);
    if (listener) return {};
    CHECK(listener.error().status == ExitStatus::machine);
    return to_string(listener.error());
}

}  // namespace

TEST_CASE("listener 1: user and group may connect, others not, whatever the umask is") {
    const std::string path = socket_path("mode");
    for (const mode_t mask : {0022, 0077, 0}) {
        const mode_t before = ::umask(mask);
        const auto listener = Listener::open(path);
        ::umask(before);
        REQUIRE(listener.ok());
        struct stat made {};
        REQUIRE(::lstat(path.c_str(), &made) == 0);
        CHECK((made.st_mode & 0777) == 0660);
    }
}

TEST_CASE("listener 2: a second server is refused; the socket of one that was killed is replaced") {
    const std::string path = socket_path("killed");
    {
        const auto first = Listener::open(path);
        REQUIRE(first.ok());
        CHECK(refusal_of(path).find("served already") != std::string::npos);
        CHECK(Connection(path).is_open());
    }
    const pid_t child = ::fork();
    if (child == 0) {
        auto left = Listener::open(path);
        ::_exit(left.ok() ? 0 : 1);
    }
    int status = -1;
    ::waitpid(child, &status, 0);
    REQUIRE(status == 0);
    CHECK(std::filesystem::exists(path));
    CHECK_FALSE(Connection(path).is_open());
    const auto next = Listener::open(path);
    REQUIRE_MESSAGE(next.ok(), (next.ok() ? "" : next.error().message));
    CHECK(Connection(path).is_open());
}

TEST_CASE("listener 2: what is not its own stays") {
    const std::string path = socket_path("file");
    std::ofstream(path) << "precious";
    CHECK(refusal_of(path).find("there is a file of that name") != std::string::npos);
    CHECK(std::filesystem::file_size(path) == 8);
    std::filesystem::remove(path);
    // A program that knows nothing of the lock.
    const auto other = Listener::open(path);
    REQUIRE(other.ok());
    std::filesystem::remove(path + ".lock");
    CHECK(refusal_of(path).find("another program serves") != std::string::npos);
    CHECK(Connection(path).is_open());
}

TEST_CASE("listener 2: of many that start at once one wins") {
    const std::string path = socket_path("race");
    for (int round = 0; round < 20; ++round) {
        std::atomic<int> opened{0}, tried{0};
        std::vector<std::thread> threads;
        for (int i = 0; i < 4; ++i)
            threads.emplace_back([&] {
                const auto listener = Listener::open(path);
                opened += listener.ok();
                ++tried;
                while (tried < 4) std::this_thread::yield();
            });
        for (std::thread& thread : threads) thread.join();
        CHECK(opened == 1);
    }
}

TEST_CASE("listener 3: nothing is left; what cannot be made is told") {
    const std::string path = socket_path("end");
    REQUIRE(Listener::open(path).ok());
    CHECK_FALSE(std::filesystem::exists(path));
    CHECK_FALSE(std::filesystem::exists(path + ".lock"));
    CHECK(refusal_of("/nonexistent/a.sock").find("cannot be made here") != std::string::npos);
    CHECK(refusal_of(socket_path(std::string(120, 'n'))).find("too long") != std::string::npos);
}
