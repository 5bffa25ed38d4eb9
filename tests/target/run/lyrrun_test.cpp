// The program itself: what it prints where, and its exit status. docs/exit-status.md is its contract.

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

#include "target/run/print_files.h"

using namespace lyr;
using namespace lyr::tests;

namespace {

struct Ended {
    int status = -1;
    std::string out, err;
};

std::string text_of_file(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

Ended lyrrun(const std::string& arguments) {
    const std::string base = (std::filesystem::temp_directory_path() / "lyr_lyrrun").string();
    const std::string command = std::string(LYR_BUILD) + "/lyrrun " + arguments + " >" + base +
                                ".out 2>" + base + ".err </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of_file(base + ".out"),
            text_of_file(base + ".err")};
}

void check_failure(const Ended& ended, int status, const std::string& part) {
    CAPTURE(ended.err);
    CHECK(ended.status == status);
    CHECK(ended.out.empty());
    CHECK(ended.err.starts_with("lyrrun: "));
    CHECK(std::count(ended.err.begin(), ended.err.end(), '\n') == 1);
    CHECK(ended.err.find(part) != std::string::npos);
}

}  // namespace

TEST_CASE("lyrrun: a simulation reports on stdout and says nothing on a pipe's stderr") {
    const Ended ended = lyrrun(write_print("program", {draw_square, draw_arcs}) + " --simulate");
    CHECK(ended.status == 0);
    CHECK(ended.err.empty());
    CHECK(ended.out.find("within half a microstep everywhere") != std::string::npos);
    CHECK(ended.out.find("print time") != std::string::npos);
}

TEST_CASE("lyrrun: --json is one line of JSON") {
    const Ended ended = lyrrun(write_print("json", {draw_square}) + " --simulate --json");
    CHECK(ended.status == 0);
    CHECK(ended.out.starts_with("{\"file\":"));
    CHECK(std::count(ended.out.begin(), ended.out.end(), '\n') == 1);
    CHECK(std::count(ended.out.begin(), ended.out.end(), '{') ==
          std::count(ended.out.begin(), ended.out.end(), '}'));
}

TEST_CASE("lyrrun: help has examples and the exit status") {
    const Ended ended = lyrrun("--help");
    CHECK(ended.status == 0);
    CHECK(ended.out.find("Examples:") != std::string::npos);
    CHECK(ended.out.find("Exit status:") != std::string::npos);
}

TEST_CASE("lyrrun: what is wrong comes as one line and with its status") {
    const std::string good = write_print("good", {draw_square, draw_arcs, draw_hatch});
    check_failure(lyrrun("/nonexistent.lyr --simulate"), 3, "/nonexistent.lyr");
    check_failure(lyrrun(LYR_FIXTURES "/printers/generic.toml --simulate"), 3, "generic.toml");
    check_failure(lyrrun("/dev/null --simulate"), 3, "/dev/null");
    check_failure(lyrrun("/tmp --simulate"), 3, "/tmp");
    check_failure(lyrrun(""), 2, "--help");
    check_failure(lyrrun("- --simulate"), 2, "standard input");
    check_failure(lyrrun(good), 2, "--printer");
    check_failure(lyrrun(good + " --simulate --colour"), 2, "--colour");
    check_failure(lyrrun(good + " --trace x.vcd --printer x.toml"), 2, "--simulate");
    check_failure(lyrrun(good + " --simulate --printer /nonexistent.toml"), 3, "/nonexistent.toml");
    check_failure(lyrrun(good + " --simulate --trace /nonexistent/out.vcd"), 6, "/nonexistent");
    check_failure(lyrrun(good + " --printer " LYR_FIXTURES "/printers/generic.toml"), 7,
                  "axis.x.step");
}

TEST_CASE("lyrrun: a file that is cut short names the last whole layer") {
    const std::string good = write_print("truncated", {draw_square, draw_arcs, draw_hatch});
    const std::string bytes = text_of_file(good);
    const std::string cut = good + ".cut";
    std::ofstream(cut, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size() - 60));
    check_failure(lyrrun(cut + " --simulate"), 3, "layer");
    std::filesystem::remove(cut);
}

TEST_CASE("lyrrun: a damaged byte is found") {
    const std::string good = write_print("damaged", {draw_square, draw_arcs, draw_hatch});
    std::string bytes = text_of_file(good);
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 4);
    const std::string bad = good + ".bad";
    std::ofstream(bad, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    check_failure(lyrrun(bad + " --simulate"), 3, "");
    std::filesystem::remove(bad);
}

TEST_CASE("lyrrun: SIGTERM ends a simulation with status 8 and without a half-written trace") {
    const std::string file = write_print("long", std::vector<Drawing>(400, draw_circles));
    const std::string trace = file + ".vcd";
    std::filesystem::remove(trace);
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        const int null = ::open("/dev/null", O_WRONLY);
        ::dup2(null, STDOUT_FILENO);
        ::dup2(null, STDERR_FILENO);
        ::execl(LYR_BUILD "/lyrrun", "lyrrun", file.c_str(), "--simulate", "--trace", trace.c_str(),
                nullptr);
        ::_exit(127);
    }
    ::usleep(300'000);
    ::kill(child, SIGTERM);
    int status = 0;
    ::waitpid(child, &status, 0);
    CHECK(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 8);
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::temp_directory_path()))
        CHECK_FALSE(entry.path().string().starts_with(trace));
}
