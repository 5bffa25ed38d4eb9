// Contract of target/gpio/tracing_chip.h, by number, with a reader of wave files of its own.

#include "target/gpio/tracing_chip.h"

#include <doctest/doctest.h>

#include <array>
#include <filesystem>
#include <map>
#include <random>

#include "scratch.h"
#include "target/gpio/mock_chip.h"
#include "target/gpio/wave_file.h"

using namespace lyr;
using namespace lyr::gpio;
using lyr::tests::read_wave;
using lyr::tests::scratch;
using lyr::tests::Wave;

namespace {

const std::array<std::string, 3> names{"x.step", "x.dir", "y step#2"};

}  // namespace

TEST_CASE("trace 2, 3, 4: the wave has the scale, the wires, the start, the changes and the end") {
    const std::string path = scratch("lyr_trace_test.vcd");
    VirtualClock clock;
    clock.wait_until_ns(1'000'000);  // a clock that has run before
    {
        Result<ReplaceFile> file = ReplaceFile::open(path);
        REQUIRE(file.ok());
        MockChip mock(3, clock, {});
        TracingChip chip(mock, clock, names, *file);
        clock.advance_ns(250);
        CHECK(chip.write(0b111, 0b101).ok());
        clock.advance_ns(50);
        CHECK(chip.write(0b111, 0b101).ok());  // no change, no line
        clock.advance_ns(50);
        CHECK(chip.write(0b001, 0b000).ok());
        clock.advance_ns(650);
        chip.finish();
        REQUIRE(file->commit().ok());
    }
    const Wave wave = read_wave(path);
    CHECK(wave.timescale == "1ns");
    REQUIRE(wave.wires.size() == 3);
    CHECK(wave.changes.at(0).size() == 3);
    CHECK(wave.changes.at(0).at("x_step") == '0');
    CHECK(wave.changes.at(250) == std::map<std::string, char>{{"x_step", '1'}, {"y_step_2", '1'}});
    CHECK(wave.changes.count(300) == 0);
    CHECK(wave.changes.at(350) == std::map<std::string, char>{{"x_step", '0'}});
    CHECK(wave.end_ns == 1'000);
    std::filesystem::remove(path);
}

TEST_CASE("trace 1: what the inner chip refuses is not traced, and its answer is passed on") {
    const std::string path = scratch("lyr_trace_fault_test.vcd");
    VirtualClock clock;
    {
        Result<ReplaceFile> file = ReplaceFile::open(path);
        REQUIRE(file.ok());
        MockChip mock(3, clock, {}, [](std::uint64_t number) -> std::optional<Diagnostic> {
            if (number != 0) return std::nullopt;
            return Diagnostic{Severity::error, ExitStatus::machine, "stuck", {}};
        });
        TracingChip chip(mock, clock, names, *file);
        clock.advance_ns(10);
        CHECK_FALSE(chip.write(0b001, 0b001).ok());
        clock.advance_ns(10);
        CHECK(chip.write(0b010, 0b010).ok());
        chip.finish();
        REQUIRE(file->commit().ok());
    }
    const Wave wave = read_wave(path);
    CHECK(wave.changes.count(10) == 0);
    CHECK(wave.changes.at(20) == std::map<std::string, char>{{"x_dir", '1'}});
    std::filesystem::remove(path);
}

TEST_CASE("trace 1, 2: a long random wave reads back as what the inner chip saw") {
    const std::string path = scratch("lyr_trace_random_test.vcd");
    VirtualClock clock;
    std::vector<LineWrite> writes;
    {
        Result<ReplaceFile> file = ReplaceFile::open(path);
        REQUIRE(file.ok());
        MockChip mock(3, clock, recorder(writes));
        TracingChip chip(mock, clock, names, *file);
        std::mt19937 random(7);
        for (int i = 0; i < 20'000; ++i) {
            clock.advance_ns(1 + random() % 1'000);
            CHECK(chip.write(random() % 8, random() % 8).ok());
        }
        chip.finish();
        REQUIRE(file->commit().ok());
        CHECK(chip.release().ok());
        CHECK(mock.released());
        writes.pop_back();  // of the release, after the file was closed
    }
    const Wave wave = read_wave(path);
    std::map<std::string, char> state = wave.changes.at(0);
    auto next = std::next(wave.changes.begin());
    std::size_t differences = 0;
    for (const LineWrite& write : writes) {
        if (next != wave.changes.end() && next->first == write.time_ns)
            for (const auto& [name, level] : (next++)->second) state[name] = level;
        differences += (state["x_step"] == '1') != ((write.levels & 1) != 0);
        differences += (state["x_dir"] == '1') != ((write.levels & 2) != 0);
        differences += (state["y_step_2"] == '1') != ((write.levels & 4) != 0);
    }
    CHECK(next == wave.changes.end());
    CHECK(differences == 0);
    std::filesystem::remove(path);
}

TEST_CASE("trace: an unwritable file is reported before anything is printed") {
    CHECK_FALSE(ReplaceFile::open("/nonexistent-folder/out.vcd").ok());
}
