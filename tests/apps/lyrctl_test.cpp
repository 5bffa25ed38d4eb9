// lyrctl from outside, against a server whose print does nothing.

#include <nlohmann/json.hpp>

#include "apps/program.h"
#include "target/control/server.h"

using namespace lyr;
using namespace lyr::tests;

namespace {

run::PrintStatus some_status(run::PrintState state) {
    run::PrintStatus status;
    status.state = state;
    status.file = "part.lyr";
    status.layer = 12;
    status.layers = 150;
    status.time_s = 723;
    status.estimated_s = 5400;
    status.heaters[config::heater_tool] = {true, 209.8, 210};
    status.heaters[config::heater_bed] = {true, 21, 0};
    status.fan = 0.5;
    status.speed_factor = 1.2;
    return status;
}

struct Scene {
    Folder folder;
    run::PrintControl print;
    config::Printer printer = config::generic_printer();
    control::Dispatcher dispatcher{print, printer};
    std::optional<control::Server> server;

    explicit Scene(const std::string& name) : folder(name) {
        print.publish(some_status(run::PrintState::printing));
        serve("lyr/a.sock");
    }
    void serve(const std::string& name) {
        fs::create_directories((folder / name).parent_path());
        auto listener = control::Listener::open(folder / name);
        REQUIRE(listener.ok());
        server.emplace(std::move(*listener), dispatcher);
    }
    // The user's folder of sockets is the test's.
    Ended lyrctl(const std::string& arguments) const {
        return folder.run("XDG_RUNTIME_DIR=$PWD lyrctl " + arguments);
    }
    void check_done(const std::string& arguments, const run::Command& command) {
        CAPTURE(arguments);
        const Ended ended = lyrctl(arguments);
        CHECK_MESSAGE(ended.status == 0, ended.err);
        CHECK(ended.out.empty());
        CHECK(ended.err.empty());
        CHECK(print.take() == command);
    }
};

void check_lyrctl_failure(const Ended& ended, int status, const std::string& part) {
    check_failure(ended, "lyrctl", status, part);
}

}  // namespace

TEST_CASE("lyrctl: status for people and for programs") {
    const Scene scene("lyrctl-status");
    const Ended text = scene.lyrctl("status");
    CHECK(text.status == 0);
    CHECK(text.err.empty());
    CHECK(text.out ==
          "part.lyr on \"generic\": printing\n"
          "  layer      12 of 150\n"
          "  time       0:12:03 of about 1:30:00 (13 %)\n"
          "  tool       209.8 °C, set to 210 °C\n"
          "  bed        21.0 °C, off\n"
          "  fan        50 %\n"
          "  speed      120 %\n"
          "  head       x 0.00 y 0.00 z 0.00 mm\n");
    const Ended json = scene.lyrctl("status --json");
    CHECK(json.status == 0);
    CHECK(lines_in(json.out) == 1);
    CHECK(nlohmann::json::parse(json.out)["heaters"]["tool"]["target_c"] == 210);
}

TEST_CASE("lyrctl: each command arrives as what it says") {
    Scene scene("lyrctl-commands");
    scene.check_done("pause", run::Pause{});
    scene.check_done("change-filament", run::ChangeFilament{});
    scene.check_done("cancel", run::Cancel{});
    scene.check_done("stop", run::EmergencyStop{});
    scene.check_done("set tool=210", run::SetTemperature{config::heater_tool, 210});
    scene.check_done("set bed=62.5", run::SetTemperature{config::heater_bed, 62.5});
    scene.check_done("set fan=50%", run::SetFan{0.5});
    scene.check_done("set speed=120%", run::SetSpeedFactor{1.2});
    CHECK(scene.lyrctl("set speed=80% tool=200 fan=0% --socket lyr/a.sock").status == 0);
    CHECK(scene.print.take() == run::Command(run::SetTemperature{config::heater_tool, 200}));
    CHECK(scene.print.take() == run::Command(run::SetFan{0}));
    CHECK(scene.print.take() == run::Command(run::SetSpeedFactor{0.8}));
    CHECK_FALSE(scene.print.take());
}

