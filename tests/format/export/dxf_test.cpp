// Drawings of whole layers: read back group by group and compared with the file's motions.

#include "format/export/dxf.h"

#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <sstream>

#include "../../target/run/print_files.h"
#include "../files.h"
#include "format/arc.h"
#include "format/export/svg.h"

using namespace lyr;
using namespace lyr::format;

namespace {

struct Entity {
    std::string kind, layer;
    std::map<int, double> numbers;
};

struct Dxf {
    std::vector<Entity> entities;
    std::set<std::string> layers;  // of the table
    std::string version;
    bool ended = false;
};

// What the reference of the format asks for: pairs of lines, sections, tables.
Dxf read_dxf(const std::string& text) {
    Dxf dxf;
    std::istringstream in(text);
    std::string code, value, section, variable;
    bool in_layer_table = false;
    while (std::getline(in, code)) {
        REQUIRE(std::getline(in, value));
        REQUIRE(!dxf.ended);
        const int number = std::stoi(code);
        if (number == 999) continue;
        if (number == 0) {
            dxf.ended = value == "EOF";
            in_layer_table = value == "LAYER";
            if (section == "ENTITIES" && value != "ENDSEC" && value != "EOF")
                dxf.entities.push_back({value, {}, {}});
            if (value == "ENDSEC") section.clear();
        } else if (number == 2 && section.empty()) {
            section = value;
        } else if (number == 2 && in_layer_table) {
            CHECK(dxf.layers.insert(value).second);
        } else if (number == 9) {
            variable = value;
        } else if (variable == "$ACADVER" && number == 1) {
            dxf.version = value;
        } else if (section == "ENTITIES") {
            if (number == 8)
                dxf.entities.back().layer = value;
            else
                dxf.entities.back().numbers[number] = std::stod(value);
        }
    }
    return dxf;
}

std::string dxf_of(const std::string& path, const DxfOptions& options) {
    auto reader = Reader::open(path);
    REQUIRE(reader.ok());
    std::string text;
    REQUIRE(write_dxf(*reader, options, [&](std::string_view piece) { text += piece; }).ok());
    return text;
}

void check_point(const Entity& entity, int code, double x_mm, double y_mm) {
    CHECK(entity.numbers.at(code) == doctest::Approx(x_mm).scale(100).epsilon(1e-9));
    CHECK(entity.numbers.at(code + 10) == doctest::Approx(y_mm).scale(100).epsilon(1e-9));
}

// An arc's end at an angle of the drawing.
void check_end(const Entity& arc, int code, const Point& end) {
    const double angle = arc.numbers.at(code) * std::numbers::pi / 180;
    const double x = arc.numbers.at(10) + arc.numbers.at(40) * std::cos(angle);
    const double y = arc.numbers.at(20) + arc.numbers.at(40) * std::sin(angle);
    CHECK(std::hypot(x - Quantum{}.mm(end.x), y - Quantum{}.mm(end.y)) < 1e-5);
}

// The entities are the motions of one layer, or of all.
void check_entities(const std::string& path, const Dxf& dxf, std::optional<std::uint32_t> layer) {
    auto reader = Reader::open(path);
    REQUIRE(reader.ok());
    std::size_t at = 0;
    while (const Operation* operation = reader->read()) {
        if (layer && reader->layer().index != *layer) continue;
        const auto* line = std::get_if<Line>(operation);
        const auto* arc = std::get_if<Arc>(operation);
        const auto* circle = std::get_if<Circle>(operation);
        if (!line && !arc && !circle) continue;
        REQUIRE(at < dxf.entities.size());
        const Entity& entity = dxf.entities[at++];
        CHECK(entity.layer.ends_with("OUTER_WALL"));
        CHECK(dxf.layers.contains(entity.layer));
        if (line) {
            REQUIRE(entity.kind == "LINE");
            check_point(entity, 10, Quantum{}.mm(line->from.x), Quantum{}.mm(line->from.y));
            check_point(entity, 11, Quantum{}.mm(line->to.x), Quantum{}.mm(line->to.y));
        } else if (circle) {
            REQUIRE(entity.kind == "CIRCLE");
            check_point(entity, 10, Quantum{}.mm(circle->center_x), Quantum{}.mm(circle->center_y));
        } else {
            REQUIRE(entity.kind == "ARC");
            const bool left = arc->sagitta > 0;
            check_end(entity, left ? 50 : 51, arc->from);
            check_end(entity, left ? 51 : 50, arc->to);
            double sweep = entity.numbers.at(51) - entity.numbers.at(50);
            if (sweep < 0) sweep += 360;
            CHECK(sweep * std::numbers::pi / 180 ==
                  doctest::Approx(std::abs(arc_shape(*arc).sweep_rad)).epsilon(1e-6));
        }
    }
    CHECK(at == dxf.entities.size());
}

}  // namespace

