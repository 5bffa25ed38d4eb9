// CLI and 3MF: read back, and held against the print's own motions and areas.

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <sstream>

#include "../../target/run/print_files.h"
#include "../files.h"
#include "format/export/cli.h"
#include "format/export/polylines.h"
#include "format/export/slice_3mf.h"
#include "format/export/zip.h"
#include "zip_reader.h"

using namespace lyr;
using namespace lyr::format;

namespace {

constexpr double tolerance_mm = 0.005;

template <class Write>
std::string written(const std::string& path, Write write, Diagnostics& diagnostics) {
    auto reader = Reader::open(path);
    REQUIRE(reader.ok());
    std::string text;
    const Status done = write(
        *reader, [&](std::string_view piece) { text += piece; }, diagnostics);
    REQUIRE_MESSAGE(done.ok(), to_string(done.error()));
    return text;
}

struct CliLayer {
    double z_mm = 0;
    struct Line {
        bool hatch = false;
        int model = 0, direction = 0;
        std::vector<PlanePoint> points;
    };
    std::vector<Line> lines;
};

std::vector<CliLayer> read_cli(const std::string& text) {
    std::vector<CliLayer> layers;
    std::istringstream in(text);
    std::string line;
    bool in_geometry = false;
    for (int number = 0; std::getline(in, line); ++number) {
        if (number == 0) CHECK(line == "$$HEADERSTART");
        if (line == "$$GEOMETRYSTART") in_geometry = true;
        const std::size_t slash = line.find('/');
        const std::string command = line.substr(0, slash);
        if (!in_geometry || slash == std::string::npos) continue;
        std::string values = line.substr(slash + 1);
        std::replace(values.begin(), values.end(), ',', ' ');
        std::istringstream numbers(values);
        if (command == "$$LAYER") {
            layers.emplace_back();
            numbers >> layers.back().z_mm;
            continue;
        }
        REQUIRE((command == "$$POLYLINE" || command == "$$HATCHES"));
        CliLayer::Line one{
            .hatch = command == "$$HATCHES", .model = 0, .direction = 0, .points = {}};
        std::size_t count = 0;
        numbers >> one.model;
        if (!one.hatch) numbers >> one.direction;
        numbers >> count;
        for (PlanePoint p{}; numbers >> p[0] >> p[1];) one.points.push_back(p);
        CHECK(one.points.size() == (one.hatch ? 2 * count : count));
        layers.back().lines.push_back(one);
    }
    CHECK(text.ends_with("$$GEOMETRYEND\n"));
    return layers;
}

double length_mm(const CliLayer::Line& line) {
    double sum = 0;
    for (std::size_t i = 1; i < line.points.size(); i += line.hatch ? 2 : 1)
        sum += std::hypot(line.points[i][0] - line.points[i - 1][0],
                          line.points[i][1] - line.points[i - 1][1]);
    return sum;
}

struct Slice {
    double top_mm = 0, area_mm2 = 0;
    std::size_t outer = 0, holes = 0;
};

// The model's slices, and what the specification asks of their structure.
std::vector<Slice> read_slices(const std::string& model) {
    std::vector<Slice> slices;
    std::vector<PlanePoint> vertices;
    const auto value = [&](std::size_t at, const std::string& name) {
        const std::size_t begin = model.find(' ' + name + "=\"", at) + name.size() + 3;
        return std::stod(model.substr(begin));
    };
    for (std::size_t at = 0; (at = model.find('<', at)) != std::string::npos; ++at) {
        const auto is = [&](const char* tag) {
            return model.compare(at, std::strlen(tag), tag) == 0;
        };
        if (is("<s:slice ")) {
            slices.push_back({.top_mm = value(at, "ztop")});
            vertices.clear();
        } else if (is("<s:vertex ")) {
            vertices.push_back({value(at, "x"), value(at, "y")});
        } else if (is("<s:polygon ")) {
            const auto first = static_cast<std::size_t>(value(at, "startv"));
            std::vector<PlanePoint> polygon;
            std::size_t last = first;
            const std::size_t end = model.find("</s:polygon>", at);
            for (std::size_t segment = at; (segment = model.find("<s:segment ", segment)) < end;
                 ++segment) {
                polygon.push_back(vertices.at(last));
                last = static_cast<std::size_t>(value(segment, "v2"));
                CHECK(vertices.at(last) != polygon.back());
            }
            CHECK(last == first);
            REQUIRE(polygon.size() >= 3);
            const double area = area_mm2(polygon);
            slices.back().area_mm2 += area;
            ++(area > 0 ? slices.back().outer : slices.back().holes);
        }
    }
    return slices;
}

const double pi = std::numbers::pi;

// A ring of radius 10 with a hole of 4, both in the sense that a slicer may choose, and a square beside them; walls 0.4
// wide.
void draw_ring(const tests::Pen& pen) {
    pen.layer.begin_path(
        {.role = Role::outer_wall, .width_mm = 0.4, .height_mm = 0.2, .flow = 1, .speed_mm_s = 50});
    pen.travel(9.8, 0);
    pen.circle(0, 0, false);
    pen.travel(4.2, 0);
    pen.circle(0, 0, false);
    pen.travel(20.2, 0.2);
    pen.line(29.8, 0.2);
    pen.line(29.8, 9.8);
    pen.line(20.2, 9.8);
    pen.line(20.2, 0.2);
    pen.layer.begin_path(
        {.role = Role::inner_wall, .width_mm = 0.4, .height_mm = 0.2, .flow = 1, .speed_mm_s = 50});
    pen.travel(9, 0);
    pen.circle(0, 0, true);
}

const std::vector<tests::Frame> frames{{}, {0.7, false, 90, 80}, {2.1, true, 120, 60}};

}  // namespace

