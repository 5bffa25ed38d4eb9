// Contract of target/run/real_time.h, by number, and of timing.cpu in a print.

#include "target/run/real_time.h"

#include <doctest/doctest.h>
#include <sched.h>

#include <bitset>

#include "target/gpio/mock_chip.h"
#include "target/run/patient_printer.h"
#include "target/run/print.h"
#include "target/run/print_files.h"

using namespace lyr;
using namespace lyr::run;
using namespace lyr::tests;

namespace {

constexpr unsigned no_such_cpu = 1'023;

// The last processor that this program may run on.
unsigned last_cpu() {
    cpu_set_t allowed;
    REQUIRE(::sched_getaffinity(0, sizeof allowed, &allowed) == 0);
    unsigned last = 0;
    for (unsigned cpu = 0; cpu < CPU_SETSIZE; ++cpu)
        if (CPU_ISSET(cpu, &allowed)) last = cpu;
    return last;
}

// Lines that note from which processors they are written.
class WatchedChip final : public gpio::GpioChip {
public:
    std::size_t line_count() const override { return 8; }
    Status write(gpio::LineMask, gpio::LineMask) override {
        used.set(static_cast<std::size_t>(::sched_getcpu()));
        return Done{};
    }
    Status release() override { return Done{}; }
    std::bitset<CPU_SETSIZE> used;
};

PrintJob job_on(unsigned cpu) {
    const Drawing draw = [](const Pen& pen) {
        pen.path(80);
        pen.travel(0, 0);
        pen.line(4, 0);
        pen.line(4, 4);
    };
    PrintJob job{write_print("real_time", {draw}), patient_printer(), true, {}};
    job.printer.timing.cpu = cpu;
    return job;
}

}  // namespace

TEST_CASE("real time 2: the thread that writes the lines ran on any processor") {
    for (unsigned cpu = 0; cpu <= last_cpu(); ++cpu) {
        if (!check_cpu(cpu)) continue;
        CAPTURE(cpu);
        WatchedChip chip;
        gpio::MonotonicClock clock;
        const Result<PrintReport> report = print(job_on(cpu), chip, clock);
        REQUIRE_MESSAGE(report.ok(), report.error().message);
        CHECK(chip.used.count() == 1);
        CHECK(chip.used.test(cpu));
        CHECK(text_of(*report).find("on processor " + std::to_string(cpu)) != std::string::npos);
        if (cpu == 1) break;  // two are enough
    }
}

TEST_CASE("real time 2: a processor that the board lacks is refused before a line is touched") {
    CHECK(check_cpu(std::nullopt).ok());
    CHECK(check_cpu(last_cpu()).ok());
    WatchedChip chip;
    gpio::MonotonicClock clock;
    const Result<PrintReport> report = print(job_on(no_such_cpu), chip, clock);
    REQUIRE_FALSE(report.ok());
    CHECK(report.error().status == ExitStatus::machine);
    CHECK(report.error().message.starts_with("timing.cpu = 1023: "));
    CHECK(chip.used.none());
    Diagnostics warnings;
    try_precedence(no_such_cpu, warnings);
    REQUIRE_FALSE(warnings.empty());
    CHECK(warnings.front().severity == Severity::warning);
}
