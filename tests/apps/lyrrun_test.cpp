// The program itself: what it prints where, and its exit status. docs/exit-status.md is its contract.

#include "apps/program.h"
#include "target/run/print_files.h"

using namespace lyr;
using namespace lyr::tests;

namespace {

Ended lyrrun(const std::string& arguments) {
    return Folder("lyrrun").run("lyrrun " + arguments);
}

}  // namespace

TEST_CASE("lyrrun: a simulation reports on stdout and says nothing on a pipe's stderr") {
    const Ended ended =
        lyrrun(write_print("program", {draw_square, draw_arcs}) + " --simulate --no-heat");
    CHECK(ended.status == 0);
    CHECK(ended.err.empty());
    CHECK(ended.out.find("within half a microstep everywhere") != std::string::npos);
    CHECK(ended.out.find("print time") != std::string::npos);
}

TEST_CASE("lyrrun: --json is one line of JSON") {
    const Ended ended = lyrrun(write_print("json", {draw_square}) + " --simulate --no-heat --json");
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
    check_lyrrun_failure(lyrrun("/nonexistent.lyr --simulate"), 3, "/nonexistent.lyr");
    check_lyrrun_failure(lyrrun(LYR_FIXTURES "/printers/generic.toml --simulate"), 3,
                         "generic.toml");
    check_lyrrun_failure(lyrrun("/dev/null --simulate"), 3, "/dev/null");
    check_lyrrun_failure(lyrrun("/tmp --simulate"), 3, "/tmp");
    check_lyrrun_failure(lyrrun(""), 2, "--help");
    check_lyrrun_failure(lyrrun("- --simulate"), 2, "standard input");
    check_lyrrun_failure(lyrrun(good), 2, "--printer");
    check_lyrrun_failure(lyrrun(good + " --simulate --colour"), 2, "--colour");
    check_lyrrun_failure(lyrrun(good + " --trace x.vcd --printer x.toml"), 2, "--simulate");
    check_lyrrun_failure(lyrrun(good + " --simulate --printer /nonexistent.toml"), 3,
                         "/nonexistent.toml");
    check_lyrrun_failure(lyrrun(good + " --simulate --trace /nonexistent/out.vcd"), 6,
                         "/nonexistent");
    check_lyrrun_failure(
        lyrrun(good + " --no-heat --printer " LYR_FIXTURES "/printers/generic.toml"), 7,
        "axis.x.step");
    check_lyrrun_failure(lyrrun(good + " --printer " LYR_FIXTURES "/printers/generic.toml"), 7,
                         "heater.tool.min_extrude_c");
}

TEST_CASE("lyrrun: a file that is cut short names the last whole layer") {
    const std::string good = write_print("truncated", {draw_square, draw_arcs, draw_hatch});
    const std::string bytes = text_of(good);
    const std::string cut = good + ".cut";
    std::ofstream(cut, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size() - 60));
    check_lyrrun_failure(lyrrun(cut + " --simulate"), 3, "layer");
    std::filesystem::remove(cut);
}

TEST_CASE("lyrrun: a damaged byte is found") {
    const std::string good = write_print("damaged", {draw_square, draw_arcs, draw_hatch});
    std::string bytes = text_of(good);
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 4);
    const std::string bad = good + ".bad";
    std::ofstream(bad, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    check_lyrrun_failure(lyrrun(bad + " --simulate --no-heat"), 3, "");
    std::filesystem::remove(bad);
}

TEST_CASE("lyrrun: SIGTERM ends a simulation with status 8 and without a half-written trace") {
    const Folder folder("lyrrun-signal");
    const std::string file = write_print("long", std::vector<Drawing>(4000, draw_circles));
    folder.write("trace.vcd", "old");
    for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
        const Running running(folder,
                              {"lyrrun", file, "--simulate", "--no-heat", "--trace", "trace.vcd"},
                              folder / "err");
        CHECK(running.wait_for([&] { return folder.files().size() == 3; }));
        CHECK(running.end(signal) == 8);
        CHECK(folder.files() == std::set<std::string>{"err", "trace.vcd"});
        CHECK(text_of(folder / "trace.vcd") == "old");
        CHECK(text_of(folder / "err") == "lyrrun: error: stopped on request\n");
    }
}

