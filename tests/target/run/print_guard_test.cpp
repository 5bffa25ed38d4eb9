// What of a print takes the heat away while the heaters' own thread cannot, or the real-time one: print.h 2, 4, 8 and 9, on
// real threads.

#include <doctest/doctest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <new>
#include <thread>

#include "scratch.h"
#include "target/gpio/mock_inputs.h"
#include "target/run/print.h"
#include "target/run/print_files.h"

using namespace lyr;
using namespace lyr::run;
using namespace lyr::tests;

namespace {

// The init system, or nobody.
class Listener {
public:
    Listener() {
        std::filesystem::remove(path_);
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        std::memcpy(address.sun_path, path_.data(), path_.size());
        REQUIRE(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
        ::setenv("NOTIFY_SOCKET", path_.c_str(), 1);
    }
    ~Listener() {
        ::unsetenv("NOTIFY_SOCKET");
        ::close(socket_);
        std::filesystem::remove(path_);
    }
    // Since the last call.
    int fed() const {
        int count = 0;
        std::array<char, 300> text{};
        for (ssize_t size; (size = ::recv(socket_, text.data(), text.size(), 0)) > 0;)
            count += std::string_view(text.data(), static_cast<std::size_t>(size))
                         .starts_with("WATCHDOG=1");
        return count;
    }

private:
    std::string path_ = lyr::tests::scratch("print_guard");
    int socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
};

// A hotend at 26 °C that is to reach 210. Its sensor hangs when it is told to, or the lines of the motors do, until the
// heater is off or that has taken too long.
struct HangingBoard {
    config::Printer printer = config::generic_printer();
    gpio::MonotonicClock clock;
    std::atomic<gpio::LineMask> heat{0};
    Heating heating;  // the motors' lines look at it to the end
    gpio::MockChip chip{8, clock, [this](const gpio::LineWrite&) { wrote(); }};
    std::atomic<bool> hangs{false}, write_hangs{false}, has_hung{false}, was_cut{false};
    double longest_s = 0;
    bool outlasts_heat = false;
    std::atomic<int> writes{0};       // of the motors' lines
    std::atomic<int> cold_writes{0};  // of those, when all heat had been taken away
    PrintControl control;
    PrintStatus status_then;  // when it had hung
    Listener listener;
    std::atomic<int> fed_meanwhile{0};

    explicit HangingBoard(double longest) : longest_s(longest) {
        printer.pulse.late_limit_ns = 10'000'000'000;
        printer.heaters[config::heater_bed].reset();
        std::vector<thermal::Output> outputs;
        outputs.push_back({thermal::LineOutput{0, thermal::SlowPwm(0.5)}, true});
        std::vector<thermal::HeaterPort> ports;
        ports.push_back(
            {config::heater_tool, *printer.heaters[config::heater_tool],
             std::make_unique<thermal::MockSensor>([this]() -> Result<double> { return read(); })});
        heating.chip = std::make_unique<gpio::MockChip>(
            1, clock, [this](const gpio::LineWrite& write) { heat = write.levels; });
        heating.stage =
            std::make_unique<thermal::PowerStage>(std::move(outputs), heating.chip.get());
        heating.control =
            std::make_unique<thermal::HeatControl>(std::move(ports), false, *heating.stage);
    }

