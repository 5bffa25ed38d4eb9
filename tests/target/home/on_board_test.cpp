// Contracts of target/home/job.h, filament.h and beside.h on a board without a kernel (target/gpio/fake_board.h). What
// changes the process is done in one of its own.

#include <doctest/doctest.h>
#include <pthread.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <system_error>

#include "target/gpio/fake_board.h"
#include "target/home/filament.h"
#include "target/home/job.h"

using namespace lyr;
using namespace lyr::home;
using namespace lyr::tests;

namespace {

config::Printer printer_on_board() {
    board() = {};
    board().chips.push_back({"gpiochip0", "test", std::vector<FakeLine>(28)});
    config::Printer printer = config::generic_printer();
    std::uint32_t line = 2;
    for (config::Axis& axis : printer.axes) {
        axis.step = config::Pin{"gpiochip0", line++};
        axis.direction = config::Pin{"gpiochip0", line++};
    }
    for (auto& heater : printer.heaters) heater.reset();
    printer.part_fan.reset();
    printer.pulse.late_limit_ns = 10'000'000'000;  // the machine of a test may be busy
    return printer;
}

bool holds_in_child(const std::function<bool()>& claim) {
    const pid_t child = ::fork();
    if (child == 0) {
        try {
            ::_exit(claim() ? 0 : 1);
        } catch (...) {
            ::_exit(1);
        }
    }
    int status = -1;
    return ::waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

// As a user without privileges.
bool give_up_precedence() {
    constexpr rlimit none{0, 0};
    constexpr uid_t nobody = 65'534;
    return ::setrlimit(RLIMIT_RTPRIO, &none) == 0 && ::setrlimit(RLIMIT_MEMLOCK, &none) == 0 &&
           (::getuid() != 0 || ::setuid(nobody) == 0);
}

bool tells_refusal(const Diagnostics& warnings) {
    return std::any_of(warnings.begin(), warnings.end(), [](const Diagnostic& warning) {
        return warning.message.starts_with("real-time scheduling was refused");
    });
}

#if !defined __SANITIZE_ADDRESS__ && !defined __SANITIZE_THREAD__
// Of the threads that are started from here on, one has room, and none beside it.
bool leave_room_for_one_thread() {
    constexpr std::size_t stack_bytes = std::size_t{256} << 20;
    pthread_attr_t attributes;
    ::pthread_attr_init(&attributes);
    ::pthread_attr_setstacksize(&attributes, stack_bytes);
    ::pthread_setattr_default_np(&attributes);
    std::size_t used_pages = 0;
    std::ifstream("/proc/self/statm") >> used_pages;
    const rlim_t most =
        used_pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) + stack_bytes * 7 / 4;
    const rlimit room{most, most};
    return ::setrlimit(RLIMIT_AS, &room) == 0;
}
#endif

}  // namespace

TEST_CASE("job 5: a jog that the kernel refuses real time warns of it, as a print does") {
    const Job job{printer_on_board()};
    CHECK(holds_in_child([&] {
        if (!give_up_precedence()) return false;
        const auto report = home::home(job, {}, motion::Point{1, 0, 0});
        return report.ok() && tells_refusal(report->warnings);
    }));
}

TEST_CASE("filament 4: a push of filament that the kernel refuses real time warns of it") {
    const Job job{printer_on_board()};
    CHECK(holds_in_child([&] {
        if (!give_up_precedence()) return false;
        const auto fed = feed(job, 1, std::nullopt);
        return fed.ok() && tells_refusal(fed->warnings);
    }));
}

TEST_CASE("filament 2: more filament than is planned in little memory and time is refused") {
    Job job{printer_on_board()};
    for (const double feed_mm : {1'000.5, -10'000.0}) {
        const auto fed = feed(job, feed_mm, std::nullopt);
        REQUIRE_FALSE(fed.ok());
        CHECK(fed.error().status == ExitStatus::machine);
        CHECK(fed.error().message.find("1000 mm at the most") != std::string::npos);
    }
    CHECK(board().opened == 0);
    job.simulate = true;
    CHECK(feed(job, 1'000, std::nullopt)->steps > 0);
}

#if !defined __SANITIZE_ADDRESS__ && !defined __SANITIZE_THREAD__
TEST_CASE("beside 2: where the second thread cannot be had, all ends and the lines are released") {
    const Job job{printer_on_board()};
    CHECK(holds_in_child([&] {
        if (!leave_room_for_one_thread()) return false;
        try {
            (void)home::home(job, {}, motion::Point{20, 0, 0});
        } catch (const std::system_error&) {
            return board().requests == 0 && board().opened == 0;
        }
        return false;
    }));
}
#endif
