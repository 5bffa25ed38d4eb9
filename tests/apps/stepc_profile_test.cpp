// stepc with profiles and settings: what it shows, what it refuses, and that a print holds what was asked for.

#include <regex>

#include "apps/program.h"

using namespace lyr::tests;

namespace {

Folder with_part(const std::string& name) {
    Folder folder(name);
    folder.copy("parts/cuboid.step", "p.step");
    return folder;
}

// What it shows, which is all that it does.
std::string shown(const Folder& folder, const std::string& arguments) {
    const auto files = folder.files();
    const Ended ended = folder.run("stepc " + arguments + " --print-config");
    CAPTURE(arguments);
    CAPTURE(ended.err);
    CHECK(ended.status == 0);
    CHECK(ended.err.empty());
    CHECK(folder.files() == files);
    return ended.out;
}

std::string without_origins(const std::string& text) {
    return std::regex_replace(text, std::regex(" *# .*"), "");
}

bool has_line(const std::string& text, const std::string& key, const std::string& origin) {
    const std::size_t at = text.find('\n' + key + " = ");
    if (at == text.npos) return false;
    const std::string line = text.substr(at + 1, text.find('\n', at + 1) - at - 1);
    return line.ends_with("  # " + origin);
}

}  // namespace

TEST_CASE("stepc --print-config: all settings with their origins, without a part") {
    const Folder folder("stepc-config");
    folder.write("abs.toml", "inherits = \"abs\"\n\n[temperature]\nnozzle = 235\n");
    const std::string text =
        shown(folder,
              "--profile abs.toml --set layer.height=0.2 --set perimeters.count=3 "
              "--set infill.density=15% --set infill.pattern=grid --at 20,30");
    CHECK(text.find("\nheight = 0.2  ") != text.npos);
    CHECK(text.find("\ncount = 3  ") != text.npos);
    CHECK(text.find("\ndensity = \"15%\"  ") != text.npos);
    CHECK(text.find("\npattern = \"grid\"  ") != text.npos);
    CHECK(has_line(text, "height", "--set"));
    CHECK(has_line(text, "count", "--set"));
    CHECK(has_line(text, "nozzle", "abs.toml:4"));
    CHECK(has_line(text, "bed", "abs.toml:10 (built-in)"));
    CHECK(has_line(text, "at", "--at"));
    CHECK(has_line(text, "z_hop", "default"));
    CHECK(has_line(shown(folder, "--layer-height 0.1"), "height", "--layer-height"));
    // Nothing is printed, whatever else is asked for.
    shown(folder, "no.step -o no.lyr");
}

TEST_CASE("stepc --print-config: what it shows is a profile with the same configuration") {
    const Folder folder("stepc-config-again");
    for (const char* arguments : {"", "--profile tpu --set support.blockers=TOP,SIDE --at -3,0.1",
                                  "--profile abs-dental --set infill.density=33.3%"}) {
        const std::string text = shown(folder, arguments);
        folder.write("again.toml", text);
        CHECK(without_origins(shown(folder, "--profile again.toml")) == without_origins(text));
        const Ended piped = folder.run("stepc --profile - --print-config < again.toml");
        CHECK(without_origins(piped.out) == without_origins(text));
        CHECK(has_line(piped.out, "height", "standard input:13"));
    }
}

TEST_CASE("stepc --set: the last of a key counts, and none takes the part's place") {
    const Folder folder("stepc-set-order");
    CHECK(shown(folder, "--set perimeters.count=2 --set perimeters.count=4").find("\ncount = 4 ") !=
          std::string::npos);
    const Folder part = with_part("stepc-set-part");
    CHECK(part.run("stepc --set layer.height=0.4 --set perimeters.count=2 p.step").status == 0);
    CHECK(fs::exists(part / "p.lyr"));
}