TEST_CASE("cli 1, 2: lengths are the print's, closed polylines turn as they say") {
    for (const tests::Frame& frame : frames)
        for (const tests::Case& drawn : tests::all_cases()) {
            CAPTURE(std::string(drawn.name));
            const std::string path = tests::write_print("cli", {drawn.drawing, draw_ring}, frame);
            Diagnostics diagnostics;
            const auto layers = read_cli(written(path, write_cli, diagnostics));
            CHECK(diagnostics.size() == 1);
            REQUIRE(layers.size() == 3);
            CHECK(layers[0].z_mm == 0);
            CHECK(layers[0].lines.empty());
            auto reader = Reader::open(path);
            std::vector<double> extruded_mm;
            while (const Operation* operation = reader->read())
                if (std::holds_alternative<LayerStart>(*operation))
                    extruded_mm.push_back(Quantum{}.mm(reader->layer().totals.extruded_quanta));
            for (std::size_t i = 0; i < extruded_mm.size(); ++i) {
                double sum = 0;
                for (const CliLayer::Line& line : layers[i + 1].lines) {
                    sum += length_mm(line);
                    CHECK(line.model == 1);
                    const bool closed = line.points.front() == line.points.back();
                    if (line.hatch || !closed || line.points.size() < 4) continue;
                    CHECK(line.direction == (area_mm2(line.points) > 0 ? 1 : 0));
                }
                // A chord that is off by d is shorter than its arc by d x angle x 2/3: for chords of up to a third of a turn.
                CHECK(sum <= extruded_mm[i] + 1e-3);
                CHECK(sum >= extruded_mm[i] * 0.99);
            }
            CHECK(layers[2].z_mm == 0.4);
        }
}

TEST_CASE("cli 3: the dimension holds the part, from the bed on, and layers are counted") {
    for (const tests::Frame& frame : frames) {
        const std::string path = tests::write_print("cli_box", {draw_ring, draw_ring}, frame);
        Diagnostics diagnostics;
        const std::string text = written(path, write_cli, diagnostics);
        const std::size_t at = text.find("$$DIMENSION/");
        REQUIRE(at != text.npos);
        double x0 = 0, y0 = 0, z0 = 1, x1 = 0, y1 = 0, z1 = 0;
        REQUIRE(std::sscanf(text.c_str() + at, "$$DIMENSION/%lf,%lf,%lf,%lf,%lf,%lf", &x0, &y0, &z0,
                            &x1, &y1, &z1) == 6);
        CHECK(z0 == 0);
        CHECK(z1 == doctest::Approx(0.4));
        CHECK(text.find("$$LAYERS/3\n") != text.npos);
        CHECK(std::all_of(text.begin(), text.end(),
                          [](char c) { return c == '\n' || (c >= ' ' && c <= '~'); }));
        double low_x = 1e9, low_y = 1e9, high_x = -1e9, high_y = -1e9;
        for (const CliLayer& layer : read_cli(text))
            for (const CliLayer::Line& line : layer.lines)
                for (const PlanePoint& p : line.points) {
                    low_x = std::min(low_x, p[0]);
                    low_y = std::min(low_y, p[1]);
                    high_x = std::max(high_x, p[0]);
                    high_y = std::max(high_y, p[1]);
                }
        constexpr double half_mm = 0.2;
        for (const double off : {low_x - x0, low_y - y0, x1 - high_x, y1 - high_y})
            CHECK(off == doctest::Approx(half_mm).epsilon(1e-3));
    }
}