TEST_CASE("dxf 1, 2: entities are the motions of a layer, turned and mirrored") {
    for (const tests::Frame& frame :
         {tests::Frame{}, tests::Frame{0.7, false, 90, 80}, tests::Frame{2.1, true, 120, 60}})
        for (const tests::Case& drawn : tests::all_cases()) {
            CAPTURE(std::string(drawn.name));
            const std::string path =
                tests::write_print("dxf", {drawn.drawing, tests::draw_square}, frame);
            for (const std::uint32_t layer : {0u, 1u}) {
                const Dxf dxf = read_dxf(dxf_of(path, {.layer = layer, .travels = false}));
                CHECK(dxf.version == "AC1009");
                CHECK(dxf.ended);
                check_entities(path, dxf, layer);
            }
            check_entities(path, read_dxf(dxf_of(path, {.layer = {}, .travels = false})), {});
        }
}

TEST_CASE("dxf 1: travels lie on a layer of their own, and each print layer has its own") {
    const std::string path =
        tests::write_print("dxf_travels", {tests::draw_hatch, tests::draw_wipes});
    std::set<std::string> used;
    for (const Entity& entity : read_dxf(dxf_of(path, {})).entities) used.insert(entity.layer);
    CHECK(used == std::set<std::string>{"1_OUTER_WALL", "1_TRAVEL", "2_OUTER_WALL", "2_TRAVEL"});
    used.clear();
    for (const Entity& entity : read_dxf(dxf_of(path, {.layer = 1})).entities)
        used.insert(entity.layer);
    CHECK(used == std::set<std::string>{"OUTER_WALL", "TRAVEL"});
}

TEST_CASE("svg: all layers in one picture are the layers' own groups, one shown") {
    const std::string path =
        tests::write_print("svg_all", {tests::draw_square, tests::draw_arcs, tests::draw_circles});
    auto reader = Reader::open(path);
    REQUIRE(reader.ok());
    std::string text;
    REQUIRE(print_svg(*reader, {}, [&](std::string_view piece) { text += piece; }).ok());
    CHECK(text.ends_with("</svg>\n"));
    const auto count = [&](const std::string& part) {
        std::size_t found = 0;
        for (std::size_t at = 0; (at = text.find(part, at)) != text.npos; ++at) ++found;
        return found;
    };
    CHECK(count("inkscape:groupmode=\"layer\"") == 3);
    CHECK(count("style=\"display:none\"") == 2);
    CHECK(count("<g") == count("</g>"));
    CHECK(text.find("inkscape:label=\"3, z = 0.6 mm\"") != text.npos);
    // The same drawing as that of a layer by itself, and no name twice.
    std::set<std::string> names;
    for (std::size_t at = 0; (at = text.find(" id=\"", at)) != text.npos; ++at)
        CHECK(names.insert(text.substr(at, text.find('"', at + 5) - at)).second);
    for (std::uint32_t layer = 0; layer < 3; ++layer) {
        auto again = Reader::open(path);
        const auto alone = layer_svg(*again, layer, {});
        REQUIRE(alone.ok());
        for (std::size_t at = 0; (at = alone->find("<path d=\"M", at)) != alone->npos; ++at) {
            const std::size_t end = alone->find("\"/>", at);
            if (alone->substr(at, end - at).find("stroke") != std::string::npos) continue;
            CHECK(text.find(alone->substr(at, end - at)) != text.npos);
        }
    }
}
