// stepc straight to another format: as by way of a .lyr file.

#include <cmath>
#include <numbers>

#include "apps/program.h"
#include "format/export/gcode_machine.h"
#include "format/reader.h"

using namespace lyr;
using namespace lyr::tests;

TEST_CASE("stepc: G-code from the model is that of the print") {
    const Folder folder("stepc-gcode");
    folder.copy("parts/cube_hole.step", "a.step");
    const std::string set =
        " --set gcode.flavor=klipper --set gcode.start=G28,T={nozzle_temperature}";
    REQUIRE(folder.run("stepc a.step -o a.lyr" + set).status == 0);
    REQUIRE(folder.run("lyrview a.lyr -o b.gcode").status == 0);
    const Ended direct = folder.run("stepc a.step -o a.gcode" + set);
    CHECK(direct.status == 0);
    const std::string text = text_of(folder / "a.gcode");
    CHECK(text == text_of(folder / "b.gcode"));
    CHECK(text.find("\nG28\nT=210\n") != std::string::npos);
    CHECK(text.find("\n; nozzle_diameter = 0.4\n") != std::string::npos);
    CHECK(direct.out.find("a.gcode: " + std::to_string(text.size()) + " bytes") !=
          std::string::npos);
    CHECK(folder.run("stepc a.step -o - --to gcode" + set).out == text);
    CHECK(folder.files() == std::set<std::string>{"a.step", "a.lyr", "a.gcode", "b.gcode"});
}

TEST_CASE("stepc: each layer's G-code extrudes the layer's volume within 0.1 %") {
    const Folder folder("stepc-gcode-volume");
    folder.copy("parts/gearbox_base.step", "a.step");
    REQUIRE(folder.run("stepc a.step -o a.lyr --set travel.wipe=2").status == 0);
    auto reader = format::Reader::open((folder / "a.lyr").string());
    REQUIRE(reader.ok());
    std::vector<double> volume_mm3;
    while (const format::Operation* operation = reader->read())
        if (std::holds_alternative<format::LayerStart>(*operation))
            volume_mm3.push_back(reader->layer().totals.volume_mm3);
    const double diameter_mm = reader->header().metadata.filament_diameter_mm;
    for (const char* options : {"", " --gcode-flavor klipper --gcode-e absolute"}) {
        REQUIRE(folder.run("lyrview a.lyr -o a.gcode" + std::string(options)).status == 0);
        std::vector<double> filament_mm(volume_mm3.size() + 1);
        for (const auto& move : format::test::GcodeMachine(text_of(folder / "a.gcode")).moves)
            if (move.moves() && !move.wipes)
                filament_mm.at(static_cast<std::size_t>(move.layer)) += move.filament_mm;
        for (std::size_t i = 0; i < volume_mm3.size(); ++i) {
            CAPTURE(i);
            CHECK(filament_mm[i + 1] * std::numbers::pi / 4 * diameter_mm * diameter_mm ==
                  doctest::Approx(volume_mm3[i]).epsilon(0.001));
        }
    }
}

TEST_CASE("stepc: layers for other machines, from the model") {
    const Folder folder("stepc-slices");
    folder.copy("parts/cube_hole.step", "a.step");
    CHECK(folder.run("stepc a.step -o a.cli").status == 0);
    CHECK(folder.run("stepc a.step -o a.3mf").status == 0);
    CHECK(text_of(folder / "a.cli").find("$$LABEL/1,a.step\n") != std::string::npos);
    CHECK(text_of(folder / "a.3mf").starts_with("PK"));
}

TEST_CASE("stepc: what it does not write is refused before it slices") {
    const Folder folder("stepc-export-wrong");
    folder.copy("parts/cube_hole.step", "a.step");
    check_failure(folder.run("stepc a.step -o a.svg"), "stepc", 2, "draws no layers");
    check_failure(folder.run("stepc a.step --to gcode"), "stepc", 2, "--to needs -o");
    check_failure(folder.run("stepc a.step -o x --to foo"), "stepc", 2, "expected one of");
    check_failure(folder.run("stepc a.step -o missing/a.gcode"), "stepc", 6, "missing/a.gcode");
    CHECK(folder.files() == std::set<std::string>{"a.step"});
}
