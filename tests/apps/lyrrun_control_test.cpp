// A print that is controlled while it runs: lyrrun without a board, and lyrctl beside it.

#include <termios.h>

#include <nlohmann/json.hpp>

#include "apps/program.h"
#include "target/run/print_files.h"

using namespace lyr;
using namespace lyr::tests;
using nlohmann::json;

namespace {

// Some minutes of it.
std::string write_long(const std::string& name) {
    return write_print(name, std::vector<Drawing>(60, draw_circles));
}

void draw_short(const Pen& pen) {
    pen.path();
    pen.line(0, 0);
}

// lyrrun in the folder of its sockets; it is stopped when the test is over.
struct RunningPrint {
    Folder folder;
    Running print;

    explicit RunningPrint(const std::string& name, std::vector<std::string> more = {})
        : folder(name), print(folder, arguments(name, std::move(more)), folder / "err") {
        REQUIRE(print.wait_for([&] { return fs::exists(folder / "s"); }));
    }
    static std::vector<std::string> arguments(const std::string& name,
                                              std::vector<std::string> more) {
        std::vector<std::string> all{"lyrrun",    write_long(name), "--dry-run",
                                     "--no-heat", "--socket",       "s"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }

    Ended lyrctl(const std::string& what) const {
        return folder.run("lyrctl " + what + " --socket s");
    }
    json status() const {
        const Ended ended = lyrctl("status --json");
        return ended.status == 0 ? json::parse(ended.out) : json::object();
    }
    bool becomes(const std::string& state) const {
        return print.wait_for([&] { return status().value("state", "") == state; });
    }
};

}  // namespace

TEST_CASE("lyrrun: a dry run takes the print's time, needs no lines and reports") {
    const Folder folder("lyrrun-dry");
    const Ended ended = folder.run("lyrrun " + write_print("dry", {draw_short}) +
                                   " --dry-run --no-heat --socket s");
    CHECK(ended.status == 0);
    CHECK(ended.out.find("tried on \"generic\"") != std::string::npos);
    CHECK(ended.out.find("writes, the latest") != std::string::npos);
    CHECK(folder.files().empty());
}

TEST_CASE("lyrctl: pauses, resumes, slows down and cancels a print") {
    const RunningPrint scene("lyrrun-controlled");
    CHECK(scene.becomes("printing"));
    const json begun = scene.status();
    CHECK(begun["layers"] == 60);
    CHECK(begun["printer"] == "generic");
    CHECK(scene.print.wait_for([&] { return scene.status()["time_s"] > begun["time_s"]; }));
    CHECK(scene.lyrctl("pause").status == 0);
    CHECK(scene.becomes("paused"));
    const json rested = scene.status();
    CHECK(scene.lyrctl("pause").status == 7);
    CHECK(scene.lyrctl("set tool=210").status == 7);
    CHECK(scene.status()["time_s"] == rested["time_s"]);
    CHECK(scene.lyrctl("set speed=50%").status == 0);
    CHECK(scene.lyrctl("resume").status == 0);
    CHECK(scene.becomes("printing"));
    CHECK(scene.status()["speed"] == 0.5);
    CHECK(scene.lyrctl("cancel").status == 0);
    CHECK(scene.print.end(0) == 8);
    CHECK(text_of(scene.folder / "err").find("cancelled") != std::string::npos);
    CHECK_FALSE(fs::exists(scene.folder / "s"));
}

#ifndef __SANITIZE_ADDRESS__
TEST_CASE("lyrrun: a print takes little memory (the locked stacks of its threads had 32 MB)") {
    const RunningPrint scene("lyrrun-memory");
    CHECK(scene.becomes("printing"));
    const long resident_kb = scene.print.resident_kb();
    CHECK(resident_kb > 0);
    CHECK(resident_kb < 20'000);
    CHECK(scene.print.end(SIGTERM) == 8);
}
#endif

// Where standard error may go that takes nothing: a terminal after Ctrl-S, and a pipe that is full.
class Silenced {
public:
    explicit Silenced(const Folder& folder, bool is_terminal) {
        if (is_terminal) {
            far_ = ::posix_openpt(O_RDWR | O_NOCTTY);
            REQUIRE((far_ >= 0 && ::grantpt(far_) == 0 && ::unlockpt(far_) == 0));
            name_ = ::ptsname(far_);
            near_ = ::open(name_.c_str(), O_RDWR | O_NOCTTY);
            REQUIRE(::tcflow(near_, TCOOFF) == 0);
            return;
        }
        folder.make_pipe("full");
        name_ = folder / "full";
        far_ = ::open(name_.c_str(), O_RDONLY | O_NONBLOCK);
        near_ = ::open(name_.c_str(), O_WRONLY | O_NONBLOCK);
        while (::write(near_, "x", 1) == 1) continue;
    }
    ~Silenced() {
        ::close(near_);
        ::close(far_);
    }
    Silenced(const Silenced&) = delete;
    Silenced& operator=(const Silenced&) = delete;
    const std::string& name() const { return name_; }

private:
    std::string name_;
    int near_ = -1, far_ = -1;
};

TEST_CASE("lyrrun: beside a stopped terminal or a full pipe the last message never ended") {
    for (const bool is_terminal : {true, false})
        for (const bool cancels : {false, true}) {
            CAPTURE(is_terminal);
            CAPTURE(cancels);
            const Folder folder("lyrrun-silenced");
            const Silenced silenced(folder, is_terminal);
            const Running print(folder, RunningPrint::arguments("silenced", {}), silenced.name());
            REQUIRE(print.wait_for([&] {
                return folder.run("lyrctl status --socket s").out.find("printing") !=
                       std::string::npos;
            }));
            if (cancels) CHECK(folder.run("lyrctl cancel --socket s").status == 0);
            const auto asked = std::chrono::steady_clock::now();
            CHECK(print.end(cancels ? 0 : SIGTERM) == 8);
            CHECK(std::chrono::steady_clock::now() - asked < std::chrono::seconds(3));
        }
}

TEST_CASE("lyrctl: an emergency stop ends the print at once") {
    const RunningPrint scene("lyrrun-emergency");
    CHECK(scene.becomes("printing"));
    CHECK(scene.lyrctl("stop").status == 0);
    CHECK(scene.print.end(0) == 8);
    CHECK(text_of(scene.folder / "err").find("emergency stop") != std::string::npos);
}

TEST_CASE("lyrrun: one server a socket; the socket of a killed one is taken over") {
    const RunningPrint scene("lyrrun-socket");
    const std::string again = "lyrrun " + write_long("again") + " --dry-run --no-heat --socket s";
    check_lyrrun_failure(scene.folder.run(again), 7, "s: error: this socket is served already");
    CHECK(scene.becomes("printing"));
    CHECK(scene.print.end(SIGKILL) == -1);
    CHECK(fs::exists(scene.folder / "s"));
    CHECK(scene.lyrctl("status").status == 7);
    const Running next(scene.folder, RunningPrint::arguments("next", {}), scene.folder / "err");
    CHECK(next.wait_for([&] { return scene.lyrctl("status").status == 0; }));
    CHECK(next.end(SIGTERM) == 8);
    CHECK_FALSE(fs::exists(scene.folder / "s"));
}

TEST_CASE("lyrrun: options of control that make no sense") {
    const Folder folder("lyrrun-options");
    const std::string print = "lyrrun " + write_print("options", {draw_square});
    check_lyrrun_failure(folder.run(print + " --dry-run --simulate"), 2, "--simulate");
    check_lyrrun_failure(folder.run(print + " --simulate --socket s"), 2, "--simulate");
    check_lyrrun_failure(folder.run(print + " --dry-run --no-heat --socket none/s"), 7, "none/s");
}