TEST_CASE("cli: a label of a file in ASCII is ASCII") {
    const std::string path = test::scratch("cli_label");
    Metadata metadata;
    metadata.source_name = "Z\xc3\xa4hler, 1/2.step";
    auto writer = Writer::create(path, Quantum{}, metadata);
    REQUIRE(writer.ok());
    LayerEncoder layer(Quantum{}, tests::layer_state(0));
    draw_ring({layer, {}});
    REQUIRE(writer->append(*layer.finish()).ok());
    REQUIRE(writer->finish().ok());
    Diagnostics diagnostics;
    const std::string text = written(path, write_cli, diagnostics);
    CHECK(text.find("$$LABEL/1,Z?hler_ 1_2.step\n") != text.npos);
}

TEST_CASE("polylines 2: chords stay within the tolerance, and are as few as that allows") {
    for (const double radius_mm : {0.02, 0.5, 10.0, 200.0}) {
        PolylineCollector collector(Quantum{}, tolerance_mm);
        const std::int64_t r = Quantum{}.quanta(radius_mm);
        collector.take(Circle{{r, 0, 0}, {r, 0, 0}, 0, 0, true}, {});
        const auto lines = collector.finish();
        REQUIRE(lines.size() == 1);
        CHECK(lines[0].closed);
        const double off_mm =
            radius_mm * (1 - std::cos(pi / static_cast<double>(lines[0].points.size())));
        CHECK(off_mm <= tolerance_mm * (1 + 1e-9));
        const double wider_mm =
            radius_mm * (1 - std::cos(pi / static_cast<double>(lines[0].points.size() - 1)));
        CHECK(wider_mm > tolerance_mm);
    }
}

TEST_CASE("3mf 1: slices are the outlines, whatever the sense of the walls") {
    const double area_mm2 = pi * (100 - 16) + 100;
    for (const tests::Frame& frame : frames) {
        const std::string path =
            tests::write_print("3mf", {draw_ring, draw_ring, tests::draw_hatch}, frame);
        Diagnostics diagnostics;
        auto files = test::read_zip(written(path, write_slice_3mf, diagnostics));
        REQUIRE(files.size() == 3);
        const std::string& model = files["3D/3dmodel.model"];
        CHECK(files["[Content_Types].xml"].find("3dmanufacturing-3dmodel+xml") !=
              std::string::npos);
        CHECK(files["_rels/.rels"].find("Target=\"/3D/3dmodel.model\"") != std::string::npos);
        CHECK(model.find("requiredextensions=\"s\"") != std::string::npos);
        CHECK(model.find("s:meshresolution=\"lowres\" s:slicestackid=\"1\"") != std::string::npos);
        CHECK(model.find("<item objectid=\"2\"/>") != std::string::npos);
        const auto slices = read_slices(model);
        REQUIRE(slices.size() == 3);
        for (std::size_t i = 0; i < 2; ++i) {
            CHECK(slices[i].outer == 2);
            CHECK(slices[i].holes == 1);
            // Within what the tolerance leaves along the edges, and the rounding of a turned square.
            CHECK(slices[i].area_mm2 == doctest::Approx(area_mm2).epsilon(0.002));
            CHECK(slices[i].top_mm == doctest::Approx(0.2 * static_cast<double>(i + 1)));
        }
        // Hatches are no walls: a slice all the same, which is empty or has its rest of a ring.
        CHECK(slices[2].top_mm == doctest::Approx(0.6));
        CHECK(diagnostics.size() >= 1);
    }
}

