// What --help and --version say, of every program that is built.

#include "apps/program.h"

using namespace lyr::tests;

namespace {

std::vector<std::string> programs() {
    std::vector<std::string> names;
    for (const char* name : {"lyrrun", "lyrview", "stepc"})
        if (fs::exists(fs::path(LYR_BUILD) / name)) names.emplace_back(name);
    return names;
}

}  // namespace

TEST_CASE("help: examples, what - means and every exit status that the page knows") {
    const Folder folder("help");
    for (const std::string& program : programs()) {
        CAPTURE(program);
        const Ended help = folder.run(program + " --help");
        CHECK(help.status == 0);
        CHECK(help.err.empty());
        for (const char* part : {"Examples:\n", "-: standard input", "-: standard output",
                                 "Exit status: 0 done, 2 options, 3 input", "8 stopped"})
            CHECK(help.out.find(part) != std::string::npos);
        const Ended version = folder.run(program + " --version");
        CHECK(version.status == 0);
        CHECK(version.out.starts_with(program + ' '));
        CHECK(lines_in(version.out) == 1);
    }
}

TEST_CASE("options: what no program knows is refused by each in the same words") {
    const Folder folder("options");
    for (const std::string& program : programs()) {
        check_failure(folder.run(program), program, 2, " is required");
        check_failure(folder.run(program + " a --colour"), program, 2,
                      "unknown option \"--colour\" (" + program + " --help explains)");
        check_failure(folder.run(program + " a \"$(printf '\\033[2J')\""), program, 2,
                      "unexpected argument \"\\x1b[2J\"");
        check_failure(folder.run(program + " ''"), program, 2, "expected the name of a file");
    }
}
