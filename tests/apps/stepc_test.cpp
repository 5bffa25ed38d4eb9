// The program itself: what it prints where, and its exit status. docs/exit-status.md is its contract.

#include <cctype>
#include <cmath>
#include <regex>

#include "apps/command_line.h"
#include "apps/program.h"

using namespace lyr::tests;

namespace {

// A folder with a cuboid of 50.8 x 25.4 x 76.2 mm, p.step, and a file of one height, z.
Folder with_cuboid(const std::string& name) {
    Folder folder(name);
    folder.copy("parts/cuboid.step", "p.step");
    folder.write("z", "25.4\n");
    return folder;
}

// Whether the text says "1 lines" or the like of anything that a summary counts.
bool has_one_of_many(const std::string& text) {
    for (const char* noun : {"solids", "faces", "layers", "sections", "contours", "full circles",
                             "lines", "arcs", "bytes", "findings"}) {
        const std::size_t at = text.find(std::string("1 ") + noun);
        if (at != text.npos && (at == 0 || !std::isdigit(static_cast<unsigned char>(text[at - 1]))))
            return true;
    }
    return false;
}

const std::set<std::string> untouched{"p.step", "z"};

void check_stepc_failure(const Ended& ended, int status, const std::string& part) {
    check_failure(ended, "stepc", status, part);
}

}  // namespace

TEST_CASE("stepc: the summary counts one thing as one, and many as many") {
    const Folder folder = with_cuboid("stepc-summary");
    const Ended sections = folder.run("stepc p.step --section-at z --report r");
    CHECK(sections.status == 0);
    CHECK(sections.err.empty());
    CHECK(sections.out.find("1 section: 1 contour (0 full circles), 4 lines, 0 arcs\n") !=
          std::string::npos);
    CHECK_FALSE(has_one_of_many(sections.out));
    const Ended print = folder.run("stepc p.step --layer-height 10 --set nozzle.diameter=10");
    CHECK(print.status == 0);
    CHECK(print.out.find("1 solid, 6 faces\n8 layers: 8 contours") != std::string::npos);
    CHECK_FALSE(has_one_of_many(print.out));
    CHECK(fs::exists(folder / "p.lyr"));
}

TEST_CASE("stepc: heights are reported as they were given") {
    const Folder folder = with_cuboid("stepc-heights");
    folder.write("z", "25.4\n0.1\n1e-3\n");
    CHECK(folder.run("stepc p.step --section-at z --report r").status == 0);
    const std::string report = text_of(folder / "r");
    for (const char* height : {"{\"z\":25.4,", "{\"z\":0.1,", "{\"z\":0.001,"})
        CHECK(report.find(height) != std::string::npos);
}

TEST_CASE("stepc: what is wrong with a heights file is said without its control bytes") {
    const Folder folder = with_cuboid("stepc-control-bytes");
    folder.write("bad", "1\n\x1b[2J\x07\xff\n");
    check_stepc_failure(folder.run("stepc p.step --section-at bad --report r"), 3,
                        "bad:2: error: expected a height in mm, found \"\\x1b[2J\\x07\\xff\"");
    check_stepc_failure(folder.run("stepc p.step --section-at /dev/zero --report r"), 3,
                        "/dev/zero");
    CHECK_FALSE(fs::exists(folder / "r"));
}

TEST_CASE("stepc: no number that is not finite or makes no sense gets through, and none hangs") {
    const Folder folder = with_cuboid("stepc-numbers");
    const std::vector<std::string> values{"nan",  "-nan",  "inf", "-inf", "1e400", "1e308",
                                          "1e12", "-1e12", "''",  "0x10", "1inch", "'1 1'"};
    const auto refused = [&](const std::string& option, const std::string& expected) {
        for (const std::string& value : values) {
            CAPTURE(option);
            CAPTURE(value);
            check_stepc_failure(folder.run("stepc p.step " + option + value), 2, expected);
        }
    };
    refused("--threads ", "--threads: expected a whole number");
    refused("--layer-height ", "--layer-height: layer.height: expected 0.001 to 10 mm, found ");
    refused("--tolerance ", "--tolerance: slicing.tolerance: expected 0.00001 to 1 mm, found ");
    refused("--set speed.travel=", "--set: speed.travel: expected 0.1 to 2000 mm/s, found ");
    for (const char* value :
         {"inf,0,0", "0,nan,1", "0,0,1e400", "1e12,0,0", "0,0", "0,0,1,0", "0,,1", "0,0,1,", "''"})
        check_stepc_failure(folder.run("stepc p.step --up " + std::string(value)), 2,
                            "--up: expected X,Y,Z, each from -1000 to 1000");
    for (const char* value : {"1e12,0", "0,-10001", "nan,0", "0,inf", "0", "0,0,0", "''"})
        check_stepc_failure(folder.run("stepc p.step --at " + std::string(value)), 2,
                            "--at: plate.at: expected X,Y, each -10000 to 10000 mm");
    check_stepc_failure(folder.run("stepc p.step --up 0,0,0"), 2, "no direction");
    CHECK(folder.files() == untouched);
}

