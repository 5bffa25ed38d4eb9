// Contracts of target/run/buttons.h and watchdog.h, by number, and what print.h (8, 9) says of both: on a real print's
// threads, with mock lines.

#include "target/run/buttons.h"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "scratch.h"
#include "target/gpio/mock_chip.h"
#include "target/gpio/mock_inputs.h"
#include "target/run/patient_printer.h"
#include "target/run/print.h"
#include "target/run/print_files.h"
#include "target/run/watchdog.h"

using namespace lyr;
using namespace lyr::run;
using namespace lyr::tests;

namespace {

constexpr std::int64_t ms = 1'000'000;

config::Printer buttoned_printer() {
    config::Printer printer = nearby_printer();
    printer.filament = {0.5, 0.5, 0.5, 20};
    for (std::uint32_t i = 0; i < config::input_count; ++i)
        printer.inputs[i] = config::Pin{"gpiochip0", 20 + i, false};
    return printer;
}

using Pressed = std::vector<std::size_t>;

}  // namespace

TEST_CASE("buttons 1: a contact counts once, when it has lasted") {
    gpio::VirtualClock clock;
    auto lines = std::make_unique<gpio::MockInputs>(config::input_count, clock);
    gpio::MockInputs& line = *lines;
    Result<Buttons> buttons = Buttons::start(buttoned_printer(), std::move(lines));
    REQUIRE(buttons.ok());
    const auto pressed_at = [&](std::int64_t time_ms) {
        const auto pressed = buttons->pressed(time_ms * ms);
        REQUIRE(pressed.ok());
        return *pressed;
    };
    CHECK(pressed_at(100).empty());
    line.set(config::input_cancel, true, 200 * ms);
    CHECK(pressed_at(210).empty());
    CHECK(pressed_at(221) == Pressed{config::input_cancel});
    CHECK(pressed_at(300).empty());
    line.set(config::input_cancel, false, 400 * ms);
    // A pulse that some motor left on the cable.
    line.set(config::input_pause, true, 500 * ms);
    line.set(config::input_pause, false, 505 * ms);
    CHECK(pressed_at(600).empty());
    line.set(config::input_cancel, true, 700 * ms);
    line.set(config::input_filament, true, 700 * ms);
    CHECK(pressed_at(800) == Pressed{config::input_cancel, config::input_filament});
}

TEST_CASE("buttons 2: what is a state counts from the start; a button that is held does not") {
    gpio::VirtualClock clock;
    for (std::size_t i = 0; i < config::input_count; ++i) {
        auto lines = std::make_unique<gpio::MockInputs>(config::input_count, clock);
        lines->set(i, true, 0);
        Result<Buttons> buttons = Buttons::start(buttoned_printer(), std::move(lines));
        REQUIRE(buttons.ok());
        const bool is_state = i == config::input_emergency || i == config::input_filament;
        CHECK(*buttons->pressed(50 * ms) == (is_state ? Pressed{i} : Pressed{}));
        CHECK(buttons->pressed(90 * ms)->empty());
    }
}

TEST_CASE("buttons: inputs become requests with their pulls, in order") {
    config::Printer printer = buttoned_printer();
    printer.inputs[config::input_cancel].reset();
    printer.inputs[config::input_filament]->pull = config::Pull::up;
    const auto requests = input_requests(printer);
    REQUIRE(requests.size() == 3);
    CHECK(requests[0].line.purpose == "input.pause");
    CHECK(requests[1].line.purpose == "input.emergency");
    CHECK(requests[2].line.purpose == "input.filament");
    CHECK(requests[2].pull == gpio::Pull::up);
}

namespace {

// Presses an input as soon as the print has been in `state`, until it is in another one.
struct Press {
    PrintState state;
    std::size_t input;
};

struct Pressing {
    Result<PrintReport> report = PrintReport{};
    PrintStatus end;
};

Pressing print_and_press(const std::vector<Press>& presses, bool fails = false) {
    const config::Printer printer = buttoned_printer();
    const std::string file = write_print("buttons", {draw_square});
    gpio::MonotonicClock clock;
    gpio::MockChip chip(8, clock, {});
    bool is_broken = false;
    auto lines = std::make_unique<gpio::MockInputs>(
        config::input_count, clock, [&]() -> std::optional<Diagnostic> {
            if (!is_broken) return std::nullopt;
            return Diagnostic{Severity::error, ExitStatus::machine, "chip unplugged", {}};
        });
    gpio::MockInputs& line = *lines;
    Result<Buttons> buttons = Buttons::start(printer, std::move(lines));
    REQUIRE(buttons.ok());
    PrintControl control;
    std::size_t next = 0;
    PrintJob job{file, printer, false, [&](const Progress& now) {
                     for (std::size_t i = 0; i < config::input_count; ++i) line.set(i, false);
                     if (now.time_s == 0) return;
                     is_broken = fails;
                     if (next == presses.size()) return;
                     if (control.status().state != presses[next].state) return;
                     line.set(presses[next++].input, true);
                 }};
    job.control = &control;
    Pressing done;
    done.report = print(job, chip, clock, nullptr, &*buttons);
    CHECK(chip.released());
    done.end = control.status();
    return done;
}

}  // namespace