TEST_CASE("3mf 2: the mesh is a closed box that looks outwards") {
    const std::string path = tests::write_print("3mf_box", {draw_ring});
    Diagnostics diagnostics;
    const std::string model =
        test::read_zip(written(path, write_slice_3mf, diagnostics))["3D/3dmodel.model"];
    std::vector<std::array<double, 3>> vertices;
    double volume_mm3 = 0;
    std::map<std::pair<int, int>, int> edges;
    for (std::size_t at = 0; (at = model.find("<vertex ", at)) != model.npos; ++at) {
        std::array<double, 3> p{};
        REQUIRE(std::sscanf(model.c_str() + at, "<vertex x=\"%lf\" y=\"%lf\" z=\"%lf\"", &p[0],
                            &p[1], &p[2]) == 3);
        vertices.push_back(p);
    }
    for (std::size_t at = 0; (at = model.find("<triangle ", at)) != model.npos; ++at) {
        int v[3] = {};
        REQUIRE(std::sscanf(model.c_str() + at, "<triangle v1=\"%d\" v2=\"%d\" v3=\"%d\"", &v[0],
                            &v[1], &v[2]) == 3);
        for (int i = 0; i < 3; ++i) ++edges[{v[i], v[(i + 1) % 3]}];
        const auto& a = vertices.at(static_cast<std::size_t>(v[0]));
        const auto& b = vertices.at(static_cast<std::size_t>(v[1]));
        const auto& c = vertices.at(static_cast<std::size_t>(v[2]));
        volume_mm3 += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                       a[2] * (b[0] * c[1] - b[1] * c[0])) /
                      6;
    }
    CHECK(vertices.size() == 8);
    for (std::size_t at = 0; (at = model.find("<s:vertex ", at)) != model.npos; ++at) {
        double x = 0, y = 0;
        REQUIRE(std::sscanf(model.c_str() + at, "<s:vertex x=\"%lf\" y=\"%lf\"", &x, &y) == 2);
        CHECK(vertices.front()[0] <= x);
        CHECK(x <= vertices.back()[0]);
        CHECK(vertices.front()[1] <= y);
        CHECK(y <= vertices.back()[1]);
    }
    CHECK(edges.size() == 36);
    for (const auto& [edge, count] : edges) {
        CHECK(count == 1);
        CHECK(edges.contains({edge.second, edge.first}));
    }
    CHECK(volume_mm3 > 0);
}

TEST_CASE("3mf 1: a wall with a seam's gap is a ring, in 3MF and in CLI") {
    const auto draw = [](double gap_mm) {
        return [gap_mm](const tests::Pen& pen) {
            pen.layer.begin_path({.role = Role::outer_wall,
                                  .width_mm = 0.4,
                                  .height_mm = 0.2,
                                  .flow = 1,
                                  .speed_mm_s = 50});
            pen.travel(5, 0.2);
            pen.line(9.8, 0.2);
            pen.line(9.8, 9.8);
            pen.line(0.2, 9.8);
            pen.line(0.2, 0.2);
            pen.line(5 - gap_mm, 0.2);
        };
    };
    for (const tests::Frame& frame : frames) {
        const std::string path = tests::write_print("3mf_seam", {draw(0.19), draw(0.41)}, frame);
        Diagnostics diagnostics;
        auto files = test::read_zip(written(path, write_slice_3mf, diagnostics));
        const auto slices = read_slices(files["3D/3dmodel.model"]);
        REQUIRE(slices.size() == 2);
        CHECK(slices[0].area_mm2 == doctest::Approx(100).epsilon(0.002));
        CHECK(slices[1].outer == 0);
        CHECK(diagnostics.back().severity == Severity::warning);
        const auto layers = read_cli(written(path, write_cli, diagnostics));
        REQUIRE(layers.size() == 3);
        const auto is_ring = [](const CliLayer& layer) {
            return layer.lines.at(0).direction != 2 &&
                   layer.lines[0].points.front() == layer.lines[0].points.back();
        };
        CHECK(is_ring(layers[1]));
        CHECK(!is_ring(layers[2]));
    }
}

// What is said of a print that cannot be slices.
static Location refused_3mf(const std::string& path) {
    auto reader = Reader::open(path);
    REQUIRE(reader.ok());
    Diagnostics diagnostics;
    const Status refused = write_slice_3mf(
        *reader, [](std::string_view) {}, diagnostics);
    REQUIRE(!refused.ok());
    CHECK(refused.error().status == ExitStatus::unsupported);
    return refused.error().where;
}

TEST_CASE("3mf 4: a print without a closed wall is refused") {
    const std::string path = tests::write_print("3mf_open", {tests::draw_hatch});
    refused_3mf(path);
}

TEST_CASE("3mf 3: parts one after the other are refused, with the layer") {
    const std::string path = tests::write_print(
        "3mf_sequential", {draw_ring, draw_ring, draw_ring}, {},
        [](LayerState& state) { state.z_mm = state.z_mm > 0.5 ? 0.2 : state.z_mm; });
    CHECK(refused_3mf(path).layer == 3);
}

TEST_CASE("zip: the checksum of a file does not begin anew at its end") {
    std::string bytes;
    const Sink sink = [&](std::string_view piece) { bytes += piece; };
    ZipWriter zip(sink);
    zip.begin_file("a");
    zip.begin_file("folder/b.txt");
    std::string text;
    for (int i = 0; i < 50'000; ++i) text += std::to_string(i * 7919 % 10'007);
    zip.write(text.substr(0, 1000));
    zip.write({});
    zip.write(text.substr(1000));
    REQUIRE(zip.finish().ok());
    auto files = test::read_zip(bytes);
    CHECK(files.size() == 2);
    CHECK(files["a"].empty());
    CHECK(files["folder/b.txt"] == text);
}
