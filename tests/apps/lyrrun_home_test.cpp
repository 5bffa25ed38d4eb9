// Homing and jogging from the outside.

#include "apps/program.h"
#include "target/run/print_files.h"

using namespace lyr;
using namespace lyr::tests;

namespace {

const std::string axes =
    "[axis.x]\nsteps_per_mm = 80\nmax_speed_mm_s = 200\nmax_acceleration_mm_s2 = 3000\n"
    "range_mm = [0, 120]\nendstop = { line = 5, pull = \"up\", active_low = true }\n"
    "[axis.y]\nsteps_per_mm = 80\nmax_speed_mm_s = 150\nmax_acceleration_mm_s2 = 3000\n"
    "range_mm = [0, 120]\nendstop = 6\nendstop_end = \"high\"\n"
    "[axis.z]\nsteps_per_mm = 400\nmax_speed_mm_s = 10\nmax_acceleration_mm_s2 = 300\n"
    "range_mm = [0, 80]\nendstop = 7\n"
    "[axis.e]\nsteps_per_mm = 415\nmax_speed_mm_s = 40\nmax_acceleration_mm_s2 = 5000\n";

Folder with_printer(const std::string& more = "") {
    Folder folder("home");
    folder.write("p.toml", "name = \"tiny\"\n" + more + axes);
    return folder;
}

// What a simulation shows, kept by hand.
void keep(const Folder& folder, const std::string& name, const Ended& found) {
    const std::size_t at = found.out.find("\n\n");
    REQUIRE(at != std::string::npos);
    folder.write(name, found.out.substr(at + 2));
}

}  // namespace

TEST_CASE("lyrrun --home: says what was homed and where the head is") {
    const Folder folder = with_printer("start_mm = [10, 20, 5]\n");
    const Ended all = folder.run("lyrrun --home --simulate --printer p.toml");
    CHECK(all.status == 0);
    CHECK(all.err.empty());
    CHECK(all.out.find("homed xyz in ") != std::string::npos);
    CHECK(all.out.find("the head is at x 10.000, y 20.000, z 5.000 mm") != std::string::npos);
    const Ended one = folder.run("lyrrun --home x --simulate --printer p.toml");
    CHECK(one.status == 0);
    CHECK(one.out.find("homed x in ") != std::string::npos);
    // It told y and z, too, as if they had been homed.
    CHECK(one.out.find("the head is at x 10.000 mm; where it is else was not found\n") !=
          std::string::npos);
}

TEST_CASE("lyrrun --jog: from the start of a print, within the ranges") {
    const Folder folder = with_printer("start_mm = [10, 20, 5]\n");
    const Ended good = folder.run("lyrrun --jog x=10,z=-1.5 --simulate --printer p.toml");
    CHECK(good.status == 0);
    CHECK(good.out.find("x 20.000, y 20.000, z 3.500") != std::string::npos);
    check_failure(folder.run("lyrrun --jog x=-11 --simulate --printer p.toml"), "lyrrun", 7,
                  "x would go to -1 mm, and axis.x.range_mm is 0 to 120");
    check_failure(folder.run("lyrrun --jog x=1,x=2 --simulate --printer p.toml"), "lyrrun", 2,
                  "x=10,z=-1");
    const Ended free = Folder("jog").run("lyrrun --jog y=-3 --simulate");
    CHECK(free.status == 0);
    CHECK(free.out.find("y -3.000") != std::string::npos);
}