TEST_CASE("stepc: the length of --up does not matter") {
    const Folder folder = with_cuboid("stepc-up");
    CHECK(folder.run("stepc p.step --up -1,0,0 -o a.lyr").status == 0);
    for (const char* up : {"-1000,0,0", "-1e-300,0,0", "-5e-324,0,0"}) {
        CHECK(folder.run("stepc p.step -o b.lyr --up " + std::string(up)).status == 0);
        CHECK(text_of(folder / "a.lyr") == text_of(folder / "b.lyr"));
    }
}

TEST_CASE("stepc: a part in the wrong unit is refused with its size, and so is a damaged point") {
    const Folder folder = with_cuboid("stepc-unit");
    const std::string part = text_of(folder / "p.step");
    const auto with = [&](const std::string& old, const std::string& by) {
        std::string changed = part;
        const std::size_t at = changed.find(old);
        REQUIRE(at != part.npos);
        folder.write("q.step", changed.replace(at, old.size(), by));
    };
    with("SI_UNIT($,.METRE.)", "SI_UNIT(.KILO.,.METRE.)");
    check_stepc_failure(folder.run("stepc q.step"), 5, "is the file's length unit wrong?");
    with("SI_UNIT($,.METRE.)", "SI_UNIT(.EXA.,.METRE.)");
    check_stepc_failure(folder.run("stepc q.step"), 5, "more than 1 km from the origin");
    CHECK(folder.files() == std::set<std::string>{"p.step", "q.step", "z"});
}

TEST_CASE("stepc: one damaged number neither hangs nor prints beyond the part") {
    const Folder folder("stepc-damaged");
    folder.copy("parts/cube_hole.step", "p.step");
    const std::string part = text_of(folder / "p.step");
    const std::regex number(R"([(,]-?[0-9]+\.[0-9]*)");
    const std::size_t data = part.find("DATA;");
    std::vector<std::pair<std::size_t, std::size_t>> places;
    for (std::sregex_iterator
             at(part.begin() + static_cast<std::ptrdiff_t>(data), part.end(), number),
         end;
         at != end; ++at)
        places.emplace_back(data + static_cast<std::size_t>(at->position()) + 1,
                            static_cast<std::size_t>(at->length()) - 1);
    REQUIRE(places.size() > 100);
    const std::vector<std::string> values{"1.E10", "100.", "1.E308", "-1.E5"};
    std::size_t refused = 0;
    for (std::size_t i = 0; i < places.size(); i += 3) {
        std::string damaged = part;
        folder.write("q.step", damaged.replace(places[i].first, places[i].second, values[i % 4]));
        CAPTURE(part.substr(places[i].first - 30, 60));
        const Ended ended = folder.run(
            "stepc q.step --layer-height 1 --set nozzle.diameter=1 -o q.lyr && lyrview q.lyr "
            "--info");
        CHECK((ended.status == 0 || ended.status == 3 || ended.status == 5));
        if (ended.status != 0) {
            ++refused;
            CHECK(folder.files() == std::set<std::string>{"p.step", "q.step"});
            continue;
        }
        std::smatch box;
        const std::regex extent(R"(box +x (\S+) to (\S+), y (\S+) to (\S+),)");
        REQUIRE(std::regex_search(ended.out, box, extent));
        for (const int k : {1, 2, 3, 4}) CHECK(std::abs(std::stod(box[k])) < 1000);
        fs::remove(folder / "q.lyr");
    }
    CHECK(refused > 10);
}

