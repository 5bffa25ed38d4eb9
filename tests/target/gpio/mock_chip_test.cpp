// Contract of GpioChip as the mock keeps it, and the mock's own, by number.

#include "target/gpio/mock_chip.h"

#include <doctest/doctest.h>

using namespace lyr;
using namespace lyr::gpio;

TEST_CASE("chip 1, 2: lines start inactive and a write changes only what it names") {
    VirtualClock clock;
    std::vector<LineWrite> writes;
    MockChip chip(3, clock, recorder(writes));
    CHECK(chip.line_count() == 3);
    CHECK(chip.levels() == 0);
    CHECK(chip.write(0b011, 0b111).ok());
    CHECK(chip.levels() == 0b011);
    CHECK(chip.write(0b010, 0b000).ok());
    CHECK(chip.levels() == 0b001);
    CHECK(chip.write(~LineMask{0}, ~LineMask{0}).ok());
    CHECK(chip.levels() == 0b111);
    CHECK(writes.size() == 3);
    CHECK(writes[2].changed == 0b111);
}

TEST_CASE("chip 2: all 64 lines can be used") {
    VirtualClock clock;
    MockChip chip(max_lines, clock, {});
    CHECK(chip.write(line_bit(63), line_bit(63)).ok());
    CHECK(chip.levels() == line_bit(63));
}

TEST_CASE("chip 6: release makes all lines inactive, and nothing is written afterwards") {
    VirtualClock clock;
    std::vector<LineWrite> writes;
    {
        MockChip chip(2, clock, recorder(writes));
        CHECK(chip.write(0b11, 0b11).ok());
        CHECK(chip.release().ok());
        CHECK(chip.released());
        CHECK(chip.levels() == 0);
        CHECK_FALSE(chip.write(0b1, 0b1).ok());
        CHECK(chip.levels() == 0);
        CHECK(chip.release().ok());
    }
    CHECK(writes.size() == 2);
    {
        MockChip dropped(2, clock, recorder(writes));
        CHECK(dropped.write(0b11, 0b10).ok());
    }
    CHECK(writes.back().levels == 0);
}

TEST_CASE("mock 1: the observer sees the time and the state of all lines") {
    VirtualClock clock;
    std::vector<LineWrite> writes;
    MockChip chip(4, clock, recorder(writes));
    clock.wait_until_ns(500);
    CHECK(chip.write(0b0001, 0b0001).ok());
    clock.wait_until_ns(700);
    CHECK(chip.write(0b1000, 0b1000).ok());
    REQUIRE(writes.size() == 2);
    CHECK(writes[0].time_ns == 500);
    CHECK(writes[1].time_ns == 700);
    CHECK(writes[1].changed == 0b1000);
    CHECK(writes[1].levels == 0b1001);
}

TEST_CASE("mock 2: a faulty write changes nothing and is not observed") {
    VirtualClock clock;
    std::vector<LineWrite> writes;
    MockChip chip(1, clock, recorder(writes),
                  [](std::uint64_t number) -> std::optional<Diagnostic> {
                      if (number != 1) return std::nullopt;
                      return Diagnostic{Severity::error, ExitStatus::machine, "bus error", {}};
                  });
    CHECK(chip.write(1, 1).ok());
    const Status failed = chip.write(1, 0);
    REQUIRE_FALSE(failed.ok());
    CHECK(failed.error().message == "bus error");
    CHECK(chip.levels() == 1);
    CHECK(chip.write(1, 0).ok());
    CHECK(writes.size() == 2);
}