TEST_CASE("lyrrun --jog e: pushes filament with a warm tool, or draws it out") {
    const Folder folder = with_printer();
    folder.write("hot.toml",
                 text_of(folder / "p.toml") + "[heater.tool.sensor]\nkind = \"ntc_100k_3950\"\n");
    const std::string jog = "lyrrun --simulate --printer hot.toml --jog ";
    const Ended pushed = folder.run(jog + "e=20 --tool 210");
    CHECK(pushed.status == 0);
    CHECK(pushed.err.empty());
    CHECK(pushed.out.find("filament: 20 mm at 2 mm/s, 8300 steps") != std::string::npos);
    const Ended drawn = folder.run(jog + "e=-10 --tool 210");
    CHECK(drawn.out.find("-10 mm at 2 mm/s, -4150 steps") != std::string::npos);
    for (const char* cold : {"e=20", "e=20 --tool 100", "e=20 --tool 400"})
        check_failure(folder.run(jog + cold), "lyrrun", 7, "with the tool at 170 to ");
    check_failure(folder.run("lyrrun --simulate --printer p.toml --jog e=20 --tool 210"), "lyrrun",
                  7, "has no heater.tool");
    CHECK(folder.run("lyrrun --simulate --printer p.toml --jog e=20").status == 0);
    check_failure(folder.run(jog + "e=20,x=1 --tool 210"), "lyrrun", 2, "e=20 alone");
    check_failure(folder.run(jog + "x=1 --tool 210"), "lyrrun", 2, "--tool goes with --jog e=MM");
    check_failure(folder.run(jog + "e=20 --tool 210 --home"), "lyrrun", 2, "goes alone");
    // A guard takes the heat away, while it heats and while filament is pushed.
    for (const char* fault : {"5 open tool\n", "80 open tool\n"}) {
        folder.write("f.txt", fault);
        check_failure(folder.run(jog + "e=200 --tool 210 --faults f.txt"), "lyrrun", 7,
                      "heater tool");
    }
}

TEST_CASE("lyrrun --home: faults come with their message and status 7") {
    const Folder folder = with_printer();
    const auto broken = [&](const char* faults) {
        folder.write("f.txt", faults);
        return folder.run("lyrrun --home --simulate --printer p.toml --faults f.txt");
    };
    check_failure(broken("0 dead y\n"), "lyrrun", 7, "endstop y has not triggered within 130.0 mm");
    check_failure(broken("0 stuck z\n"), "lyrrun", 7, "endstop z is still triggered");
    CHECK(broken("0 bounce x 1.5\n").status == 0);
    check_failure(broken("1 dead q\n"), "lyrrun", 3, "no endstop or probe \"q\"");
    check_failure(broken("1 dead probe\n"), "lyrrun", 3, "no endstop or probe \"probe\"");
    check_failure(broken("1 ded x\n"), "lyrrun", 3, "did you mean `dead`?");
    check_failure(broken("1 bounce x\n"), "lyrrun", 3, "takes an endstop's axis and a value");
}

TEST_CASE("lyrrun: a print is homed first, unless the printer says not to") {
    const std::string print = write_print("homed", {draw_square}, {0, false, 60, 60});
    const auto simulated = [&](const std::string& more, const char* faults) {
        const Folder folder = with_printer(more);
        folder.write("f.txt", faults);
        return folder.run("lyrrun " + print + " --simulate --printer p.toml --faults f.txt");
    };
    const Ended homed = simulated("", "");
    CHECK(homed.status == 0);
    CHECK(homed.out.find("homed xyz in ") != std::string::npos);
    check_failure(simulated("", "0 dead x\n"), "lyrrun", 7, "endstop x has not triggered");
    CHECK(simulated("homing.before_print = false\n", "0 dead x\n").status == 0);
}

TEST_CASE("lyrrun --home: options that make no sense together, and printers that cannot") {
    const Folder folder = with_printer();
    check_failure(folder.run("lyrrun --home --tune bed=60 --simulate --printer p.toml"), "lyrrun",
                  2, "--tune goes without");
    check_failure(folder.run("lyrrun --home --json --simulate --printer p.toml"), "lyrrun", 2,
                  "go without a print and what is said of one");
    check_failure(folder.run("lyrrun --home"), "lyrrun", 2, "--printer");
    check_failure(folder.run("lyrrun --home --simulate"), "lyrrun", 7, "axis.x.endstop");
    check_failure(folder.run("lyrrun --home --printer p.toml"), "lyrrun", 7, "axis.x.step");
}