namespace {

// Two layers of PLA.
std::string write_heated(const std::string& name) {
    return write_print(name, {draw_square, draw_arcs}, {}, [](format::LayerState& state) {
        state.temperatures.push_back({{format::HeaterKind::bed, 0}, 60});
        state.temperatures.push_back({{format::HeaterKind::tool, 0}, 210});
    });
}

}  // namespace

TEST_CASE("lyrrun: a simulation heats, waits and tells so; with --no-heat it does not") {
    const std::string file = write_heated("heated");
    const Ended heated = lyrrun(file + " --simulate");
    CHECK(heated.status == 0);
    CHECK(heated.err.empty());
    CHECK(heated.out.find("waiting for temperatures") != std::string::npos);
    CHECK(heated.out.find("  heated       tool to 21") != std::string::npos);
    const Ended cold = lyrrun(file + " --simulate --no-heat");
    CHECK(cold.status == 0);
    CHECK(cold.err.find("not heated: ") != std::string::npos);
    CHECK(cold.out.find("  heated") == std::string::npos);
}

TEST_CASE("lyrrun: --faults breaks the simulation, and the guard's message is the result") {
    const Folder folder("lyrrun-faults");
    fs::copy_file(write_heated("faults"), folder / "a.lyr");
    folder.write("faults.txt", "# after half a minute\n30 open tool\n");
    check_lyrrun_failure(folder.run("lyrrun a.lyr --simulate --faults faults.txt"), 7,
                         "after 30.3 s, in layer 1: heater tool: ");
    check_lyrrun_failure(folder.run("echo 5 silent | lyrrun a.lyr --simulate --faults -"), 7,
                         "silent");
    folder.write("bad.txt", "5 open tool\n5 opne tool\n");
    check_lyrrun_failure(folder.run("lyrrun a.lyr --simulate --faults bad.txt"), 3, "bad.txt:2");
    check_lyrrun_failure(folder.run("lyrrun a.lyr --simulate --faults none.txt"), 3, "none.txt");
    check_lyrrun_failure(folder.run("lyrrun a.lyr --faults faults.txt --printer p.toml"), 2,
                         "--simulate");
    check_lyrrun_failure(folder.run("lyrrun a.lyr --simulate --no-heat --faults faults.txt"), 2,
                         "--no-heat");
    check_lyrrun_failure(folder.run("lyrrun a.lyr --simulate --faults - --printer - </dev/null"), 2,
                         "standard input");
}

TEST_CASE(
    "lyrrun: --tune gives the lines of printer.toml, and a printer that has them takes them") {
    const Folder folder("lyrrun-tune");
    const Ended tuned = folder.run("lyrrun --tune tool=210 --simulate");
    CHECK(tuned.status == 0);
    CHECK(tuned.err.empty());
    const std::size_t from = tuned.out.find("[heater.tool]");
    REQUIRE(from != std::string::npos);
    const std::string lines = tuned.out.substr(from, tuned.out.find("  or, brisker") - from);
    std::string printer = text_of(fs::path(LYR_FIXTURES) / "printers/generic.toml");
    printer.replace(printer.find("[heater.tool]"), 13, lines);
    folder.write("p.toml", printer);
    fs::copy_file(write_heated("tuned"), folder / "a.lyr");
    CHECK(folder.run("lyrrun a.lyr --simulate --printer p.toml").status == 0);
    check_lyrrun_failure(folder.run("lyrrun --tune tool=210"), 2, "--printer");
    check_lyrrun_failure(folder.run("lyrrun --tune tool --simulate"), 2, "tool, bed or chamber");
    check_lyrrun_failure(folder.run("lyrrun --tune nose=20 --simulate"), 2, "tool, bed or chamber");
    check_lyrrun_failure(folder.run("lyrrun --tune tool=nan --simulate"), 2,
                         "tool, bed or chamber");
    check_lyrrun_failure(folder.run("lyrrun a.lyr --tune tool=210 --simulate"), 2,
                         "without a print");
    check_lyrrun_failure(folder.run("lyrrun --tune chamber=40 --simulate"), 7, "no heater.chamber");
    check_lyrrun_failure(folder.run("lyrrun --tune tool=274 --simulate"), 7, "range_c");
    // It took two hours to find that out.
    check_lyrrun_failure(folder.run("lyrrun --tune tool=5 --simulate"), 7,
                         "must cool down below its target");
    check_lyrrun_failure(folder.run("lyrrun --tune bed=60 --printer p.toml"), 7,
                         "heater.tool.sensor.file");
    check_lyrrun_failure(
        folder.run("echo 10 no_power bed | lyrrun --tune bed=60 --simulate --faults -"), 7,
        "heater bed");
}

