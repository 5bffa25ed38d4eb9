// Contract of target/board/latency.h, by number, on a clock that is late as told.

#include "target/board/latency.h"

#include <doctest/doctest.h>
#include <sys/resource.h>

#include <algorithm>
#include <bit>
#include <random>

#include "target/gpio/mock_chip.h"

using namespace lyr;
using namespace lyr::board;

namespace {

LatencyJob job_of(double seconds) {
    return {config::generic_printer(), seconds, false};
}

}  // namespace

TEST_CASE("latency 1: one wait in 10,000 is later than what is rare, and none than the worst") {
    Times times;
    CHECK(times.spread().count == 0);
    CHECK(times.spread().worst_ns == 0);
    for (std::int64_t i = 20'000; i > 0; --i) times.add(i);
    const Spread spread = times.spread();
    CHECK(spread.count == 20'000);
    CHECK(spread.median_ns == 10'001);
    CHECK(spread.rare_ns >= 19'998);
    CHECK(spread.rare_ns <= 20'000);
    CHECK(spread.worst_ns == 20'000);
    Times few;
    for (const std::int64_t time_ns : {3, 1, 2}) few.add(time_ns);
    CHECK(few.spread().rare_ns == 3);
    CHECK(few.spread().median_ns == 2);
}

TEST_CASE("latency 1: figures are those of the sorted times, from nanoseconds to minutes") {
    std::mt19937_64 random(1);
    for (const double longest_ns : {50.0, 8e3, 1e5, 4e7, 1e12}) {
        Times times;
        std::vector<std::int64_t> all;
        for (int i = 0; i < 50'000; ++i) {
            const double share = std::uniform_real_distribution<>(0, 1)(random);
            all.push_back(static_cast<std::int64_t>(longest_ns * share * share * share));
            times.add(all.back());
        }
        std::sort(all.begin(), all.end());
        const Spread spread = times.spread();
        const auto fits = [](std::int64_t told_ns, std::int64_t exact_ns) {
            return told_ns >= exact_ns && told_ns - exact_ns <= exact_ns / 4096;
        };
        CHECK(fits(spread.median_ns, all[all.size() / 2]));
        CHECK(fits(spread.rare_ns, all[all.size() - 6]));
        CHECK(spread.worst_ns == all.back());
        std::vector<std::uint64_t> buckets, exact;
        times.add_to(buckets);
        for (const std::int64_t time_ns : all) {
            const auto bucket = static_cast<std::size_t>(
                std::bit_width(static_cast<std::uint64_t>(time_ns / 1'000)));
            if (bucket >= exact.size()) exact.resize(bucket + 1);
            ++exact[bucket];
        }
        CHECK(buckets == exact);
    }
}

TEST_CASE("latency 6: an hour of waits needs no more memory than a second, which was 290 MB") {
    // Only what is held at most tells: a bucket for each wait would show in it.
    const auto most_kb = [] {
        rusage used{};
        ::getrusage(RUSAGE_SELF, &used);
        return used.ru_maxrss;
    };
    gpio::VirtualClock clock([](std::int64_t) { return 3'000; });
    REQUIRE(measure_latency(job_of(1), clock, nullptr).ok());
    const long before_kb = most_kb();
    const auto report = measure_latency(job_of(400), clock, nullptr);
    REQUIRE(report.ok());
    CHECK(report->awake.count > 3'000'000);
    CHECK(most_kb() - before_kb < 8'000);
}

TEST_CASE("latency 1, 3: both kinds of wait are measured, and the keys are those of the later") {
    std::uint64_t waits = 0;
    // Every 5,000th is 200 us late, the others 3 us.
    gpio::VirtualClock clock([&](std::int64_t) { return ++waits % 5'000 ? 3'000 : 200'000; });
    const auto report = measure_latency(job_of(20), clock, nullptr);
    REQUIRE(report.ok());
    CHECK(report->asleep.count + report->awake.count == waits);
    CHECK(report->asleep.count == doctest::Approx(10'000).epsilon(0.02));
    CHECK(report->awake.count == doctest::Approx(200'000).epsilon(0.1));
    CHECK(report->awake.median_ns == 3'000);
    CHECK(report->awake.rare_ns == 200'000);
    CHECK_FALSE(report->write);
    std::uint64_t counted = 0;
    for (const std::uint64_t bucket : report->histogram) counted += bucket;
    CHECK(counted == waits);
    // 200 us, and eight edges of 2 us that are 2 us apart.
    CHECK(report->steps_per_s == doctest::Approx(1e9 / 232'000));
}

TEST_CASE("latency 2: lines are written, inactive as they were, and the write is timed") {
    gpio::VirtualClock clock;
    std::uint64_t writes = 0, active = 0;
    gpio::MockChip chip(8, clock, [&](const gpio::LineWrite& write) {
        active += write.levels != 0;
        clock.advance_ns(++writes % 1'000 ? 1'500 : 9'000);
    });
    const auto report = measure_latency(job_of(2), clock, &chip);
    REQUIRE(report.ok());
    REQUIRE(report->write);
    CHECK(active == 0);
    CHECK(writes == report->write->count);
    CHECK(report->write->median_ns == 1'500);
    CHECK(report->write->rare_ns == 9'000);
    CHECK(report->write->worst_ns == 9'000);
}

TEST_CASE("latency 2: a write that fails ends the measurement") {
    gpio::VirtualClock clock;
    gpio::MockChip chip(8, clock, {}, [](std::uint64_t number) -> std::optional<Diagnostic> {
        if (number != 3) return std::nullopt;
        return Diagnostic{Severity::error, ExitStatus::machine, "bus error", {}};
    });
    const auto report = measure_latency(job_of(2), clock, &chip);
    REQUIRE_FALSE(report.ok());
    CHECK(report.error().message == "bus error");
}

TEST_CASE("latency 4: a wait that would have ended a print is told") {
    std::int64_t waits = 0;
    gpio::VirtualClock clock([&](std::int64_t) { return ++waits == 500 ? 5'000'001 : 3'000; });
    LatencyJob job = job_of(2);
    job.printer.pulse.late_limit_ns = 5'000'000;
    const auto report = measure_latency(job, clock, nullptr);
    REQUIRE(report.ok());
    REQUIRE(report->warnings.size() == 1);
    CHECK(report->warnings[0].message.find("pulse.late_limit_ms is 5.000") != std::string::npos);
    job.printer.pulse.late_limit_ns = 5'000'001;
    waits = 0;
    CHECK(measure_latency(job, clock, nullptr)->warnings.empty());
}

TEST_CASE("latency 5: what is told can be put into the printer's file as it is") {
    gpio::VirtualClock clock([](std::int64_t) { return 12'300; });
    gpio::MockChip chip(8, clock, [&](const gpio::LineWrite&) { clock.advance_ns(4'500); });
    const auto report = measure_latency(job_of(1), clock, &chip);
    REQUIRE(report.ok());
    const std::string axis =
        "\nsteps_per_mm = 80\nmax_speed_mm_s = 100\nmax_acceleration_mm_s2 = 1000\n";
    std::string file = text_of(*report);
    for (const char* name : {"x", "y", "z"})
        file += std::string("[axis.") + name + "]\nrange_mm = [0, 200]" + axis;
    file += "[axis.e]" + axis;
    const auto printer = config::parse_printer(file, "printer.toml");
    REQUIRE_MESSAGE(printer.ok(), to_string(printer.error()));
    CHECK(printer->timing.late_ns == 12'300);
    CHECK(printer->timing.write_ns == 4'500);
    CHECK(config::held_steps_per_s(*printer) == doctest::Approx(report->steps_per_s));
}

TEST_CASE("latency 5: a second [timing] broke the printer's file") {
    const std::string axis =
        "\nsteps_per_mm = 80\nmax_speed_mm_s = 100\nmax_acceleration_mm_s2 = 1000\n";
    std::string file;
    for (const char* name : {"x", "y", "z"})
        file += std::string("[axis.") + name + "]\nrange_mm = [0, 200]" + axis;
    file += "[axis.e]" + axis + "[timing]\ncpu = 0\n";
    LatencyJob job = job_of(1);
    job.printer = *config::parse_printer(file, "printer.toml");
    gpio::VirtualClock clock([](std::int64_t) { return 12'300; });
    const auto report = measure_latency(job, clock, nullptr);
    REQUIRE(report.ok());
    REQUIRE(report->warnings.size() == 1);
    CHECK(report->warnings[0].severity == Severity::note);
    const std::string text = text_of(*report);
    CHECK(text.find("\n# late_us = 12.3\n") != std::string::npos);
    const auto printer = config::parse_printer(file + text, "printer.toml");
    REQUIRE_MESSAGE(printer.ok(), to_string(printer.error()));
    CHECK(printer->timing.cpu == 0);
    CHECK_FALSE(printer->timing.late_ns.has_value());
}

TEST_CASE("latency: a real measurement ends after the time asked for") {
    const auto report = measure_latency(job_of(0.2));
    REQUIRE(report.ok());
    CHECK(report->asleep.count > 10);
    CHECK(report->awake.count > 10);
    CHECK(report->asleep.worst_ns >= report->asleep.median_ns);
    CHECK(report->steps_per_s > 0);
}