TEST_CASE("stepc --profile, --set: what is wrong is told in one line, and nothing is written") {
    const Folder folder = with_part("stepc-settings-wrong");
    folder.write("wrong.toml", "[layer]\nheight = 0.2\n\n[infil]\ndensity = \"15%\"\n");
    folder.write("cycle.toml", "inherits = \"cycle.toml\"\n");
    folder.write("thick.toml", "layer.height = 0.5\n");
    const auto files = folder.files();
    const auto refused = [&](const std::string& arguments, int status, const std::string& part) {
        CAPTURE(arguments);
        for (const char* with : {"p.step ", "--print-config "})
            check_failure(folder.run("stepc " + (with + arguments)), "stepc", status, part);
        CHECK(folder.files() == files);
    };
    refused("--set infil.density=15%", 2,
            "unknown key `infil.density`; did you mean `infill.density`?");
    refused("--set infill.density=15", 2, "expected 0% to 100%, found \"15\"; write 15% or 0.15");
    refused("--set infill.pattern=gird", 2, "did you mean `grid`?");
    refused("--set layer.height=20", 2, "expected 0.001 to 10 mm, found \"20\"");
    refused("--set layer.height=0.2inch", 2, "--set: layer.height: expected");
    refused("--set layer.height", 2, "--set: expected KEY=VALUE, found \"layer.height\"");
    refused("--set", 2, "--set: expected one value");
    refused("--set filament.material=\"$(printf 'a\\033[2J')\"", 2, "\"a\\x1b[2J\"");
    refused("--set \"$(printf '\\033[2J')=1\"", 2, "unknown key `\\x1b[2J`");
    refused("--layer-height 0.2 --set layer.height=0.2", 2, "leave one out");
    refused("--layer-height 0.5", 2,
            "layer.height = 0.5 (--layer-height) is more than nozzle.diameter = 0.4 (default)");
    refused(
        "--set perimeters.width=5", 2,
        "perimeters.width = 5 (--set) is more than three times nozzle.diameter = 0.4 (default)");
    refused("--profile ''", 2, "--profile: expected the name of a file");
    refused("--profile wrong.toml", 3, "wrong.toml:5:1: error: unknown key `infil.density`");
    refused("--profile cycle.toml", 3, "cycle.toml:1:1: error: inherits itself: ");
    refused("--profile thick.toml", 3, "thick.toml:1: error: layer.height = 0.5 (thick.toml:1)");
    refused("--profile asb", 3, "asb: error: cannot read");
    refused("--profile no/abs.toml", 3, "no/abs.toml: error: cannot read");
    refused("--profile p.step", 3, "p.step:1");
}

TEST_CASE("stepc: the print holds the configuration, without the folders of files") {
    const Folder folder = with_part("stepc-config-in-print");
    fs::create_directories(folder / "mine");
    folder.write("mine/own.toml", "inherits = \"petg\"\n[perimeters]\ncount = 7\n");
    CHECK(folder.run("stepc p.step --profile mine/own.toml --set layer.height=0.4").status == 0);
    const std::string print = text_of(folder / "p.lyr");
    for (const char* part :
         {"\nmaterial=PETG\n", "\nprofile=own\n", "filament_density_g_cm3=1.27\n",
          "count = 7                       # own.toml:3\n",
          "height = 0.4                    # --set\n"})
        CHECK_MESSAGE(print.find(part) != std::string::npos, part);
    CHECK(print.find("mine/") == std::string::npos);
}

TEST_CASE("stepc: no output takes the place of a profile, nor do two inputs share a stream") {
    const Folder folder = with_part("stepc-profile-files");
    folder.write("base.toml", "layer.height = 0.3\n");
    folder.write("own.toml", "inherits = \"base.toml\"\n");
    const auto files = folder.files();
    for (const char* output : {"-o own.toml", "-o base.toml", "-o a.lyr --report ./base.toml"})
        check_failure(folder.run("stepc p.step --profile own.toml " + std::string(output)), "stepc",
                      2, "would overwrite the profile");
    check_failure(folder.run("stepc - -o a.lyr --profile -"), "stepc", 2,
                  "the part and the profile cannot both be read from standard input");
    CHECK(folder.files() == files);
}
