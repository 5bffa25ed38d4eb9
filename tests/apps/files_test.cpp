#include "apps/files.h"

#include "apps/program.h"

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