TEST_CASE("lyrrun: a trace never takes the place of the print or of the printer's file") {
    const Folder folder("lyrrun-files");
    fs::copy_file(write_print("files", {draw_square}), folder / "a.lyr");
    folder.copy("printers/generic.toml", "p.toml");
    fs::create_symlink("a.lyr", folder / "link.lyr");
    fs::create_symlink("p.toml", folder / "link.toml");
    fs::create_hard_link(folder / "p.toml", folder / "hard.toml");
    const std::string lyr = text_of(folder / "a.lyr"), printer = text_of(folder / "p.toml");
    for (const char* trace :
         {"a.lyr", "./a.lyr", "link.lyr", "p.toml", "link.toml", "hard.toml", "$PWD/p.toml"}) {
        CAPTURE(trace);
        check_lyrrun_failure(
            folder.run("lyrrun a.lyr --simulate --printer p.toml --trace " + std::string(trace)), 2,
            "the trace would overwrite the print");
    }
    check_lyrrun_failure(
        folder.run("lyrrun link.lyr --simulate --printer link.toml --trace hard.toml"), 2,
        "the trace would overwrite the printer's file");
    check_lyrrun_failure(folder.run("lyrrun a.lyr --simulate --trace - >> a.lyr"), 2,
                         "the trace would overwrite the print: standard output");
    CHECK(text_of(folder / "a.lyr") == lyr);
    CHECK(text_of(folder / "p.toml") == printer);
    CHECK(folder.files().size() == 5);
    CHECK(folder.run("lyrrun a.lyr --simulate --no-heat --printer p.toml --trace t.vcd").status ==
          0);
}

TEST_CASE("lyrrun: - is standard output for the trace and standard input for the printer") {
    const Folder folder("lyrrun-streams");
    fs::copy_file(write_print("streams", {draw_square, draw_arcs}), folder / "a.lyr");
    folder.copy("printers/cartesian.toml", "p.toml");
    const Ended named =
        folder.run("lyrrun a.lyr --simulate --no-heat --printer p.toml --trace t.vcd");
    CHECK(named.status == 0);
    CHECK(named.err.empty());
    for (const char* name : {"-", "/dev/stdout"}) {
        const Ended streams =
            folder.run("cat p.toml | lyrrun a.lyr --simulate --no-heat --printer - --trace " +
                       std::string(name));
        CHECK(streams.status == 0);
        CHECK(streams.out == text_of(folder / "t.vcd"));
        CHECK(streams.err == named.out);
    }
    folder.write("bad.toml", "[axis.q]\n");
    check_lyrrun_failure(folder.run("lyrrun a.lyr --simulate --printer - < bad.toml"), 3,
                         "standard input:1");
}

TEST_CASE("lyrrun: output that cannot be written is status 6 and says why") {
    const std::string file = write_print("full", {draw_square, draw_arcs, draw_hatch});
    check_lyrrun_failure(lyrrun(file + " --simulate --no-heat --trace /dev/full"), 6,
                         "No space left on device");
    check_lyrrun_failure(lyrrun(file + " --simulate --no-heat >/dev/full"), 6,
                         "No space left on device");
    check_lyrrun_failure(lyrrun(file + " --simulate --no-heat >&-"), 6, "standard output");
}
