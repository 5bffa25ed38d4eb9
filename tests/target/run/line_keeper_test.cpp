// Contract of target/run/line_keeper.h, by number, with a chip whose lines are a file; and that all heaters are kept so.

#include "target/run/line_keeper.h"

#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "scratch.h"
#include "target/run/heating.h"

using namespace lyr;
using namespace lyr::run;

namespace {

constexpr int patient_ms = 20'000;

// Levels as a number in a file, which outlives its process as lines do.
class FileChip final : public gpio::GpioChip {
public:
    explicit FileChip(std::string path) : path_(std::move(path)) {}
    std::size_t line_count() const override { return 2; }
    Status write(gpio::LineMask changed, gpio::LineMask levels) override {
        if (levels == 0b11 && changed == 0b10)
            return Diagnostic{Severity::error, ExitStatus::machine, "bus error", {}};
        levels_ = (levels_ & ~changed) | (levels & changed);
        std::ofstream(path_) << levels_ << ' ' << ::getpid() << '\n';
        return Done{};
    }
    Status release() override {
        if (released_) return Done{};
        released_ = true;
        return write(0b11, 0);
    }

private:
    std::string path_;
    gpio::LineMask levels_ = 0;
    bool released_ = false;
};

struct KeptLines {
    std::string path = lyr::tests::scratch("keeper");
    std::string dropped = path + "_dropped";

