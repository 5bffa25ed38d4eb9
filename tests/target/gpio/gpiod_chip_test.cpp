// Contract of target/gpio/gpiod_chip.h, by number. What needs lines of a kernel runs on gpio-sim or
// gpio-mockup where there is one, and says so where there is none.

#include "target/gpio/gpiod_chip.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <vector>

using namespace lyr;
using namespace lyr::gpio;

namespace {

bool mentions(const Diagnostic& diagnostic, const std::string& text) {
    return diagnostic.message.find(text) != std::string::npos;
}

// The first simulated chip of this kernel: never a real one, whose lines may drive something.
std::optional<std::string> simulated_chip() {
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator("/sys/bus/gpio/devices", none)) {
        const std::string target = std::filesystem::read_symlink(entry.path(), none).string();
        if (target.find("gpio-sim") != std::string::npos ||
            target.find("gpio-mockup") != std::string::npos)
            return entry.path().filename().string();
    }
    return std::nullopt;
}

// Level of a simulated line as the kernel sees it, or none where it does not tell.
std::optional<int> kernel_level(const std::string& chip, unsigned line) {
    const std::filesystem::path device = std::filesystem::path("/sys/bus/gpio/devices") / chip;
    std::error_code none;
    const auto root = std::filesystem::canonical(device, none).parent_path();
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root, none)) {
        const std::string path = entry.path().string();
        if (path.ends_with("/sim_gpio" + std::to_string(line) + "/value")) {
            int level = -1;
            std::ifstream(path) >> level;
            return level;
        }
    }
    std::ifstream mockup("/sys/kernel/debug/gpio-mockup/" + chip + '/' + std::to_string(line));
    int level = -1;
    if (mockup >> level) return level;
    return std::nullopt;
}

}  // namespace

TEST_CASE("gpiod 2: a chip that is not there is named, with its purpose and what to do") {
    for (const char* chip :
         {"gpiochip987", "/dev/gpiochip987", "no-such-label", "987", "", "/dev/null"}) {
        const std::vector<LineRequest> requests{{"x.step", chip, 17u, false}};
        const auto opened = open_gpiod_chip(requests);
        REQUIRE_FALSE(opened.ok());
        CHECK(opened.error().status == ExitStatus::machine);
        CHECK(mentions(opened.error(), "x.step"));
        CHECK(mentions(opened.error(), chip));
        CHECK(mentions(opened.error(), "gpiodetect"));
    }
}

TEST_CASE("gpiod 2: an empty chip name does not stand for chip number 0") {
    const auto opened = open_gpiod_chip(std::vector<LineRequest>{{"x.step", "", 0u, false}});
    REQUIRE_FALSE(opened.ok());
    CHECK(mentions(opened.error(), "gpiodetect"));
}

TEST_CASE("gpiod 3: no lines and too many lines are refused before a chip is opened") {
    CHECK_FALSE(open_gpiod_chip({}).ok());
    const std::vector<LineRequest> many(65, LineRequest{"x.step", "gpiochip0", 1u, false});
    const auto opened = open_gpiod_chip(many);
    REQUIRE_FALSE(opened.ok());
    CHECK(mentions(opened.error(), "65"));
}

TEST_CASE("gpiod 1, 2, 4 and chip 1-6 on a kernel's lines") {
    const std::optional<std::string> chip = simulated_chip();
    if (!chip) {
        MESSAGE("SKIPPED: this kernel offers neither gpio-sim nor gpio-mockup");
        return;
    }
    SUBCASE("levels arrive, and active-low lines are inverted") {
        const std::vector<LineRequest> requests{{"a", *chip, 0u, false}, {"b", *chip, 1u, true}};
        {
            auto opened = open_gpiod_chip(requests);
            REQUIRE_MESSAGE(opened.ok(), opened.error().message);
            const std::optional<int> inactive = kernel_level(*chip, 1);
            if (!inactive)
                MESSAGE("SKIPPED: this kernel does not tell the levels of simulated lines");
            if (inactive) CHECK(*inactive == 1);
            for (const unsigned levels : {0b00u, 0b01u, 0b10u, 0b11u}) {
                REQUIRE((*opened)->write(0b11, levels).ok());
                if (const auto a = kernel_level(*chip, 0)) CHECK(*a == int(levels & 1));
                if (const auto b = kernel_level(*chip, 1)) CHECK(*b == int(!(levels & 2)));
            }
            REQUIRE((*opened)->write(0b01, 0b00).ok());
            if (const auto b = kernel_level(*chip, 1)) CHECK(*b == 0);
            CHECK((*opened)->release().ok());
            CHECK_FALSE((*opened)->write(0b01, 0b01).ok());
        }
        CHECK(open_gpiod_chip(requests).ok());
    }
    SUBCASE("a held line, a doubled line and a missing line are refused by name") {
        const std::vector<LineRequest> one{{"x.step", *chip, 0u, false}};
        const auto holder = open_gpiod_chip(one);
        REQUIRE(holder.ok());
        const auto held = open_gpiod_chip(one);
        REQUIRE_FALSE(held.ok());
        CHECK(mentions(held.error(), "already held by lyrrun"));
        const std::vector<LineRequest> twice{{"y.step", *chip, 2u, false},
                                             {"y.dir", *chip, 2u, false}};
        const auto doubled = open_gpiod_chip(twice);
        REQUIRE_FALSE(doubled.ok());
        CHECK(mentions(doubled.error(), "already used for y.step"));
        const auto missing =
            open_gpiod_chip(std::vector<LineRequest>{{"z.step", *chip, 9999u, false}});
        REQUIRE_FALSE(missing.ok());
        CHECK(mentions(missing.error(), "does not exist"));
        const auto unnamed =
            open_gpiod_chip(std::vector<LineRequest>{{"z.step", *chip, "NOT-A-LINE", false}});
        REQUIRE_FALSE(unnamed.ok());
        CHECK(mentions(unnamed.error(), "NOT-A-LINE"));
    }
}
