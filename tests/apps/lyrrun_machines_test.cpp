// The sample printers, as a user would try them.

#include "apps/program.h"
#include "target/run/print_files.h"

using namespace lyr;
using namespace lyr::tests;

namespace {

Ended simulated(const std::string& print, const std::string& printer) {
    return Folder("machines").run("lyrrun " + print + " --simulate --no-heat --printer " + printer);
}

}  // namespace

TEST_CASE("lyrrun: the sample CoreXY and delta print, every pulse within half a microstep") {
    const std::string print = write_print(
        "samples", {draw_square, draw_arcs, draw_circles, draw_climb}, {0, false, 60, 40});
    for (const char* printer : {"corexy", "delta", "cartesian"}) {
        CAPTURE(printer);
        const Ended ended =
            simulated(print, std::string(LYR_FIXTURES "/printers/") + printer + ".toml");
        CHECK(ended.status == 0);
        CHECK(ended.out.find("within half a microstep everywhere") != std::string::npos);
    }
}

TEST_CASE("lyrrun: a part beyond a delta's arms is refused with layer and distance") {
    const std::string print = write_print("corner", {draw_square}, {0, false, 85, 85});
    const Ended ended = simulated(print, LYR_FIXTURES "/printers/delta.toml");
    check_failure(ended, "lyrrun", 7, "from the middle of the bed");
    CHECK(ended.err.find("layer 1") != std::string::npos);
}

TEST_CASE("lyrrun: a slip in a machine's keys comes with its line and the key that was meant") {
    const Folder folder("slip");
    folder.write("p.toml", "kinematics = \"delta\"\n[delta]\narm_mm = 250\nradus_mm = 120\n");
    const Ended ended = folder.run("lyrrun " + write_print("slip", {draw_square}) +
                                   " --simulate --no-heat --printer p.toml");
    check_failure(ended, "lyrrun", 3, "p.toml:4");
    CHECK(ended.err.find("did you mean `radius_mm`?") != std::string::npos);
}

TEST_CASE("lyrrun: over a crooked bed every pulse is within half a microstep of the lifted path") {
    const Folder folder("mesh");
    const std::string print =
        write_print("mesh", {draw_square, draw_arcs, draw_circles, draw_climb}, {0, false, 60, 40});
    for (const char* printer : {"corexy", "delta", "cartesian"}) {
        CAPTURE(printer);
        folder.write(
            "calibration.toml",
            "[mesh]\narea_mm = [40, 20, 85, 65]\npoints = [3, 4]\nfade_mm = 0.6\n"
            "heights_mm = [[0, 0.3, -0.2], [0.1, 0.2, 0.4], [-0.3, 0, 0.1], [0, 0, 0.2]]\n");
        std::string text = text_of(std::string(LYR_FIXTURES "/printers/") + printer + ".toml");
        if (const std::size_t at = text.find("calibration_file"); at != std::string::npos)
            text.erase(at, text.find('\n', at) - at);
        folder.write("p.toml", "calibration_file = \"calibration.toml\"\n" + text);
        const Ended ended =
            folder.run("lyrrun " + print + " --simulate --no-heat --printer p.toml");
        CHECK(ended.status == 0);
        CHECK(ended.err.empty());
        CHECK(ended.out.find("within half a microstep everywhere") != std::string::npos);
    }
}

TEST_CASE("lyrrun: a ratio of cruising costs time, and every pulse is within half a microstep") {
    const Folder folder("cruise");
    const std::string print = write_print(
        "cruise", {draw_square, draw_arcs, draw_circles, draw_climb}, {0, false, 60, 40});
    for (const char* printer : {"corexy", "delta", "cartesian"}) {
        CAPTURE(printer);
        double last_s = 0;
        for (const char* ratio : {"0", "0.5", "0.9"}) {
            folder.write("p.toml",
                         std::string("minimum_cruise_ratio = ") + ratio + '\n' +
                             text_of(std::string(LYR_FIXTURES "/printers/") + printer + ".toml"));
            const Ended text =
                folder.run("lyrrun " + print + " --simulate --no-heat --printer p.toml");
            CHECK(text.status == 0);
            CHECK(text.out.find("within half a microstep everywhere") != std::string::npos);
            const Ended ended =
                folder.run("lyrrun " + print + " --simulate --no-heat --json --printer p.toml");
            const std::string key = "\"print_time_s\":";
            const std::size_t at = ended.out.find(key);
            REQUIRE(at != std::string::npos);
            const double time_s = std::stod(ended.out.substr(at + key.size()));
            CHECK(time_s > last_s);
            last_s = time_s;
        }
    }
}