    KeptLines() { remove(); }
    ~KeptLines() { remove(); }
    void remove() const {
        std::filesystem::remove(path);
        std::filesystem::remove(dropped);
    }
    Result<std::unique_ptr<gpio::GpioChip>> keep(int silent_ms = patient_ms) const {
        return keep_lines(
            2,
            [this]() -> Result<std::unique_ptr<gpio::GpioChip>> {
                return std::unique_ptr<gpio::GpioChip>(std::make_unique<FileChip>(path));
            },
            silent_ms, [this] { std::ofstream(dropped) << "yes\n"; });
    }
    int levels() const {
        int levels = -1;
        std::ifstream(path) >> levels;
        return levels;
    }
    // The one that wrote last.
    pid_t keeper() const {
        int levels = -1;
        pid_t writer = -1;
        std::ifstream(path) >> levels >> writer;
        return writer;
    }
};

bool comes(const std::function<bool()>& what) {
    for (int i = 0; i < 500; ++i) {
        if (what()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

// What a process does that ends by a signal; true if it came to that.
bool ends_by(int signal, const std::function<void()>& work) {
    const pid_t worker = ::fork();
    if (worker == 0) {
        work();
        // The test program has handlers of its own.
        ::signal(signal, SIG_DFL);
        ::raise(signal);
        ::_exit(0);
    }
    int status = 0;
    ::waitpid(worker, &status, 0);
    return WIFSIGNALED(status) && WTERMSIG(status) == signal;
}

}  // namespace

TEST_CASE("line keeper 1: writes are carried out, and what fails comes back") {
    const KeptLines bench;
    {
        auto chip = bench.keep();
        REQUIRE(chip.ok());
        CHECK((*chip)->line_count() == 2);
        REQUIRE((*chip)->write(0b11, 0b01).ok());
        CHECK(bench.levels() == 1);
        const Status failed = (*chip)->write(0b10, 0b11);
        REQUIRE_FALSE(failed.ok());
        CHECK(failed.error().message == "bus error");
        REQUIRE((*chip)->write(0b11, 0b10).ok());
        CHECK(bench.levels() == 2);
        REQUIRE((*chip)->release().ok());
        CHECK(bench.levels() == 0);
        CHECK_FALSE((*chip)->write(0b11, 0b10).ok());
    }
    CHECK(comes([&] { return std::filesystem::exists(bench.dropped); }));
    const auto refused = keep_lines(
        1,
        []() -> Result<std::unique_ptr<gpio::GpioChip>> {
            return Diagnostic{Severity::error, ExitStatus::machine, "no such chip", {}};
        },
        patient_ms);
    REQUIRE_FALSE(refused.ok());
    CHECK(refused.error().message == "no such chip");
}

TEST_CASE("line keeper 2: however the program ends, the lines go off") {
    for (const int signal : {SIGKILL, SIGSEGV, SIGABRT, SIGTERM}) {
        CAPTURE(signal);
        const KeptLines bench;
        CHECK(ends_by(signal, [&] {
            auto chip = bench.keep();
            if (!chip) ::_exit(1);
            if (!(*chip)->write(0b11, 0b11).ok() || bench.levels() != 3) ::_exit(1);
            // As a crash: nothing is wound up.
            (void)chip->release();
        }));
        CHECK(comes([&] { return bench.levels() == 0; }));
        CHECK(comes([&] { return std::filesystem::exists(bench.dropped); }));
    }
}

TEST_CASE("line keeper 2: a program that goes silent loses its lines") {
    const KeptLines bench;
    auto chip = bench.keep(200);
    REQUIRE(chip.ok());
    for (int i = 0; i < 10; ++i) {
        REQUIRE((*chip)->write(0b11, 0b01).ok());
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    CHECK(bench.levels() == 1);
    CHECK(comes([&] { return bench.levels() == 0; }));
    CHECK_FALSE((*chip)->write(0b11, 0b01).ok());
    CHECK(bench.levels() == 0);
}

TEST_CASE("line keeper 2: a program that was stopped and goes on blamed its keeper") {
    const KeptLines bench;
    auto chip = bench.keep(50);
    REQUIRE(chip.ok());
    REQUIRE((*chip)->write(0b01, 0b01).ok());
    REQUIRE(comes([&] { return bench.levels() == 0; }));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    const Status late = (*chip)->write(0b01, 0b01);
    REQUIRE_FALSE(late.ok());
    CHECK(late.error().message.find("this program was silent") != std::string::npos);
    CHECK(bench.levels() == 0);
}

TEST_CASE("line keeper 3: signals to the whole group do not end the keeper before the program") {
    const KeptLines bench;
    CHECK(ends_by(SIGKILL, [&] {
        ::setpgid(0, 0);
        for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::signal(signal, SIG_IGN);
        auto chip = bench.keep();
        if (!chip || !(*chip)->write(0b11, 0b01).ok()) ::_exit(1);
        for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::kill(0, signal);
        if (!(*chip)->write(0b11, 0b10).ok() || bench.levels() != 2) ::_exit(1);
        (void)chip->release();
    }));
    CHECK(comes([&] { return bench.levels() == 0; }));
}

TEST_CASE("line keeper 3: signals that ask a program to end do not end its keeper") {
    const KeptLines bench;
    auto chip = bench.keep();
    REQUIRE(chip.ok());
    REQUIRE((*chip)->write(0b11, 0b01).ok());
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGUSR1, SIGPIPE}) {
        CAPTURE(signal);
        ::kill(bench.keeper(), signal);
        REQUIRE((*chip)->write(0b11, 0b10).ok());
        CHECK(bench.keeper() != ::getpid());
    }
    CHECK(bench.levels() == 2);
}

TEST_CASE("line keeper 3: Ctrl-Z stopped the keeper with the program, and left the heater on") {
    for (const int signal : {SIGTSTP, SIGSTOP}) {
        CAPTURE(signal);
        const KeptLines bench;
        const pid_t worker = ::fork();
        if (worker == 0) {
            ::setpgid(0, 0);
            ::signal(SIGTSTP, SIG_DFL);
            auto chip = bench.keep(200);
            if (!chip || !(*chip)->write(0b11, 0b11).ok()) ::_exit(1);
            ::kill(0, signal);
            ::_exit(0);
        }
        int status = 0;
        ::waitpid(worker, &status, WUNTRACED);
        CHECK(WIFSTOPPED(status));
        CHECK(comes([&] { return bench.levels() == 0; }));
        ::kill(worker, SIGKILL);
        ::waitpid(worker, &status, 0);
    }
}

TEST_CASE(
    "line keeper 3: the keeper was killed or stopped by name, and nobody switched the heater off") {
    for (const int signal : {SIGKILL, SIGSTOP}) {
        CAPTURE(signal);
        const KeptLines bench;
        auto chip = bench.keep();
        REQUIRE(chip.ok());
        REQUIRE((*chip)->write(0b11, 0b11).ok());
        const pid_t keeper = bench.keeper();
        REQUIRE(keeper > 0);
        ::kill(keeper, signal);
        const auto from = std::chrono::steady_clock::now();
        const Status failed = (*chip)->write(0b11, 0b01);
        CHECK(std::chrono::steady_clock::now() - from < std::chrono::seconds(2));
        REQUIRE_FALSE(failed.ok());
        CHECK(failed.error().message.find("switched off") != std::string::npos);
        CHECK(bench.levels() == 0);
        CHECK_FALSE((*chip)->write(0b11, 0b11).ok());
        CHECK(bench.levels() == 0);
    }
}

TEST_CASE("line keeper 3: lines that came free late were given up after one try") {
    for (const int refusals : {3, 45}) {
        CAPTURE(refusals);
        const KeptLines bench;
        const pid_t self = ::getpid();
        int tries = 0;
        auto chip = keep_lines(
            2,
            [&]() -> Result<std::unique_ptr<gpio::GpioChip>> {
                if (::getpid() == self && ++tries <= refusals)
                    return Diagnostic{Severity::error, ExitStatus::machine, "busy", {}};
                return std::unique_ptr<gpio::GpioChip>(std::make_unique<FileChip>(bench.path));
            },
            patient_ms);
        REQUIRE(chip.ok());
        REQUIRE((*chip)->write(0b11, 0b11).ok());
        ::kill(bench.keeper(), SIGKILL);
        const std::string first = (*chip)->write(0b11, 0b01).error().message;
        const bool is_told = first.find("cut the power") != std::string::npos;
        CHECK(is_told == (refusals > 40));
        CHECK(bench.levels() == (is_told ? 3 : 0));
        // Who ends tries again.
        while (!(*chip)->write(0b11, 0b01).ok() && bench.levels() != 0) continue;
        CHECK(bench.levels() == 0);
        CHECK(tries == refusals + 1);
    }
}

TEST_CASE(
    "heating 1: a crash left a heater on that was a kernel PWM channel, where no output was a "
    "line") {
    const std::filesystem::path folder = lyr::tests::scratch_folder("keeper_pwm");
    for (const char* name : {"period", "duty_cycle", "enable", "sensor"})
        std::ofstream(folder / name) << 20'000'000 << '\n';
    std::ofstream(folder / "sensor") << 25 << '\n';
    config::Printer printer;
    config::Heater bed = config::default_heater(config::heater_bed);
    bed.pwm = folder;
    bed.sensor.kind = config::SensorKind::celsius;
    bed.sensor.celsius_per_unit = 1;
    bed.sensor.file = folder / "sensor";
    printer.heaters[config::heater_bed] = bed;
    const auto duty_ns = [&] {
        long written_ns = -1;
        std::ifstream(folder / "duty_cycle") >> written_ns;
        return written_ns;
    };
    CHECK(ends_by(SIGKILL, [&] {
        Result<Heating> heating = open_heating(printer);
        if (!heating) ::_exit(1);
        heating->control->set_target(config::heater_bed, 60);
        heating->control->tick(heat_time_s());
        if (duty_ns() <= 0) ::_exit(1);
        ::raise(SIGKILL);
    }));
    CHECK(comes([&] { return duty_ns() == 0; }));
    std::filesystem::remove_all(folder);
}
