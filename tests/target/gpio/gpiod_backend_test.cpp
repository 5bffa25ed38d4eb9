// Contracts of GpioChip, gpiod_chip.h, gpiod_inputs.h and gpiod_calls.h, by number: one source, built against each
// version of libgpiod on a fake board.

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "scratch.h"
#include "target/gpio/fake_board.h"
#include "target/gpio/gpiod_chip.h"
#include "target/gpio/gpiod_inputs.h"
#include "target/gpio/gpiod_lines.h"

using namespace lyr;
using namespace lyr::gpio;
using lyr::tests::board;
using lyr::tests::Call;
using lyr::tests::FakeChip;
using lyr::tests::FakeLine;

namespace {

void set_up_board() {
    board() = {};
    board().chips.resize(2);
    board().chips[0] = {"gpiochip0", "pinctrl-test", std::vector<FakeLine>(28)};
    board().chips[1] = {"gpiochip1", "expander", std::vector<FakeLine>(8)};
    board().chips[0].lines[17].name = "GPIO17";
    board().chips[0].lines[4].user = "spi0 CS0";
}

bool level(std::size_t chip, std::size_t line) {
    return board().chips[chip].lines[line].level;
}

std::string refusal(std::span<const LineRequest> requests) {
    const auto opened = open_gpiod_chip(requests);
    REQUIRE_FALSE(opened.ok());
    CHECK(board().requests == 0);
    CHECK(board().opened == 0);
    return opened.error().message;
}

bool mentions(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("gpiod 1, chip 1-4: one request and one call a chip, inactive from the first moment") {
    set_up_board();
    // Out of order, one inverted, one by name.
    const std::vector<LineRequest> requests{{"x.step", "gpiochip0", 22u},
                                            {"x.direction", "0", "GPIO17", true},
                                            {"fan", "/dev/gpiochip1", 3u},
                                            {"y.step", "gpiochip0", 5u}};
    {
        const auto chip = open_gpiod_chip(requests);
        REQUIRE_MESSAGE(chip.ok(), chip.error().message);
        CHECK(board().requests == 2);
        CHECK(board().chips[0].lines[22].user == "lyrrun");
        CHECK(board().chips[0].lines[22].output);
        CHECK_FALSE(level(0, 22));
        CHECK(level(0, 17));
        CHECK(board().sets == 0);
        CHECK((*chip)->write(0b1001, 0b1001).ok());
        CHECK(board().sets == 1);
        CHECK(level(0, 22));
        CHECK(level(0, 5));
        CHECK(level(0, 17));
        CHECK((*chip)->write(0b0111, 0b0110).ok());
        CHECK(board().sets == 3);
        CHECK_FALSE(level(0, 22));
        CHECK_FALSE(level(0, 17));
        CHECK(level(1, 3));
        CHECK(level(0, 5));
    }
    CHECK_FALSE(level(0, 5));
    CHECK(level(0, 17));
    CHECK_FALSE(level(1, 3));
    CHECK(board().requests == 0);
    CHECK(board().opened == 0);
    CHECK(board().chips[0].lines[22].user.empty());
}

TEST_CASE("chip 2: after any writes every line has the level that it was given last") {
    set_up_board();
    std::mt19937 random(4);
    std::vector<LineRequest> requests;
    for (std::uint32_t i = 0; i < 12; ++i)
        requests.push_back({"line " + std::to_string(i), i % 3 ? "gpiochip0" : "gpiochip1",
                            i % 3 ? 5 + (i * 7) % 23 : i / 3, i % 4 == 0,
                            i % 5 == 0 ? Drive::open_drain : Drive::push_pull});
    const auto chip = open_gpiod_chip(requests);
    REQUIRE_MESSAGE(chip.ok(), chip.error().message);
    LineMask levels = 0;
    int differences = 0;
    for (int run = 0; run < 2'000; ++run) {
        const LineMask changed = random() & 0xfff, wanted = random();
        CHECK((*chip)->write(changed, wanted).ok());
        levels = (levels & ~changed) | (wanted & changed);
        for (std::size_t i = 0; i < requests.size(); ++i) {
            const bool active = (levels & line_bit(i)) != 0;
            const auto number = std::get<std::uint32_t>(requests[i].line);
            differences += level(requests[i].chip == "gpiochip1", number) !=
                           (active != requests[i].active_low);
        }
    }
    CHECK(differences == 0);
}

TEST_CASE("gpiod 1: lines that are let go and not driven high are requested so") {
    set_up_board();
    const std::vector<LineRequest> requests{{"x.step", "gpiochip0", 1u, false, Drive::open_drain},
                                            {"y.step", "gpiochip0", 2u},
                                            {"z.step", "gpiochip0", 3u, true, Drive::open_drain}};
    const auto chip = open_gpiod_chip(requests);
    REQUIRE(chip.ok());
    const auto& lines = board().chips[0].lines;
    CHECK(lines[1].drive == Drive::open_drain);
    CHECK(lines[2].drive == Drive::push_pull);
    CHECK(lines[3].drive == Drive::open_drain);
    CHECK(lines[3].level);
    CHECK(board().requests == (calls::holds_unlike_lines() ? 1 : 2));
    CHECK((*chip)->write(0b101, 0b101).ok());
    CHECK(board().sets == 1);
}

TEST_CASE("chip 5: after a failed write the next one sets every line of that chip anew") {
    set_up_board();
    const std::vector<LineRequest> requests{
        {"a", "gpiochip0", 1u}, {"b", "gpiochip0", 2u, true}, {"c", "gpiochip1", 3u}};
    const auto chip = open_gpiod_chip(requests);
    REQUIRE(chip.ok());
    REQUIRE((*chip)->write(0b011, 0b001).ok());
    board().fails = true;
    const Status failed = (*chip)->write(0b111, 0b110);
    REQUIRE_FALSE(failed.ok());
    CHECK(mentions(failed.error().message, "gpiochip0"));
    CHECK(mentions(failed.error().message, "homed"));
    // The other chip was written all the same.
    CHECK(level(1, 3));
    board().chips[0].lines[2].level = false;  // whatever the failed call did
    board().lines_set = 0;
    REQUIRE((*chip)->write(0b001, 0b000).ok());
    CHECK(board().lines_set == 2);
    CHECK_FALSE(level(0, 1));
    CHECK(level(0, 2));
}

TEST_CASE("gpiod 2, 4: what cannot be had is refused by name, and nothing is held then") {
    set_up_board();
    const LineRequest good{"x.step", "gpiochip0", 1u};
    const auto with = [&](const LineRequest& bad) { return refusal(std::vector{good, bad}); };
    CHECK(mentions(with({"y.step", "gpiochip7", 1u}), "y.step: cannot open GPIO chip gpiochip7"));
    CHECK(mentions(with({"y.step", "gpiochip0", 28u}), "the chip has lines 0 to 27"));
    CHECK(mentions(with({"y.step", "gpiochip0", "GPIO99"}), "gpioinfo gpiochip0"));
    CHECK(mentions(with({"y.step", "gpiochip0", 4u}), "already held by spi0 CS0"));
    CHECK(mentions(with({"y.step", "0", 1u}), "already used for x.step"));
    board().fails = true;
    board().failing = Call::request;
    CHECK(mentions(with({"y.step", "gpiochip0", 2u}), "cannot request the lines of gpiochip0"));
    board().fails = true;
    board().failing = Call::open;
    CHECK(mentions(with({"y.step", "gpiochip0", 2u}), "group"));
    CHECK(open_gpiod_chip(std::vector{good}).ok());
}

TEST_CASE("gpiod 5: a line is found without being held") {
    set_up_board();
    const auto named = look_up_line({"x.step", "gpiochip0", "GPIO17"});
    REQUIRE(named.ok());
    CHECK(named->chip == "gpiochip0");
    CHECK(named->number == 17);
    CHECK(named->name == "GPIO17");
    CHECK_FALSE(named->user);
    const auto held = look_up_line({"x.step", "0", 4u});
    REQUIRE(held.ok());
    CHECK(held->user == "spi0 CS0");
    CHECK_FALSE(look_up_line({"x.step", "gpiochip0", 28u}).ok());
    CHECK(board().requests == 0);
    CHECK(board().opened == 0);
}

TEST_CASE("lines 1: a chip is found by its label among the devices") {
    set_up_board();
    const std::filesystem::path folder = lyr::tests::scratch_folder("labels");
    for (const char* name : {"gpiochip0", "gpiochip1", "gpiochip2", "other"})
        std::ofstream(folder / name) << "";
    const auto found = open_chip({"x.step", "expander", 0u}, folder.string());
    REQUIRE(found.ok());
    CHECK(found->facts.name == "gpiochip1");
    CHECK(found->facts.line_count == 8);
    const auto none = open_chip({"x.step", "no-such", 0u}, folder.string());
    REQUIRE_FALSE(none.ok());
    CHECK(mentions(none.error().message, "gpiodetect"));
    // One that may not be looked at could be the one.
    board().fails = true;
    board().failing = Call::open;
    CHECK(mentions(open_chip({"x.step", "no-such", 0u}, folder.string()).error().message, "group"));
    CHECK(board().opened == 1);
    std::filesystem::remove_all(folder);
}

TEST_CASE("inputs 1-4: levels and edges arrive with their times, pulled and inverted as asked") {
    set_up_board();
    const std::vector<InputRequest> requests{{{"x.endstop", "gpiochip0", 6u}, Pull::up},
                                             {{"stop", "gpiochip0", 7u, true}, Pull::down},
                                             {{"probe", "gpiochip1", 1u}, Pull::none}};
    {
        const auto opened = open_gpiod_inputs(requests);
        REQUIRE_MESSAGE(opened.ok(), opened.error().message);
        InputLines& inputs = **opened;
        FakeLine &a = board().chips[0].lines[6], &b = board().chips[0].lines[7];
        CHECK(a.pull == Pull::up);
        CHECK(b.pull == Pull::down);
        CHECK(board().chips[1].lines[1].pull == Pull::none);
        CHECK_FALSE(a.output);
        CHECK(*inputs.read() == 0b010);
        CHECK_FALSE(*inputs.wait_ns(0));
        tests::FakeBoard::turn(b, true, 3'000'000'123);
        tests::FakeBoard::turn(a, true, 2'000'000'456);
        tests::FakeBoard::turn(a, false, 4'000'000'789);
        CHECK(*inputs.wait_ns(1'000));
        std::array<InputEdge, 8> edges{};
        REQUIRE(*inputs.collect(edges) == 3);
        CHECK(edges[0].time_ns == 2'000'000'456);
        CHECK(edges[0].line == 0);
        CHECK(edges[0].active);
        CHECK(edges[1].time_ns == 3'000'000'123);
        CHECK(edges[1].line == 1);
        CHECK_FALSE(edges[1].active);
        CHECK(edges[2].time_ns == 4'000'000'789);
        CHECK_FALSE(edges[2].active);
        CHECK(*inputs.collect(edges) == 0);
        CHECK(*inputs.read() == 0b000);
        board().fails = true;
        board().failing = Call::read;
        CHECK(mentions(inputs.read().error().message, "x.endstop"));
    }
    CHECK(board().requests == 0);
    CHECK(board().opened == 0);
}

TEST_CASE("inputs 5: edges that nobody collected in time are a failure, not a wrong count") {
    set_up_board();
    const std::vector<InputRequest> requests{{{"x.endstop", "gpiochip0", 6u}, Pull::up}};
    const auto inputs = open_gpiod_inputs(requests);
    REQUIRE(inputs.ok());
    for (int i = 0; i < 20; ++i)
        tests::FakeBoard::turn(board().chips[0].lines[6], i % 2 == 0, 1'000 * i);
    std::array<InputEdge, 64> edges{};
    const auto collected = (*inputs)->collect(edges);
    REQUIRE_FALSE(collected.ok());
    CHECK(mentions(collected.error().message, "x.endstop"));
}

TEST_CASE("inputs 5: a button that bounced for long ended the print") {
    set_up_board();
    const std::vector<InputRequest> requests{{{"stop", "gpiochip0", 6u, true}, Pull::up, true}};
    const auto inputs = open_gpiod_inputs(requests);
    REQUIRE(inputs.ok());
    for (const bool level : {true, false}) {
        for (int i = 0; i < 21; ++i)
            tests::FakeBoard::turn(board().chips[0].lines[6], (i % 2 == 0) == level, 1'000 * i);
        std::array<InputEdge, 64> edges{};
        const auto collected = (*inputs)->collect(edges);
        REQUIRE(collected.ok());
        REQUIRE(*collected == 16);
        CHECK(edges[15].active == !level);
        // What is left in the queue goes on from there.
        const auto rest = (*inputs)->collect(edges);
        REQUIRE(rest.ok());
        if (*rest > 0) CHECK(edges[*rest - 1].active == !level);
    }
}

TEST_CASE("gpiod inputs 3: a line is not watched twice, nor beside its use as an output") {
    set_up_board();
    const InputRequest stop{{"stop", "gpiochip0", 6u}, Pull::up};
    const auto twice = open_gpiod_inputs(std::vector{stop, stop});
    REQUIRE_FALSE(twice.ok());
    CHECK(mentions(twice.error().message, "already held"));
    CHECK(board().requests == 0);
    const auto output = open_gpiod_chip(std::vector<LineRequest>{{"fan", "gpiochip0", 6u}});
    REQUIRE(output.ok());
    CHECK_FALSE(open_gpiod_inputs(std::vector{stop}).ok());
    CHECK(board().requests == 1);
}