TEST_CASE("print 9: the pause button pauses and goes on; the filament sensor has it changed") {
    const Pressing paused = print_and_press({{PrintState::printing, config::input_pause},
                                             {PrintState::paused, config::input_pause},
                                             {PrintState::printing, config::input_filament},
                                             {PrintState::paused, config::input_pause}});
    REQUIRE(paused.report.ok());
    CHECK(paused.report->paused_s > 0.3);
    CHECK(paused.end.state == PrintState::done);
}

TEST_CASE("print 9: the cancel button, the emergency line, and lines that are lost end a print") {
    const Pressing cancelled = print_and_press({{PrintState::printing, config::input_cancel}});
    REQUIRE_FALSE(cancelled.report.ok());
    CHECK(cancelled.report.error().message.find("cancelled") != std::string::npos);
    CHECK(cancelled.end.is_position_known);
    const Pressing cut = print_and_press({{PrintState::printing, config::input_emergency}});
    REQUIRE_FALSE(cut.report.ok());
    CHECK(cut.report.error().status == ExitStatus::stopped);
    CHECK(cut.report.error().message.find("emergency stop, by input.emergency: ") !=
          std::string::npos);
    CHECK_FALSE(cut.end.is_position_known);
    const Pressing lost = print_and_press({}, true);
    REQUIRE_FALSE(lost.report.ok());
    CHECK(lost.report.error().status == ExitStatus::machine);
    CHECK(lost.report.error().message.find("chip unplugged") != std::string::npos);
    CHECK(lost.end.is_position_known);
}

TEST_CASE("watchdog 1, 2: it is fed, and stopped in order; one that is not there is an error") {
    const std::string path = lyr::tests::scratch("watchdog");
    { std::ofstream made(path); }
    {
        Result<Watchdog> watchdog = Watchdog::open({path, 15});
        REQUIRE(watchdog.ok());
        watchdog->feed();
        watchdog->feed();
    }
    std::ostringstream fed;
    fed << std::ifstream(path).rdbuf();
    CHECK(fed.str() == "\n\n\nV");
    std::filesystem::remove(path);
    const Result<Watchdog> missing = Watchdog::open({path, 15});
    REQUIRE_FALSE(missing.ok());
    CHECK(missing.error().status == ExitStatus::machine);
    CHECK(missing.error().message.find(path) != std::string::npos);
    CHECK(missing.error().message.find("watchdog.device") != std::string::npos);
}

TEST_CASE("watchdog 3: the init system hears of a print, and nothing happens without one") {
    ::unsetenv("NOTIFY_SOCKET");
    notify("READY=1");
    const std::string path = lyr::tests::scratch("notify");
    std::filesystem::remove(path);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, path.data(), path.size());
    const int socket = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    REQUIRE(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
    ::setenv("NOTIFY_SOCKET", path.c_str(), 1);
    const Pressing printed = print_and_press({});
    ::setenv("NOTIFY_SOCKET", "/nonexistent/socket", 1);
    notify("READY=1");
    ::unsetenv("NOTIFY_SOCKET");
    REQUIRE(printed.report.ok());
    std::vector<std::string> heard;
    std::array<char, 300> text{};
    for (ssize_t count; (count = ::recv(socket, text.data(), text.size(), 0)) > 0;)
        heard.emplace_back(text.data(), static_cast<std::size_t>(count));
    REQUIRE(heard.size() >= 2);
    CHECK(heard.front() == "READY=1");
    CHECK(heard[1].starts_with("WATCHDOG=1\nSTATUS="));
    CHECK(heard[1].find("layer") != std::string::npos);
    ::close(socket);
    std::filesystem::remove(path);
}
