// Copies on the plate and wiping, as a user asks for them, up to the printer's controller.

#include <doctest/doctest.h>

#include <cmath>
#include <regex>
#include <string>

#include "program.h"

using namespace lyr::tests;

namespace {

// "time 1 h 02 min 03 s"
double stated_time_s(const std::string& text) {
    static const std::regex time(R"(time (\d+) h (\d+) min (\d+) s)");
    std::smatch found;
    REQUIRE_MESSAGE(std::regex_search(text, found, time), text);
    return 3600 * std::stod(found[1]) + 60 * std::stod(found[2]) + std::stod(found[3]);
}

}  // namespace

TEST_CASE("stepc: prints that wipe and prints of copies simulate, in the time that stepc tells") {
    const Folder folder("stepc-plate");
    folder.copy("parts/transmission_pulley_at3_t10_center.step", "p.step");
    const std::string slice =
        "stepc p.step --layer-height 0.4 --set adhesion.kind=brim --at 20,20 ";
    for (const std::string wishes :
         {"--set travel.wipe=2 --set travel.retract_before_wipe=50%", "--set plate.copies=4",
          "--set plate.copies=3 --set plate.sequential=true --set travel.wipe=2 --set "
          "travel.z_hop=0.3"}) {
        CAPTURE(wishes);
        const Ended sliced = folder.run(slice + wishes);
        CAPTURE(sliced.err);
        REQUIRE(sliced.status == 0);
        const Ended simulated = folder.run("lyrrun p.lyr --simulate --json");
        REQUIRE(simulated.status == 0);
        const double simulated_s = number_after(simulated.out, "\"print_time_s\":");
        CHECK(std::abs(stated_time_s(sliced.out) - simulated_s) < 0.01 * simulated_s);
    }
}

TEST_CASE("stepc: what was placed is told, and shown by lyrview") {
    const Folder folder("stepc-placed");
    folder.copy("parts/cube_hole.step", "p.step");
    const std::string slice = "stepc p.step --layer-height 0.4 --set plate.copies=4 ";
    const Ended by_layer = folder.run(slice);
    REQUIRE(by_layer.status == 0);
    CHECK(by_layer.out.find("\n4 copies in 2 rows, 6 mm apart, layer by layer\n") !=
          std::string::npos);
    CHECK(folder.run("lyrview p.lyr --info").out.find("p.step 4\n") != std::string::npos);
    CHECK(folder.run("lyrview p.lyr --layer 1").out.find("p.step, 0.4 mm thick") !=
          std::string::npos);
    const double layers = number_after(by_layer.out, "faces\n");
    const Ended in_sequence = folder.run(slice + "--set plate.sequential=true");
    REQUIRE(in_sequence.status == 0);
    CHECK(in_sequence.out.find("mm apart, one after the other\n") != std::string::npos);
    const std::string info = folder.run("lyrview p.lyr --info").out;
    CHECK(number_after(info, "layers        ") == 4 * layers);
    CHECK(number_after(info, ", z ") == doctest::Approx(0.4));
    // The first layer of the second copy.
    const auto second = static_cast<int>(layers) + 1;
    const std::string picture = folder.run("lyrview p.lyr --layer " + std::to_string(second)).out;
    CHECK(picture.find("Layer " + std::to_string(second) + " of ") != std::string::npos);
    CHECK(picture.find("z = 0.400 mm") != std::string::npos);
    CHECK(picture.find("p.step 2, 0.4 mm thick") != std::string::npos);
}

TEST_CASE("stepc: copies that do not fit are refused with how many would, a skirt beside is told") {
    const Folder folder("stepc-misfit");
    folder.copy("parts/cube_hole.step", "p.step");
    const auto files = folder.files();
    const auto refused = [&](const std::string& wishes, const std::string& part) {
        check_failure(folder.run("stepc p.step " + wishes), "stepc", 5, part);
        CHECK(folder.files() == files);
    };
    refused("--set plate.copies=50 --set plate.size=200,200", "would (plate.copies");
    refused("--set plate.copies=4 --set plate.size=100,100 --set plate.sequential=true",
            "plate.clearance_radius");
    const Ended beside =
        folder.run("stepc p.step --set plate.size=200,200 --set adhesion.kind=skirt");
    CHECK(beside.status == 0);
    CHECK(beside.err.find("the skirt reaches 6.45 mm beyond the plate") != std::string::npos);
    const Ended within =
        folder.run("stepc p.step --set plate.size=200,200 --set adhesion.kind=skirt --at 10,10");
    CHECK(within.err.empty());
}

TEST_CASE("stepc: a wipe without a retraction to wipe on is told, and nothing is wiped") {
    const Folder folder("stepc-no-wipe");
    folder.copy("parts/transmission_pulley_at3_t10_center.step", "p.step");
    const std::string slice = "stepc p.step --layer-height 0.4 --set travel.wipe=2 ";
    const Ended none = folder.run(slice + "--set travel.retract_length=0");
    CHECK(none.status == 0);
    CHECK(none.err.find("travel.wipe: nothing is wiped") != std::string::npos);
    CHECK(folder.run("lyrview p.lyr --info").out.find("\nwipe ") == std::string::npos);
    CHECK(folder.run(slice).err.find("wipe") == std::string::npos);
    CHECK(folder.run("lyrview p.lyr --info").out.find("\nwipe ") != std::string::npos);
    CHECK(folder.run("lyrview p.lyr --layer 3").out.find("<path id=\"wipes\"") !=
          std::string::npos);
    CHECK(folder.run("lyrview p.lyr --layer 3 --no-travel").out.find("wipe") == std::string::npos);
}

TEST_CASE("stepc: what leaves the printer's ranges is told as the printer would refuse it") {
    const Folder folder("stepc-range");
    folder.copy("parts/cube_hole.step", "p.step");
    folder.copy("printers/cartesian.toml", "printer.toml");
    folder.copy("printers/delta.toml", "delta.toml");
    const std::string slice = "stepc p.step --set adhesion.kind=skirt ";
    const Ended beside = folder.run(slice + "--printer printer.toml");
    CHECK(beside.status == 0);
    for (const std::string axis : {"x", "y"}) {
        const std::string told = " mm on axis " + axis + ", and axis." + axis + ".range_mm of the";
        CHECK_MESSAGE(beside.err.find(told) != std::string::npos, beside.err);
    }
    CHECK(beside.err.find("axis.z.range_mm") == std::string::npos);
    const double beyond_mm = number_after(beside.err, "the print goes to ");
    CHECK(beyond_mm < 0);
    const Ended refused = folder.run("lyrrun p.lyr --simulate --printer printer.toml");
    CHECK(refused.status == 7);
    CHECK(number_after(refused.err, "the path goes to ") ==
          doctest::Approx(beyond_mm).epsilon(1e-3));
    // Without the printer nobody knows its ranges.
    CHECK(folder.run(slice).err.empty());
    const Ended within = folder.run(slice + "--printer printer.toml --at 20,20");
    CHECK(within.err.empty());
    CHECK(folder.run("lyrrun p.lyr --simulate --printer printer.toml").status == 0);
    const Ended far = folder.run("stepc p.step --printer delta.toml --at 90,0");
    CHECK_MESSAGE(far.err.find("(delta.reach_mm); plate.at") != std::string::npos, far.err);
    CHECK(folder.run("lyrrun p.lyr --simulate --printer delta.toml").status == 7);
}
