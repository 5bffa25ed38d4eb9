// Contract of target/run/line_keeper.h, by number, with a chip whose lines are a file.

#include "target/run/line_keeper.h"

#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

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
        std::ofstream(path_) << levels_ << '\n';
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

struct Bench {
    std::string path = (std::filesystem::temp_directory_path() / "lyr_run_keeper").string();
    std::string dropped = path + "_dropped";

    Bench() { remove(); }
    ~Bench() { remove(); }
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
    bool comes(const std::function<bool()>& what) const {
        for (int i = 0; i < 500; ++i) {
            if (what()) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return false;
    }
};

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
    const Bench bench;
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
    CHECK(bench.comes([&] { return std::filesystem::exists(bench.dropped); }));
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
        const Bench bench;
        CHECK(ends_by(signal, [&] {
            auto chip = bench.keep();
            if (!chip) ::_exit(1);
            if (!(*chip)->write(0b11, 0b11).ok() || bench.levels() != 3) ::_exit(1);
            // As a crash: nothing is wound up.
            (void)chip->release();
        }));
        CHECK(bench.comes([&] { return bench.levels() == 0; }));
        CHECK(bench.comes([&] { return std::filesystem::exists(bench.dropped); }));
    }
}

TEST_CASE("line keeper 2: a program that goes silent loses its lines") {
    const Bench bench;
    auto chip = bench.keep(200);
    REQUIRE(chip.ok());
    for (int i = 0; i < 10; ++i) {
        REQUIRE((*chip)->write(0b11, 0b01).ok());
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    CHECK(bench.levels() == 1);
    CHECK(bench.comes([&] { return bench.levels() == 0; }));
    CHECK_FALSE((*chip)->write(0b11, 0b01).ok());
    CHECK(bench.levels() == 0);
}

TEST_CASE("line keeper 3: signals to the whole group do not end the keeper before the program") {
    const Bench bench;
    CHECK(ends_by(SIGKILL, [&] {
        ::setpgid(0, 0);
        for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::signal(signal, SIG_IGN);
        auto chip = bench.keep();
        if (!chip || !(*chip)->write(0b11, 0b01).ok()) ::_exit(1);
        for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::kill(0, signal);
        if (!(*chip)->write(0b11, 0b10).ok() || bench.levels() != 2) ::_exit(1);
        (void)chip->release();
    }));
    CHECK(bench.comes([&] { return bench.levels() == 0; }));
}
