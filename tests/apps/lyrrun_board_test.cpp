// lyrrun's looks at the board, and what a print takes of it, from the outside.

#include "apps/program.h"
#include "target/run/print_files.h"

using namespace lyr;
using namespace lyr::tests;

namespace {

// Its shadow memory counts, too.
#ifdef __SANITIZE_ADDRESS__
constexpr bool is_sanitized = true;
#else
constexpr bool is_sanitized = false;
#endif

Folder with_cartesian() {
    Folder folder("board");
    folder.copy("printers/cartesian.toml", "p.toml");
    return folder;
}

}  // namespace

TEST_CASE("lyrrun --check: a board without the printer's lines fails, in words and in JSON") {
    const Folder folder = with_cartesian();
    const Ended words = folder.run(
        "sed -i s/pinctrl-bcm2835/no-such-chip/ p.toml\n"
        "lyrrun --check --printer p.toml");
    CHECK(words.status == 7);
    CHECK(words.out.find("error    axis.x.step: cannot open GPIO chip no-such-chip") !=
          std::string::npos);
    CHECK(words.out.find(" errors, ") != std::string::npos);
    CHECK(lines_in(words.err) == 1);
    const Ended json = folder.run("lyrrun --check --json --printer p.toml");
    CHECK(json.status == 7);
    CHECK(json.out.starts_with(R"({"printer":"cartesian on a Raspberry Pi","errors":)"));
    CHECK(lines_in(json.out) == 1);
}

TEST_CASE("lyrrun --off: takes the lines, or says which one it cannot have") {
    const Folder folder = with_cartesian();
    check_failure(folder.run("sed -i s/pinctrl-bcm2835/no-such-chip/ p.toml\n"
                             "lyrrun --off --printer p.toml"),
                  "lyrrun", 7, "axis.x.step: cannot open GPIO chip no-such-chip");
}

TEST_CASE("lyrrun --measure-latency: what it prints is a section that the printer's file takes") {
    const Folder folder = with_cartesian();
    const Ended measured = folder.run(
        "lyrrun --measure-latency --seconds 0.3 --printer p.toml >> p.toml &&\n"
        "lyrrun --measure-latency --seconds 0.1 --printer p.toml >> p.toml &&\n"
        "lyrrun --measure-latency --seconds 0.1 --printer p.toml");
    CHECK(measured.status == 0);
    CHECK(measured.err.find("the printer's file has a [timing] already") != std::string::npos);
    CHECK(measured.out.find("\n# late_us = ") != std::string::npos);
    CHECK(text_of(folder / "p.toml").find("\n[timing]\nlate_us = ") != std::string::npos);
    CHECK(text_of(folder / "p.toml").find("# Timing of the board of \"cartesian") !=
          std::string::npos);
}

TEST_CASE("lyrrun: a board that is late is planned slower") {
    const Folder folder("late");
    const std::string file = write_print("late", std::vector<Drawing>(3, draw_square));
    const auto simulated_with = [&](const std::string& timing) {
        folder.write("p.toml", text_of(fs::path(LYR_FIXTURES) / "printers/generic.toml") + timing);
        const Ended ended =
            folder.run("lyrrun '" + file + "' --simulate --no-heat --json --printer p.toml");
        CHECK(ended.status == 0);
        CHECK((ended.out.find("axis.x is planned at 12.5 mm/s at the most, not 300") !=
               std::string::npos) == !timing.empty());
        const std::string key = "\"print_time_s\":";
        const std::size_t at = ended.out.find(key);
        REQUIRE(at != std::string::npos);
        return std::stod(ended.out.substr(at + key.size()));
    };
    // 1,000 steps a second are 12.5 mm/s.
    CHECK(simulated_with("[timing]\nlate_us = 968\n") > 1.5 * simulated_with(""));
}

TEST_CASE("lyrrun --check, --measure-latency: what makes no sense together is refused") {
    const Folder folder = with_cartesian();
    for (const char* options :
         {"--check --measure-latency", "--check --lines", "--lines", "--check --simulate",
          "--measure-latency --json", "--check part.lyr", "--check --tune tool=200",
          "--measure-latency --home", "--measure-latency --seconds 0", "--off --check",
          "--off part.lyr", "--off --simulate", "--check --seconds 5", "--off --seconds 5",
          "part.lyr --simulate --seconds 5", "--lines --seconds 5"}) {
        CAPTURE(options);
        const Ended ended = folder.run(std::string("lyrrun --printer p.toml ") + options);
        CHECK(ended.status == 2);
        CHECK(lines_in(ended.err) == 1);
    }
    for (const char* option : {"--check", "--measure-latency", "--off"})
        check_failure(folder.run(std::string("lyrrun ") + option), "lyrrun", 2,
                      std::string(option) + " needs --printer FILE");
}

TEST_CASE("lyrrun: a print takes at most 8 MB of memory, however long it is" *
          doctest::skip(is_sanitized)) {
    const Folder folder("memory");
    const std::string file = write_print("memory", std::vector<Drawing>(400, draw_square));
    const Ended ended = folder.run(
        "lyrrun '" + file +
        "' --simulate --no-heat >/dev/null & p=$!\n"
        "while grep VmHWM /proc/$p/status >now 2>/dev/null && [ -s now ]; do mv now most; done\n"
        "wait $p && cat most");
    CHECK(ended.status == 0);
    const std::size_t number = ended.out.find_first_of("0123456789");
    REQUIRE(number != std::string::npos);
    const int most_kb = std::stoi(ended.out.substr(number));
    CHECK(most_kb > 1'000);
    CHECK(most_kb < 8'000);
}

TEST_CASE("lyrrun: a limit on locked memory that let the program in let no thread start") {
    const Folder folder("locked");
    fs::copy_file(write_print("locked", {draw_small}), folder / "a.lyr");
    constexpr int may_not = 77;
    const Ended printed = folder.run(
        "without=\n"
        "if [ $(id -u) = 0 ]; then without='setpriv --bounding-set -ipc_lock'; fi\n"
        "$without true || exit 77\n"
        "for limit in 7000 7500 8000 8192; do\n"
        "    (ulimit -l $limit && $without lyrrun a.lyr --dry-run --no-heat) || exit\n"
        "done");
    if (printed.status == may_not)
        MESSAGE("not run: nobody may give up a privilege here");
    else
        CHECK_MESSAGE(printed.status == 0, printed.err);
}
