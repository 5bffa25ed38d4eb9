// Contracts of target/thermal/power_stage.h and kernel_pwm.h, by number.

#include "target/thermal/power_stage.h"

#include <doctest/doctest.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "scratch.h"
#include "target/gpio/mock_chip.h"
#include "target/run/full_disk.h"

using namespace lyr;
using namespace lyr::thermal;

namespace {

// Two heaters and a fan on lines.
struct Bench {
    gpio::VirtualClock clock;
    std::vector<gpio::LineWrite> writes;
    bool broken = false;
    gpio::MockChip chip{
        3, clock, gpio::recorder(writes), [this](std::uint64_t) {
            return broken ? std::optional(Diagnostic{
                                Severity::error, ExitStatus::machine, "writing failed", {}})
                          : std::nullopt;
        }};
    PowerStage stage{outputs(), &chip};

    static std::vector<Output> outputs() {
        std::vector<Output> made;
        for (std::size_t line = 0; line < 3; ++line)
            made.push_back({LineOutput{line, SlowPwm(1)}, line < 2});
        return made;
    }
};

constexpr std::array<double, 3> full{1, 1, 1};

struct PwmFolder {
    std::string path = lyr::tests::scratch("pwm");
    PwmFolder() { std::filesystem::create_directories(path); }
    explicit PwmFolder(const std::string& period) : PwmFolder() {
        hold("period", period);
        hold("duty_cycle", "");
        hold("enable", "0\n");
    }
    ~PwmFolder() { std::filesystem::remove_all(path); }
    void hold(const char* file, const std::string& text) const {
        std::ofstream(path + '/' + file) << text;
    }
    int held(const char* file) const {
        int value = -1;
        std::ifstream(path + '/' + file) >> value;
        return value;
    }
};

}  // namespace

TEST_CASE("power stage 1: all lines leave in one write") {
    Bench bench;
    REQUIRE(bench.stage.apply(full, 0).ok());
    REQUIRE(bench.writes.size() == 1);
    CHECK(bench.chip.levels() == 7);
    REQUIRE(bench.stage.apply(std::array{0.0, 1.0, 0.0}, 0.1).ok());
    CHECK(bench.chip.levels() == 2);
    CHECK(bench.writes.size() == 2);
}

TEST_CASE("power stage 2: off is one write and for good; fans keep turning") {
    Bench bench;
    REQUIRE(bench.stage.apply(full, 0).ok());
    REQUIRE(bench.stage.all_off().ok());
    CHECK(bench.writes.size() == 2);
    CHECK(bench.chip.levels() == 4);
    for (int i = 0; i < 100; ++i) {
        REQUIRE(bench.stage.apply(full, i * tick_s).ok());
        CHECK(bench.chip.levels() == 4);
    }
    CHECK(bench.stage.latched());
}

TEST_CASE("power stage 3: heaters that nobody refreshes for 3 s go off") {
    Bench bench;
    CHECK_FALSE(bench.stage.expire(100));  // from here on
    REQUIRE(bench.stage.apply(full, 100).ok());
    CHECK_FALSE(bench.stage.expire(102.9));
    CHECK(bench.chip.levels() == 7);
    const auto trip = bench.stage.expire(103.1);
    REQUIRE(trip);
    CHECK(trip->kind == GuardKind::silent);
    CHECK(bench.chip.levels() == 4);
    CHECK_FALSE(bench.stage.expire(110));  // told once
    REQUIRE(bench.stage.apply(full, 111).ok());
    CHECK(bench.chip.levels() == 4);
}

TEST_CASE("power stage 3: control that hung before its first tick was never told") {
    Bench bench;
    CHECK_FALSE(bench.stage.expire(100));
    CHECK_FALSE(bench.stage.expire(102.9));
    const auto trip = bench.stage.expire(103.1);
    REQUIRE(trip);
    CHECK(trip->kind == GuardKind::silent);
    REQUIRE(bench.stage.apply(full, 104).ok());
    CHECK(bench.chip.levels() == 4);
}

TEST_CASE("power stage 4: a write that fails is told, and heat does not come back by itself") {
    Bench bench;
    REQUIRE(bench.stage.apply(full, 0).ok());
    bench.broken = true;
    CHECK_FALSE(bench.stage.apply(full, 0.1).ok());
    bench.broken = false;
    CHECK(bench.stage.apply(full, 0.2).ok());
    CHECK(bench.chip.levels() == 4);
}

