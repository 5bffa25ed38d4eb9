// stepc in pipes and redirections: what a name of a stream means, and what ends up in it.

#include "apps/program.h"

using namespace lyr::tests;

namespace {

// A folder with a part, p.step, a file of heights, z, and what is made of them, named.lyr, named.jsonl and cut.jsonl.
Folder with_results(const std::string& name) {
    Folder folder(name);
    folder.copy("parts/cuboid.step", "p.step");
    folder.write("z", "1\n25.4\n70\n");
    REQUIRE(
        folder.run("stepc p.step --layer-height 0.4 -o named.lyr --report named.jsonl\n").status ==
        0);
    REQUIRE(folder.run("stepc p.step --section-at z --report cut.jsonl").status == 0);
    return folder;
}

}  // namespace

TEST_CASE("stepc: whatever output goes to standard output, the summary goes to standard error") {
    const Folder folder = with_results("streams-summary");
    const std::string lyr = text_of(folder / "named.lyr"), report = text_of(folder / "named.jsonl");
    for (const std::string name : {"-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"}) {
        CAPTURE(name);
        const Ended print = folder.run("stepc p.step --layer-height 0.4 -o " + name);
        CHECK(print.status == 0);
        CHECK(print.out == lyr);
        CHECK(print.err.find("1 solid, 6 faces") != std::string::npos);
        const Ended both = folder.run("stepc p.step --layer-height 0.4 -o a.lyr --report " + name);
        CHECK(both.status == 0);
        CHECK(both.out == report);
        CHECK(both.err.find("1 solid, 6 faces") != std::string::npos);
        const Ended piped =
            folder.run("stepc p.step --layer-height 0.4 -o a.lyr --report " + name + " | cat");
        CHECK(piped.out == report);
        const Ended cut = folder.run("stepc p.step --section-at z --report " + name);
        CHECK(cut.status == 0);
        CHECK(cut.out == text_of(folder / "cut.jsonl"));
        CHECK(cut.err.find("3 sections") != std::string::npos);
    }
}

TEST_CASE("stepc: standard output that is a file is written on, not cut off and not replaced") {
    const Folder folder = with_results("streams-redirected");
    for (const std::string name : {"-", "/dev/stdout"}) {
        const Ended ended = folder.run(
            "rm -f all; ln -s all link\n"
            "(echo before\n"
            " stepc p.step --section-at z --report " +
            name +
            "\n"
            " echo after) > link");
        CHECK(ended.status == 0);
        CHECK(text_of(folder / "all") == "before\n" + text_of(folder / "cut.jsonl") + "after\n");
        CHECK(fs::is_symlink(folder / "link"));
        CHECK(fs::is_symlink("/dev/stdout"));
        fs::remove(folder / "link");
    }
    for (const std::string& file : folder.files()) CHECK(file.find(".part") == std::string::npos);
}

TEST_CASE("stepc: - is standard input for the part and for the heights") {
    const Folder folder = with_results("streams-input");
    for (const char* script : {"stepc - --section-at z --report r < p.step",
                               "cat p.step | stepc - --section-at z --report r",
                               "stepc p.step --section-at - --report r < z",
                               "cat z | stepc p.step --section-at - --report r"}) {
        CAPTURE(script);
        CHECK(folder.run(script).status == 0);
        CHECK(text_of(folder / "r") == text_of(folder / "cut.jsonl"));
        fs::remove(folder / "r");
    }
    CHECK(folder.run("stepc - -o - < p.step | lyrview - --info").out.find("standard input") !=
          std::string::npos);
    check_failure(folder.run("stepc - < p.step"), "stepc", 2, "-o");
    check_failure(folder.run("stepc - --section-at - --report r < p.step"), "stepc", 2,
                  "cannot both be read from standard input");
    check_failure(folder.run("stepc - -o r < z"), "stepc", 3, "standard input:1");
    check_failure(folder.run("echo x | stepc p.step --section-at - --report r"), "stepc", 3,
                  "standard input:1");
    CHECK_FALSE(fs::exists(folder / "r"));
}

TEST_CASE("stepc: two outputs do not mix in standard output, nor does an input get written on") {
    const Folder folder = with_results("streams-mixed");
    const std::string part = text_of(folder / "p.step");
    check_failure(folder.run("stepc p.step -o - --report -"), "stepc", 2, "would be one file");
    check_failure(folder.run("stepc p.step -o - --report /dev/stdout | cat"), "stepc", 0,
                  "would be one file");
    check_failure(folder.run("stepc p.step -o a.lyr --report - >> a.lyr"), "stepc", 2,
                  "would be one file: standard output");
    check_failure(folder.run("stepc p.step -o - >> p.step"), "stepc", 2,
                  "the print would overwrite the part: standard output");
    CHECK(text_of(folder / "p.step") == part);
}

TEST_CASE("stepc: output that cannot be written is status 6, says why and leaves nothing") {
    const Folder folder = with_results("streams-full");
    const auto files = folder.files();
    const auto refused = [&](const std::string& script, const std::string& message) {
        CAPTURE(script);
        check_failure(folder.run(script), "stepc", 6, message);
        CHECK(folder.files() == files);
    };
    refused("stepc p.step -o /dev/full", "No space left on device");
    refused("stepc p.step -o - > /dev/full", "standard output: error: cannot write: No space");
    refused("stepc p.step -o /dev/null --report /dev/full", "No space left on device");
    refused("stepc p.step -o a.lyr --report /dev/full", "No space left on device");
    refused("stepc p.step -o /dev/full --report a.jsonl", "No space left on device");
    refused("stepc p.step -o /dev/null > /dev/full", "No space left on device");
    refused("stepc p.step -o - >&-", "standard output");
    refused("stepc --help > /dev/full", "No space left on device");
    refused("stepc p.step -o missing/a.lyr", "missing/a.lyr");
    refused("ulimit -f 8; stepc p.step -o a.lyr", "File too large");
}

TEST_CASE("stepc: a reader that goes away is an error of output and leaves no print behind") {
    const Folder folder = with_results("streams-broken-pipe");
    const auto files = folder.files();
    // A report of more than a pipe holds.
    const Ended ended = folder.run(
        "{ stepc p.step --layer-height 0.02 -o a.lyr --report -; echo $? >&2; } | head -n 1");
    CHECK(lines_in(ended.out) == 1);
    CHECK(ended.err == "stepc: standard output: error: cannot write: Broken pipe\n6\n");
    CHECK(folder.files() == files);
}