TEST_CASE("lyrrun --calibrate: a simulation wrote over what the machine was calibrated to") {
    const Folder folder("calibrate-kept");
    folder.write("p.toml", "calibration_file = \"found.toml\"\n" + axes + "[probe]\ninput = 9\n");
    const std::string real = "[probe]\noffset_mm = [0, 0, 1.25]\n";
    folder.write("found.toml", real);
    const Ended shown = folder.run("lyrrun --calibrate mesh --simulate --printer p.toml");
    CHECK(shown.status == 0);
    CHECK(shown.out.find("not kept in found.toml") != std::string::npos);
    CHECK(text_of(folder / "found.toml") == real);
}

TEST_CASE("lyrrun --calibrate: a print follows what was found") {
    const Folder folder("calibrate");
    const std::string head = "name = \"crooked\"\ncalibration_file = \"found.toml\"\n";
    const std::string tail =
        "[probe]\ninput = 9\noffset_mm = [3, -4, 1.5]\n[mesh]\npoints = [3, 4]\n"
        "area_mm = [10, 10, 110, 110]\n[simulate]\nbed_tilt = [0.002, 0.001]\n"
        "bumps = [[60, 60, 0.2, 40]]\n";
    folder.write("p.toml", head + axes + tail);
    const Ended found = folder.run("lyrrun --calibrate mesh --simulate --printer p.toml");
    CHECK(found.status == 0);
    CHECK(found.err.empty());
    CHECK(found.out.find("the bed is from 0.0") != std::string::npos);
    CHECK(found.out.find("heights_mm = [") != std::string::npos);
    keep(folder, "found.toml", found);
    const std::string print = write_print("followed", {draw_square, draw_arcs}, {0, false, 60, 60});
    const Ended printed = folder.run("lyrrun " + print + " --simulate --printer p.toml");
    CHECK(printed.status == 0);
    CHECK(printed.out.find("within half a microstep everywhere") != std::string::npos);
    // With z by an endstop the probe's own height can be found, and the mesh stays.
    const Ended probed = folder.run("lyrrun --calibrate probe --simulate --printer p.toml");
    CHECK(probed.status == 0);
    CHECK(probed.out.find("heights_mm") != std::string::npos);
    CHECK(probed.out.find("offset_mm = [3.0000, -4.0000, ") != std::string::npos);
}

TEST_CASE("lyrrun --calibrate: the sample delta, perturbed, from the outside") {
    const Folder folder("calibrate-delta");
    folder.write("p.toml", text_of(LYR_FIXTURES "/printers/delta.toml") +
                               "[simulate]\nradius_error_mm = [0.5, 0.5, 0.5]\n"
                               "endstop_error_mm = [0.3, 0, -0.2]\n");
    const Ended first = folder.run("lyrrun --calibrate delta --simulate --printer p.toml");
    CHECK(first.status == 0);
    CHECK(first.out.find("the bed was found up to 0.") != std::string::npos);
    CHECK(first.out.find("with this frame it is 0.00") != std::string::npos);
    keep(folder, "delta-calibration.toml", first);
    const Ended second = folder.run("lyrrun --calibrate delta --simulate --printer p.toml");
    CHECK(second.out.find("the bed was found up to 0.00") != std::string::npos);
}

TEST_CASE("lyrrun --calibrate: without a file to keep it in the TOML is on standard output") {
    const Folder folder("calibrate-shown");
    folder.write("p.toml", axes + "[probe]\ninput = 9\n[mesh]\npoints = [2, 2]\n");
    const Ended shown = folder.run("lyrrun --calibrate --simulate --printer p.toml");
    CHECK(shown.status == 0);
    CHECK(shown.out.find("[mesh]\narea_mm = [0.0000, 0.0000, 120.0000, 120.0000]") !=
          std::string::npos);
    check_failure(folder.run("lyrrun --calibrate mash --simulate --printer p.toml"), "lyrrun", 2,
                  "probe, delta or mesh");
    check_failure(folder.run("lyrrun --calibrate delta --simulate --printer p.toml"), "lyrrun", 7,
                  "kinematics");
    folder.write("f.txt", "20 dead probe\n");
    check_failure(folder.run("lyrrun --calibrate mesh --simulate --printer p.toml --faults f.txt"),
                  "lyrrun", 7, "the probe has not triggered within");
    check_failure(folder.run("lyrrun --calibrate --home --simulate --printer p.toml"), "lyrrun", 2,
                  "homes by itself");
}