TEST_CASE("power stage 5: the end leaves nothing on, not even fans") {
    Bench bench;
    {
        PowerStage stage(Bench::outputs(), &bench.chip);
        REQUIRE(stage.apply(full, 0).ok());
    }
    CHECK(bench.chip.levels() == 0);
    CHECK(bench.chip.released());
}

TEST_CASE("kernel pwm: a channel is enabled with nothing on it, set in nanoseconds and left off") {
    const PwmFolder folder;
    CHECK_FALSE(KernelPwm::open(folder.path).ok());
    folder.hold("period", "0\n");
    CHECK_FALSE(KernelPwm::open(folder.path).ok());
    folder.hold("period", "40000\n");
    folder.hold("duty_cycle", "");
    folder.hold("enable", "0\n");
    {
        Result<KernelPwm> pwm = KernelPwm::open(folder.path);
        REQUIRE(pwm.ok());
        CHECK(folder.held("enable") == 1);
        CHECK(folder.held("duty_cycle") == 0);
        std::vector<Output> outputs;
        outputs.push_back({std::move(*pwm), true});
        PowerStage stage(std::move(outputs), nullptr);
        REQUIRE(stage.apply(std::array{0.25}, 0).ok());
        CHECK(folder.held("duty_cycle") == 10'000);
        REQUIRE(stage.apply(std::array{7.0}, 0.1).ok());
        CHECK(folder.held("duty_cycle") == 40'000);
        REQUIRE(stage.all_off().ok());
        CHECK(folder.held("duty_cycle") == 0);
        REQUIRE(stage.apply(std::array{1.0}, 0.2).ok());
        CHECK(folder.held("duty_cycle") == 0);
    }
    CHECK(folder.held("duty_cycle") == 0);
    // By itself, and where its stage has been released.
    Result<KernelPwm> again = KernelPwm::open(folder.path);
    REQUIRE(again.ok());
    {
        KernelPwm pwm = std::move(*again);
        REQUIRE(pwm.set(0.5).ok());
        CHECK(folder.held("duty_cycle") == 20'000);
    }
    CHECK(folder.held("duty_cycle") == 0);
    std::vector<Output> outputs;
    outputs.push_back({std::move(*KernelPwm::open(folder.path)), true});
    PowerStage stage(std::move(outputs), nullptr);
    REQUIRE(stage.apply(std::array{0.5}, 0).ok());
    REQUIRE(stage.release().ok());
    CHECK(stage.latched());
    REQUIRE(stage.apply(std::array{0.5}, 0.1).ok());
    CHECK(folder.held("duty_cycle") == 0);
}

TEST_CASE(
    "kernel pwm 2: a write that failed half-way stayed, for the off after it was not written") {
    const PwmFolder folder("20000000\n");
    Result<KernelPwm> pwm = KernelPwm::open(folder.path);
    REQUIRE(pwm.ok());
    REQUIRE(pwm->set(0).ok());
    {
        const lyr::tests::FullDisk disk(4);
        errno = ENOENT;
        const Status failed = pwm->set(0.5);
        REQUIRE_FALSE(failed.ok());
        // What an earlier call had left in errno was told for the reason.
        CHECK_MESSAGE(failed.error().message.ends_with(std::strerror(EIO)), failed.error().message);
    }
    REQUIRE(folder.held("duty_cycle") == 1'000);
    REQUIRE(pwm->set(0).ok());
    CHECK(folder.held("duty_cycle") == 0);
    // Whoever else wrote it.
    folder.hold("duty_cycle", "5000\n");
    REQUIRE(pwm->set(0).ok());
    CHECK(folder.held("duty_cycle") == 0);
}

TEST_CASE("kernel pwm 4: two programs drove one channel, each believing in what it had written") {
    const PwmFolder folder("40000\n");
    {
        Result<KernelPwm> first = KernelPwm::open(folder.path);
        REQUIRE(first.ok());
        const KernelPwm held = std::move(*first);
        folder.hold("duty_cycle", "20000\n");
        const Result<KernelPwm> second = KernelPwm::open(folder.path);
        REQUIRE_FALSE(second.ok());
        CHECK(second.error().status == ExitStatus::machine);
        CHECK(second.error().where.file == folder.path + "/duty_cycle");
        CHECK(second.error().message.find("end that program") != std::string::npos);
        CHECK(folder.held("duty_cycle") == 20'000);
    }
    CHECK(folder.held("duty_cycle") == 0);
    CHECK(KernelPwm::open(folder.path).ok());
}