TEST_CASE("lyrctl: what is wrong comes as one line and with its status") {
    Scene scene("lyrctl-wrong");
    check_lyrctl_failure(scene.lyrctl(""), 2, "a command is required");
    check_lyrctl_failure(scene.lyrctl("puase"), 2, "did you mean pause?");
    check_lyrctl_failure(scene.lyrctl("pause now"), 2, "unexpected argument \"now\"");
    check_lyrctl_failure(scene.lyrctl("pause --json"), 2, "go with status");
    check_lyrctl_failure(scene.lyrctl("set"), 2, "tool=210");
    check_lyrctl_failure(scene.lyrctl("set nozzle=210"), 2, "nozzle=210");
    for (const char* bad :
         {"tool", "tool=", "tool=hot", "tool=50%", "fan=1", "fan=%", "speed=nan%"})
        check_lyrctl_failure(scene.lyrctl(std::string("set ") + bad), 2, "expected");
    // What no printer does was sent, and came back as an error of the machine.
    for (const char* bad : {"speed=1000%", "speed=9%", "speed=-50%"})
        check_lyrctl_failure(scene.lyrctl(std::string("set ") + bad), 2, "from 10 to 300 and %");
    check_lyrctl_failure(scene.lyrctl("set fan=101%"), 2, "from 0 to 100 and %");
    check_lyrctl_failure(scene.lyrctl("set bed=1001"), 2, "°C, from 0 to 1000");
    for (const char* port : {"", "http", "-1", "65536", "80.5", "80 81"})
        check_lyrctl_failure(scene.lyrctl(std::string("web ") + port), 2, "web: expected a port");
    check_lyrctl_failure(scene.lyrctl("pause --token token"), 2, "--token goes with web");
    check_lyrctl_failure(scene.lyrctl("resume"), 7, "cannot resume: the print is printing");
    check_lyrctl_failure(scene.lyrctl("set tool=400"), 7, "goes up to 270");
    check_lyrctl_failure(scene.lyrctl("status --socket nowhere.sock"), 7, "no printer is at work");
    check_lyrctl_failure(scene.lyrctl("status >/dev/full"), 6, "");
    CHECK_FALSE(scene.print.take());
    const Ended help = scene.lyrctl("--help");
    CHECK(help.status == 0);
    CHECK(help.out.find("Examples:") != std::string::npos);
    CHECK(help.out.find("Exit status:") != std::string::npos);
}

TEST_CASE(
    "lyrctl: finds the one printer; of several one must be chosen, and of none it says where it "
    "looked") {
    Scene scene("lyrctl-find");
    auto other = control::Listener::open(scene.folder / "lyr/b.sock");
    REQUIRE(other.ok());
    check_lyrctl_failure(scene.lyrctl("status"), 2, "lyr/b.sock");
    CHECK(scene.lyrctl("status --socket lyr/a.sock").status == 0);
    fs::remove(scene.folder / "lyr/b.sock");
    CHECK(scene.lyrctl("status").status == 0);
    scene.server.reset();
    check_lyrctl_failure(scene.lyrctl("status"), 7, "there is no socket in /run/lyr, ");
}

TEST_CASE("lyrctl: --watch goes on until the print is over and ends as it did") {
    Scene scene("lyrctl-watch");
    scene.print.publish(some_status(run::PrintState::done));
    const Ended done = scene.lyrctl("status --watch --json");
    CHECK(done.status == 0);
    CHECK(lines_in(done.out) == 1);
    run::PrintStatus failed = some_status(run::PrintState::failed);
    failed.message = "a guard fired";
    scene.print.publish(failed);
    const Ended told = scene.lyrctl("status --watch");
    CHECK(told.status == 7);
    CHECK(told.err == "lyrctl: error: the print failed: a guard fired\n");
    // It was said to have failed.
    run::PrintStatus stopped = some_status(run::PrintState::stopped);
    stopped.message = "cancelled";
    scene.print.publish(stopped);
    const Ended ended = scene.lyrctl("status --watch");
    CHECK(ended.status == 8);
    CHECK(ended.err == "lyrctl: error: the print was stopped: cancelled\n");
    scene.print.publish(some_status(run::PrintState::paused));
    const Running watching(scene.folder, {"lyrctl", "status", "--watch", "--socket", "lyr/a.sock"},
                           scene.folder / "err");
    CHECK(watching.wait_for([&] { return watching.blocks(SIGINT); }));
    CHECK(watching.end(SIGINT) == 8);
}