    void hang() {
        has_hung = true;
        (void)listener.fed();
        const double from_s = heat_time_s();
        while ((heat != 0 || outlasts_heat) && heat_time_s() - from_s < longest_s)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        was_cut = heat == 0;
        std::this_thread::sleep_for(std::chrono::milliseconds(200));  // until that is told
        fed_meanwhile = listener.fed();
        status_then = control.status();
    }
    double read() {
        if (hangs && !has_hung) hang();
        return 3'900;
    }
    void wrote() {
        if (write_hangs && !has_hung) hang();
        ++writes;
        cold_writes += heating.stage->latched();
    }
    // One that waits for nothing.
    std::string cold_file() const { return write_print("print_guard_cold", {draw_square}); }
    std::string file() const {
        return write_print("print_guard", {draw_square}, {}, [](format::LayerState& state) {
            state.temperatures.push_back({{format::HeaterKind::tool, 0}, 210});
        });
    }
};

}  // namespace

TEST_CASE("print 8: heaters whose thread hangs go off after 3 s, and no watchdog is fed for it") {
    HangingBoard board(5);
    const ProgressSink watch = [&](const Progress&) { board.hangs = board.heat != 0; };
    const Result<PrintReport> report =
        print({board.file(), board.printer, false, watch}, board.chip, board.clock, &board.heating);
    REQUIRE_FALSE(report.ok());
    CHECK(report.error().status == ExitStatus::machine);
    CHECK(report.error().message.find("silent for more than 3 s") != std::string::npos);
    CHECK(board.has_hung);
    CHECK(board.was_cut);
    // For the ticks before, and then no more.
    CHECK(board.fed_meanwhile <= 1);
}

TEST_CASE("print 9: inputs that are lost take the heat away at once, whatever its thread does") {
    // Before the heaters would be silent.
    HangingBoard board(2);
    board.printer.inputs[config::input_pause] = config::Pin{"gpiochip0", 20u, false};
    auto lines =
        std::make_unique<gpio::MockInputs>(1, board.clock, [&]() -> std::optional<Diagnostic> {
            if (!board.has_hung) return std::nullopt;
            return Diagnostic{Severity::error, ExitStatus::machine, "chip unplugged", {}};
        });
    Result<Buttons> buttons = Buttons::start(board.printer, std::move(lines));
    REQUIRE(buttons.ok());
    const ProgressSink watch = [&](const Progress&) { board.hangs = board.heat != 0; };
    const Result<PrintReport> report = print({board.file(), board.printer, false, watch},
                                             board.chip, board.clock, &board.heating, &*buttons);
    REQUIRE_FALSE(report.ok());
    CHECK(report.error().message.find("chip unplugged") != std::string::npos);
    CHECK(board.has_hung);
    CHECK(board.was_cut);
}

TEST_CASE("print 8: a write that hung left the heat on, and the watchdogs were fed") {
    HangingBoard board(6);
    // The desk's own order: the path waits for no temperature.
    board.control.post(SetTemperature{config::heater_tool, 210});
    PrintJob job{board.cold_file(), board.printer, true,
                 [&](const Progress&) { board.write_hangs = board.heat != 0; }};
    job.control = &board.control;
    const Result<PrintReport> report = print(job, board.chip, board.clock, &board.heating);
    REQUIRE_FALSE(report.ok());
    CHECK(report.error().status == ExitStatus::machine);
    CHECK_MESSAGE(report.error().message.find("a write to the lines hangs") != std::string::npos,
                  report.error().message);
    CHECK(board.has_hung);
    CHECK(board.was_cut);
    CHECK(board.status_then.message.find("a write to the lines hangs") != std::string::npos);
    // For the 3 s of silence.
    CHECK(board.fed_meanwhile <= 4);
}

TEST_CASE("print 3, 6: a sensor that hung kept the lines of the motors and the reason from all") {
    HangingBoard board(8);
    board.outlasts_heat = true;
    PrintJob job{board.file(), board.printer, false,
                 [&](const Progress&) { board.hangs = board.heat != 0; }};
    job.control = &board.control;
    const Result<PrintReport> report = print(job, board.chip, board.clock, &board.heating);
    REQUIRE_FALSE(report.ok());
    CHECK(board.has_hung);
    CHECK(board.was_cut);
    CHECK(board.status_then.state == PrintState::failed);
    CHECK(board.status_then.message.find("silent for more than 3 s") != std::string::npos);
}

TEST_CASE("print 4: a signal left the heat on until the head had come to rest") {
    HangingBoard board(0);
    for (config::Axis& axis : board.printer.axes) {
        axis.max_speed_mm_s = 50;
        axis.max_acceleration_mm_s2 = 50;
    }
    bool has_struck = false;
    const ProgressSink strike = [&](const Progress& now) {
        if (now.time_s > 1 && !std::exchange(has_struck, true)) std::raise(SIGTERM);
    };
    const Result<PrintReport> report = print({board.cold_file(), board.printer, true, strike},
                                             board.chip, board.clock, &board.heating);
    REQUIRE_FALSE(report.ok());
    CHECK(report.error().status == ExitStatus::stopped);
    CHECK(report.error().message.find("lost") == std::string::npos);
    CHECK(board.cold_writes > 10);
}

TEST_CASE("print 10: a signal and a guard together stopped at once, and did not say so") {
    HangingBoard board(0);
    board.printer.inputs[config::input_pause] = config::Pin{"gpiochip0", 20u, false};
    std::atomic<bool> has_struck{false};
    auto lines =
        std::make_unique<gpio::MockInputs>(1, board.clock, [&]() -> std::optional<Diagnostic> {
            if (!has_struck) return std::nullopt;
            return Diagnostic{Severity::error, ExitStatus::machine, "chip unplugged", {}};
        });
    Result<Buttons> buttons = Buttons::start(board.printer, std::move(lines));
    REQUIRE(buttons.ok());
    PrintJob job{board.cold_file(), board.printer, true, [&](const Progress& now) {
                     if (now.time_s > 0.5 && !has_struck.exchange(true)) std::raise(SIGTERM);
                 }};
    job.control = &board.control;
    const Result<PrintReport> report =
        print(job, board.chip, board.clock, &board.heating, &*buttons);
    REQUIRE_FALSE(report.ok());
    CHECK(report.error().message == "chip unplugged");
    CHECK(board.control.status().is_position_known);
}

TEST_CASE("print: one that resumes heated while it homed, with the nozzle in the part") {
    HangingBoard board(0);
    PrintJob job{board.cold_file(), board.printer, true, {}};
    job.control = &board.control;
    Resumption resumption;
    resumption.state.temperatures.push_back({{format::HeaterKind::tool, 0}, 210});
    job.resumption = resumption;
    job.is_lifted = true;
    bool was_warm = false;
    job.before = [&](gpio::GpioChip&, gpio::Clock& clock, const StopSource& stop,
                     const NoteRisen&) -> Before {
        for (int look = 0; look < 30; ++look) {
            clock.wait_until_ns(clock.now_ns() + 20'000'000);
            (void)stop();
            was_warm |= board.heat != 0;
        }
        return {};
    };
    bool is_warm = false;
    job.progress = [&](const Progress&) {
        if (board.heat == 0 || std::exchange(is_warm, true)) return;
        board.control.post(EmergencyStop{});
    };
    const Result<PrintReport> report = print(job, board.chip, board.clock, &board.heating);
    REQUIRE_FALSE(report.ok());
    CHECK_FALSE(was_warm);
    CHECK(is_warm);
}

TEST_CASE("print 3: where the thread that watches a print throws, the head comes to rest") {
    const auto writes = [](bool throws) {
        HangingBoard board(0);
        const PrintJob job{board.cold_file(), board.printer, true, [throws](const Progress&) {
                               if (throws) throw std::bad_alloc();
                           }};
        const auto run = [&] { return print(job, board.chip, board.clock, &board.heating); };
        if (throws)
            CHECK_THROWS_AS((void)run(), std::bad_alloc);
        else
            CHECK(run().ok());
        return board.writes.load();
    };
    const int all = writes(false);
    CHECK(writes(true) < all / 2);
}