TEST_CASE("stepc: what a line cannot be wide enough for is told with layer, place and amount") {
    const Folder folder("stepc-balance");
    folder.copy("parts/foot_structure.step", "p.step");
    const std::string wide = "stepc p.step --layer-height 0.4 --set perimeters.width=1 ";
    const std::string told = "less is laid down than the part asks for in ";
    const Ended narrow = folder.run(wide + "--set perimeters.max_width=0.6");
    CHECK(narrow.status == 0);
    CHECK(narrow.err.find(told) != narrow.err.npos);
    CHECK(narrow.err.find(" % of what is to be solid (at layer ") != narrow.err.npos);
    CHECK(folder.run("stepc p.step --layer-height 0.4").err.find(told) == std::string::npos);
}

TEST_CASE("stepc: errors are shown before warnings, and as many as can be read") {
    lyr::Diagnostics found(50, {lyr::Severity::warning, lyr::ExitStatus::geometry, "small", {}});
    found[40] = {lyr::Severity::error, lyr::ExitStatus::geometry, "grave", {}};
    found[3].severity = lyr::Severity::note;
    const auto shown = lyr::command_line::most_telling(found, 20);
    REQUIRE(shown.size() == 20);
    CHECK(shown.back() == 40);
    CHECK(std::is_sorted(shown.begin(), shown.end()));
    CHECK(std::find(shown.begin(), shown.end(), 3) == shown.end());
    CHECK(lyr::command_line::most_telling(found, 100).size() == 50);
}

TEST_CASE("stepc: an empty name is no file") {
    const Folder folder = with_cuboid("stepc-empty");
    check_stepc_failure(folder.run("stepc ''"), 2, "part: expected the name of a file");
    for (const char* option : {"-o", "--output", "--report", "--section-at"}) {
        CAPTURE(option);
        check_stepc_failure(folder.run("stepc p.step " + std::string(option) + " ''"), 2,
                            "expected");
        check_stepc_failure(folder.run("stepc p.step " + std::string(option)), 2, "expected");
    }
    check_stepc_failure(folder.run("stepc p.step --output="), 2, "--output: expected");
    CHECK(folder.files() == untouched);
}

TEST_CASE("stepc: options that make no sense are told in this program's words") {
    const Folder folder = with_cuboid("stepc-options");
    check_stepc_failure(folder.run("stepc"), 2, "part is required");
    check_stepc_failure(folder.run("stepc p.step --colour"), 2, "unknown option \"--colour\"");
    check_stepc_failure(folder.run("stepc p.step b c"), 2, "unexpected argument \"b\"");
    check_stepc_failure(folder.run("stepc p.step -o a -o b"), 2,
                        "--output: expected one value, once");
    check_stepc_failure(folder.run("stepc p.step --allow-open=no"), 2,
                        "--allow-open: takes no value");
    check_stepc_failure(folder.run("stepc p.step --section-at z"), 2, "--report");
    check_stepc_failure(folder.run("stepc p.step --section-at z --report r -o a.lyr"), 2, "-o");
    CHECK(folder.files() == untouched);
}

TEST_CASE("stepc: no output takes the place of an input or of another output") {
    const Folder folder = with_cuboid("stepc-files");
    const std::string part = text_of(folder / "p.step"), heights = text_of(folder / "z");
    fs::create_symlink("z", folder / "z-link");
    fs::create_symlink("a.lyr", folder / "a-link");  // to what is not there yet
    fs::create_hard_link(folder / "p.step", folder / "hard");
    const auto files = folder.files();
    const auto refused = [&](const std::string& arguments, const std::string& message) {
        CAPTURE(arguments);
        check_stepc_failure(folder.run("stepc " + arguments), 2, message);
        CHECK(folder.files() == files);
    };
    for (const char* report : {"z", "./z", "z-link", "$PWD/z", "../stepc-files/z"})
        refused("p.step --section-at z --report " + std::string(report),
                "the report would overwrite the heights");
    refused("p.step --section-at z-link --report z", "the report would overwrite the heights");
    refused("p.step --section-at new --report new", "the report would overwrite the heights");
    for (const char* report : {"a.lyr", "./a.lyr", "a-link", "$PWD/a.lyr"})
        refused("p.step -o a.lyr --report " + std::string(report),
                "the print and the report would be one file");
    refused("p.step -o a-link --report a.lyr", "the print and the report would be one file");
    refused("p.step --report p.lyr", "the print and the report would be one file");
    refused("p.step -o hard", "the print would overwrite the part");
    refused("p.step -o a.lyr --report p.step", "the report would overwrite the part");
    CHECK(text_of(folder / "p.step") == part);
    CHECK(text_of(folder / "z") == heights);
    // Nothing meets in /dev/null, and a link does not make two files one.
    CHECK(folder.run("stepc p.step -o /dev/null --report /dev/null").status == 0);
    CHECK(folder.run("stepc p.step -o a-link --report b").status == 0);
    CHECK(fs::is_symlink(folder / "a-link"));
    CHECK_FALSE(fs::is_symlink(folder / "a.lyr"));
}

