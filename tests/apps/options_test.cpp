// What --help and --version say, of every program that is built.

#include <sstream>

#include "apps/command_line.h"
#include "apps/program.h"

using namespace lyr::tests;
using namespace lyr::command_line;

namespace {

// What a command line comes to: the values in their order, and the error.
struct Parsed {
    std::string values, error;
};

Parsed parse(std::vector<std::string> words) {
    Parsed parsed;
    const auto kept = [&](const std::string& name) {
        return [&parsed, name](const std::string& value) -> std::optional<std::string> {
            if (value == "bad") return "good";
            parsed.values += name + '(' + value + ')';
            return std::nullopt;
        };
    };
    Options options;
    bool flag = false;
    add_text(options, "word", "WORD", kept("word"), "");
    add_text(options, "-o,--output", "FILE", kept("output"), "");
    add_text(options, "--home", "[AXES]", kept("home"), "");
    add_texts(options, "--set", "KEY=VALUE ...", kept("set"), "");
    add_flag(options, "--flag", flag, "");
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    if (const auto status = options.parse(pointers); !status) parsed.error = status.error().message;
    if (flag) parsed.values += "flag";
    CHECK(flag == (options.count("--flag") > 0));
    CHECK(options.count("-o") == options.count("--output"));
    return parsed;
}

std::string values(const std::vector<std::string>& words) {
    const Parsed parsed = parse(words);
    CHECK(parsed.error.empty());
    return parsed.values;
}

std::string error(const std::vector<std::string>& words) {
    return parse(words).error;
}

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
        Ended help = folder.run(program + " --help");
        const std::string fold = '\n' + std::string(30, ' ');
        for (std::size_t at = 0; (at = help.out.find(fold, at)) != std::string::npos;)
            help.out.replace(at, fold.size(), " ");
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

TEST_CASE("options: each way to say a value") {
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"-o", "a=b"}, {"-oa=b"}, {"--output", "a=b"}, {"--output=a=b"}})
        CHECK(values(words) == "output(a=b)");
    CHECK(values({"-o", "--flag"}) == "output(--flag)");
    CHECK(values({"-o", "-5", "-"}) == "output(-5)word(-)");
    CHECK(values({"--output="}) == "output()");
    CHECK(values({"w", "--flag", "--flag"}) == "word(w)flag");
    CHECK(values({"--set", "a", "w", "--set=b"}) == "set(a)word(w)set(b)");
    CHECK(values({"--", "--flag"}) == "word(--flag)");
    CHECK(values({"-5"}) == "word(-5)");
    CHECK(values({"--flag", "-5"}) == "word(-5)flag");
    CHECK(values({"--outp", "a"}) == "output(a)");
    CHECK(values({}).empty());
}

TEST_CASE("options: a value in brackets may be left out") {
    CHECK(values({"--home"}) == "home()");
    CHECK(values({"--home", "--flag"}) == "home()flag");
    CHECK(values({"--home", "xy", "w"}) == "home(xy)word(w)");
    CHECK(values({"--home", "-5"}) == "home(-5)");
    CHECK(values({"--home=z"}) == "home(z)");
    CHECK(values({"--home", "--", "w"}) == "home()word(w)");
}

TEST_CASE("options: the first mistake is the error, and the rest is read") {
    CHECK(error({"--output"}) == "--output: expected one value, once");
    CHECK(error({"-o", "a", "-ob"}) == "--output: expected one value, once");
    CHECK(error({"--flag=1"}) == "--flag: takes no value");
    CHECK(error({"-x"}) == "unknown option \"-x\"");
    CHECK(error({"--outputs=a"}) == "unknown option \"--outputs\"");
    CHECK(error({"--word", "a"}) == "unknown option \"--word\"");
    CHECK(error({"a", "b"}) == "unexpected argument \"b\"");
    CHECK(error({"--", "a", "--"}) == "unexpected argument \"--\"");
    CHECK(error({"-obad"}) == "--output: expected good, found \"bad\"");
    const Parsed both = parse({"--colour", "-x", "--flag"});
    CHECK(both.error == "unknown option \"--colour\"");
    CHECK(both.values == "flag");
}

TEST_CASE("help: no line is longer than 100 columns, and no word is lost") {
    const Folder folder("columns");
    std::vector<std::string> all = programs();
    all.emplace_back("lyrctl");
    for (const std::string& program : all) {
        CAPTURE(program);
        std::istringstream lines(folder.run(program + " --help").out);
        for (std::string line; std::getline(lines, line);) {
            CAPTURE(line);
            CHECK(line.size() <= 100);
        }
    }
    Options options;
    const std::string word(80, 'x'), text = "one two " + word;
    options.add({"--option", "VALUE", {}, text});
    const std::string help = options.help("program");
    CHECK(help.find("--option VALUE") < help.find("one two"));
    CHECK(help.find("one two\n" + std::string(30, ' ') + word + "\n") != std::string::npos);
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
