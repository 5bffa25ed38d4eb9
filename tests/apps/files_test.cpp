#include "apps/files.h"

#include <termios.h>

#include <array>

#include "apps/program.h"
#include "apps/progress_line.h"

using namespace lyr;
using namespace lyr::command_line;
using namespace lyr::tests;

TEST_CASE("files: each pair is told apart, whichever the two are") {
    const Folder folder("files");
    folder.write("a", "");
    folder.write("b", "");
    const std::string a = folder / "a", b = folder / "b", c = folder / "c";
    CHECK(check_apart({{"one", a}, {"two", b}}, {{"three", c}}));
    CHECK(check_apart({{"one", a}, {"two", a}}, {{"three", c}}));  // read twice
    CHECK(check_apart({{"one", ""}}, {{"two", ""}, {"three", ""}}));
    for (const auto& outputs : {std::vector<NamedFile>{{"x", a}},
                                {{"x", b}},
                                {{"x", c}, {"y", a}},
                                {{"x", c}, {"y", c}}}) {
        const Status apart = check_apart({{"one", a}, {"two", b}}, outputs);
        REQUIRE(!apart);
        CHECK(apart.error().status == ExitStatus::usage);
    }
}

TEST_CASE("files: a stream is read once") {
    const Folder folder("files-streams");
    folder.make_pipe("pipe");
    const std::string pipe = folder / "pipe";
    CHECK_FALSE(check_apart({{"one", "-"}, {"two", "-"}}, {}));
    CHECK_FALSE(check_apart({{"one", pipe}, {"two", pipe}}, {}));
    CHECK_FALSE(check_apart({{"one", pipe}}, {{"two", pipe}}));
    CHECK(check_apart({{"one", "/dev/null"}, {"two", "/dev/null"}}, {{"three", "/dev/null"}}));
}

TEST_CASE("files: a terminal may be read and written, but not by two outputs") {
    const int controller = ::posix_openpt(O_RDWR | O_NOCTTY);
    if (controller < 0) return;  // a system without pseudo-terminals
    REQUIRE(::grantpt(controller) == 0);
    REQUIRE(::unlockpt(controller) == 0);
    const std::string terminal = ::ptsname(controller);
    CHECK(check_apart({{"heights", terminal}}, {{"report", terminal}}));
    CHECK_FALSE(check_apart({}, {{"print", terminal}, {"report", terminal}}));
    ::close(controller);
}

TEST_CASE("progress line 1: a terminal that was stopped held the print up") {
    const int controller = ::posix_openpt(O_RDWR | O_NOCTTY);
    if (controller < 0) return;
    REQUIRE(::grantpt(controller) == 0);
    REQUIRE(::unlockpt(controller) == 0);
    const int terminal = ::open(::ptsname(controller), O_RDWR | O_NOCTTY);
    REQUIRE(terminal >= 0);
    for (const bool stops : {false, true}) {
        CAPTURE(stops);
        if (stops) REQUIRE(::tcflow(terminal, TCOOFF) == 0);
        const pid_t shows = ::fork();
        if (shows == 0) {
            // One that waits is ended by the alarm.
            ::signal(SIGALRM, SIG_DFL);
            ::alarm(5);
            ::dup2(terminal, STDERR_FILENO);
            ProgressLine line;
            line.show("layer 1 of 2");
            ::_exit(0);
        }
        int status = -1;
        ::waitpid(shows, &status, 0);
        CHECK(status == 0);
        if (stops) continue;
        std::array<char, 64> shown{};
        CHECK(::read(controller, shown.data(), shown.size()) > 0);
        CHECK(std::string(shown.data()).find("layer 1 of 2") != std::string::npos);
    }
    ::close(terminal);
    ::close(controller);
}