TEST_CASE("stepc: a signal ends it with status 8, and neither output is there in part") {
    const Folder folder = with_cuboid("stepc-signal");
    folder.make_pipe("pipe");
    folder.write("a.lyr", "old");
    const auto files = folder.files();
    for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
        // Nobody reads the report: stepc waits, with its print begun.
        const Running running(folder, {"stepc", "p.step", "-o", "a.lyr", "--report", "pipe"},
                              folder / "../stepc-signal.err");
        CHECK(running.wait_for([&] { return folder.files() != files; }));
        CHECK(running.end(signal) == 8);
        CHECK(folder.files() == files);
        CHECK(text_of(folder / "a.lyr") == "old");
        CHECK(text_of(folder / "../stepc-signal.err") == "stepc: error: stopped on request\n");
    }
}

TEST_CASE("stepc: a signal that was ignored from the beginning stays so") {
    const Folder folder = with_cuboid("stepc-nohup");
    folder.make_pipe("pipe");
    const Ended ended = folder.run(
        "trap '' HUP\n"
        "stepc p.step -o a.lyr --report pipe & process=$!\n"
        "until ls *.part >/dev/null 2>&1; do sleep 0.01; done\n"
        "kill -HUP $process\n"
        "cat pipe >report\n"
        "wait $process");
    CHECK(ended.status == 0);
    CHECK(ended.err.empty());
    CHECK(fs::exists(folder / "a.lyr"));
    CHECK(lines_in(text_of(folder / "report")) == 381);
}

TEST_CASE("stepc: the print states the SHA-256 of the model's file, and has two pictures") {
    const Folder folder = with_cuboid("stepc-source");
    const Ended sum = folder.run("sha256sum < p.step");
    REQUIRE(sum.out.size() > 64);
    for (const char* script : {"stepc p.step -o p.lyr --layer-height 0.4 --threads 1",
                               "stepc - -o q.lyr --layer-height 0.4 --threads 4 < p.step"})
        CHECK(folder.run(script).status == 0);
    for (const char* print : {"p.lyr", "q.lyr"}) {
        CAPTURE(print);
        const Ended info = folder.run("lyrview --info " + std::string(print));
        CHECK(info.out.find(sum.out.substr(0, 64)) != std::string::npos);
        CHECK(folder.run("lyrview --thumbnail " + std::string(print) + " -o " + print + ".png")
                  .status == 0);
    }
    const std::string png = text_of(folder / "p.lyr.png");
    CHECK(png.starts_with("\x89PNG\r\n\x1a\n"));
    // The same for any number of threads.
    CHECK(png == text_of(folder / "q.lyr.png"));
}

// They came out without their domes where the surface's rim, or a bump beyond the edges, was by round-off above the edges.
TEST_CASE("stepc: a dome is sliced whole, however its surface goes on beyond its edges") {
    const Folder folder("stepc-dome");
    const auto height_mm = [&](const std::string& dome, const std::string& up) {
        folder.copy("domes/" + dome, dome);
        const Ended ended = folder.run("stepc " + dome + " --layer-height 0.4" + up);
        REQUIRE(ended.status == 0);
        const std::size_t end = ended.out.find(" mm at 0.4 mm a layer");
        REQUIRE(end != std::string::npos);
        return std::stod(ended.out.substr(ended.out.rfind(' ', end - 1)));
    };
    CHECK(height_mm("rim_above_edges.step", "") == doctest::Approx(21.25));
    CHECK(height_mm("askew.step",
                    " --up 0.25934338005223079,-0.47942553860420301,0.83838664359420356") ==
          doctest::Approx(21.25));
    CHECK(height_mm("flat_margin.step",
                    " --up 0.29221464428477228,-0.89120736006143542,0.34692944965489897") ==
          doctest::Approx(16));
}
