// What of a print takes the heat away while the heaters' own thread cannot: print.h 8 and 9, on real threads.

#include <doctest/doctest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
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

// A hotend at 26 °C that is to reach 210. Its sensor hangs when it is told to, until the heater is off or that has taken
// too long.
struct HangingSensor {
    config::Printer printer = config::generic_printer();
    gpio::MonotonicClock clock;
    gpio::MockChip chip{8, clock, {}};
    std::atomic<gpio::LineMask> heat{0};
    std::atomic<bool> hangs{false}, has_hung{false}, was_cut{false};
    double longest_s = 0;
    Listener listener;
    std::atomic<int> fed_meanwhile{0};
    Heating heating;

    explicit HangingSensor(double longest) : longest_s(longest) {
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

    double read() {
        if (hangs && !has_hung) {
            has_hung = true;
            (void)listener.fed();
            const double from_s = heat_time_s();
            while (heat != 0 && heat_time_s() - from_s < longest_s)
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            was_cut = heat == 0;
            fed_meanwhile = listener.fed();
        }
        return 3'900;
    }
    std::string file() const {
        return write_print("print_guard", {draw_square}, {}, [](format::LayerState& state) {
            state.temperatures.push_back({{format::HeaterKind::tool, 0}, 210});
        });
    }
};

}  // namespace

TEST_CASE("print 8: heaters whose thread hangs go off after 3 s, and no watchdog is fed for it") {
    HangingSensor board(5);
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
    HangingSensor board(2);
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
