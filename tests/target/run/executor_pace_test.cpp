// What target/run/executor.h (5, 9) says of the pace of time: how it falls, how low, and how it rises again.

#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include "target/gpio/mock_chip.h"
#include "target/run/executor.h"

using namespace lyr;
using namespace lyr::run;

namespace {

constexpr std::int64_t high_ns = 2'000, late_limit_ns = 10'000'000;

// Steps of one motor that are evenly apart, and a pace that is another one from some step on.
struct Paced {
    std::int64_t apart_ns, braking_ns;
    gpio::VirtualClock clock{};
    StopRequests stop{0};
    WantedPace pace{1};
    std::vector<std::int64_t> rises_ns{};
    std::function<void(std::size_t steps)> at_step{};
    bool was_high = false;
    gpio::MockChip chip{8, clock, [this](const gpio::LineWrite& write) {
                            const bool is_high = (write.levels & step_bit(0)) != 0;
                            if (std::exchange(was_high, is_high) || !is_high) return;
                            rises_ns.push_back(write.time_ns);
                            if (at_step) at_step(rises_ns.size());
                        }};
    Executor executor{chip, clock, {high_ns, late_limit_ns, braking_ns}, stop, nullptr, &pace};
    std::vector<LineEvent> events{};

    Paced(std::int64_t apart, std::int64_t braking, int steps)
        : apart_ns(apart), braking_ns(braking) {
        for (int i = 0; i < steps; ++i) {
            events.push_back({i * apart_ns, step_bit(0)});
            events.push_back({i * apart_ns + high_ns, 0});
        }
    }
    // True: all is written.
    bool go_on() {
        const Result<bool> done = executor.execute(events);
        REQUIRE(done.ok());
        events.erase(events.begin(),
                     events.begin() + static_cast<std::ptrdiff_t>(executor.taken()));
        return *done;
    }
    // Between neighbouring steps from one on.
    std::vector<std::int64_t> gaps_ns(std::size_t from = 0) const {
        std::vector<std::int64_t> gaps;
        for (std::size_t i = from + 1; i < rises_ns.size(); ++i)
            gaps.push_back(rises_ns[i] - rises_ns[i - 1]);
        return gaps;
    }
};

}  // namespace

TEST_CASE("executor 9: a pace that is wanted again before the head rests hurries no step") {
    // A step takes longer than all of the braking: at its end the pace is as low as it gets.
    Paced print(15'000'000, 10'000'000, 30);
    print.at_step = [&](std::size_t steps) { print.pace = steps == 10 ? 0 : 1; };
    CHECK(print.go_on());
    const auto gaps_ns = print.gaps_ns();
    CHECK(*std::min_element(gaps_ns.begin(), gaps_ns.end()) == print.apart_ns);
}

TEST_CASE("executor 9: a lower pace is come down to, and not gone below") {
    Paced print(1'000'000, 20'000'000, 200);
    print.at_step = [&](std::size_t steps) { print.pace = steps < 20 ? 1.0F : 0.5F; };
    CHECK(print.go_on());
    const auto gaps_ns = print.gaps_ns();
    CHECK(*std::max_element(gaps_ns.begin(), gaps_ns.end()) == 2 * print.apart_ns);
    CHECK(std::is_sorted(gaps_ns.begin(), gaps_ns.end()));
}

TEST_CASE("executor 9: from a rest the head gains speed as it lost it") {
    Paced print(20'000, 60'000'000, 20'000);
    print.at_step = [&](std::size_t steps) {
        if (steps == 5'000) print.pace = 0;
    };
    CHECK_FALSE(print.go_on());
    const std::size_t rested_at = print.rises_ns.size();
    const std::int64_t braked_ns = print.rises_ns.back() - print.rises_ns[5'000];
    print.pace = 1;
    print.executor.go_on();
    CHECK(print.go_on());
    const auto gaps_ns = print.gaps_ns(rested_at);
    CHECK(gaps_ns.front() > 10 * print.apart_ns);
    CHECK(std::is_sorted(gaps_ns.rbegin(), gaps_ns.rend()));
    CHECK(gaps_ns.back() == print.apart_ns);
    const auto slower = std::count_if(gaps_ns.begin(), gaps_ns.end(),
                                      [&](std::int64_t gap_ns) { return gap_ns > print.apart_ns; });
    const std::int64_t gained_ns =
        print.rises_ns[rested_at + static_cast<std::size_t>(slower)] - print.rises_ns[rested_at];
    CHECK(std::abs(gained_ns - braked_ns) < braked_ns / 10);
}

TEST_CASE("executor 5, 9: where steps are so far apart that the head stands, it makes no more") {
    for (const bool is_stop : {false, true}) {
        Paced print(30'000'000, 200'000'000, 20);
        print.at_step = [&](std::size_t steps) {
            if (steps < 5) return;
            if (is_stop)
                print.stop = 1;
            else
                print.pace = 0;
        };
        CHECK_FALSE(print.go_on());
        CHECK(print.rises_ns.size() == 5);
    }
}
