// Files of several solids: what overlaps or touches is printed as one.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "format/reader.h"
#include "kernel/brep/assembly.h"
#include "kernel/brep/placement.h"
#include "kernel/contour/arc.h"
#include "kernel/section/cutter.h"
#include "kernel/solids.h"
#include "kernel/toolpath/offset.h"
#include "slicer/layers.h"
#include "slicer/scene.h"
#include "slicer/slicer.h"

using namespace lyr;
using namespace lyr::slicer;
using lyr::testing::at;
using lyr::testing::box;
using lyr::testing::bytes_of;
using lyr::testing::pi;
using lyr::testing::scratch;

namespace {

constexpr double block_height_mm = 10;
constexpr double layer_height_mm = 0.2;

Options solid() {
    Options options;
    options.profile.infill.density = 1;
    return options;
}

Model rod(double radius) {
    return lyr::testing::frustum(radius, radius, block_height_mm, lyr::testing::Side::halves);
}

Model together(const std::vector<Model>& parts) {
    Model all;
    for (const Model& part : parts) append(all, part);
    return all;
}

// A block that stands on a corner or leans far out is warned of.
enum class Stands { flat, askew };

Summary printed(const Model& model, const std::string& lyr, const Options& options = {},
                Stands stands = Stands::flat) {
    Diagnostics diagnostics;
    const auto summary = print(
        model, "solids", lyr, lyr + ".jsonl", options, [](const char*, std::size_t, std::size_t) {},
        diagnostics);
    REQUIRE(summary);
    if (stands == Stands::flat) CHECK(diagnostics.empty());
    return *summary;
}

struct Strip {
    long row;
    double start_mm, end_mm;
    auto operator<=>(const Strip&) const = default;
};

// The outer walls of a layer, its fill in rows, and what is extruded.
struct PrintedLayer {
    std::vector<Contour> walls{};
    std::vector<Strip> fill{};
    double volume_mm3 = 0;

    // Within the outer flanks of the walls.
    double enclosed_mm2() const {
        const profile::Profile profile;
        const OffsetResult outline = offset(walls, {.distance_mm = profile.perimeters.width_mm / 2,
                                                    .allowed_mm = 1e-3,
                                                    .corner = Corner::mitre,
                                                    .mitre_limit = 5});
        double area = 0;
        for (const Contour& contour : outline.contours) area += area_mm2(contour);
        return area;
    }
    bool fill_overlaps() {
        std::sort(fill.begin(), fill.end());
        return std::adjacent_find(fill.begin(), fill.end(), [](const Strip& a, const Strip& b) {
                   return a.row == b.row && b.start_mm < a.end_mm;
               }) != fill.end();
    }
};

class PrintReader {
public:
    explicit PrintReader(format::Quantum quantum) : quantum_(quantum) {}

    void operator()(const format::LayerStart&) { layers.emplace_back(); }
    void operator()(const format::PathStart& path) { style_ = path.style; }
    void operator()(const format::HatchStart& hatch) {
        along_ = {hatch.direction_x, hatch.direction_y};
        pitch_mm_ = std::abs(hatch.pitch_mm);
    }
    void operator()(const format::Line& line) {
        const Point2 a = point(line.from), b = point(line.to);
        extrude((b - a).norm());
        if (!line.hatch) return add(line.from, {b, 0});
        const double from = along_.dot(a), to = along_.dot(b);
        // Links lead from row to row.
        if (std::abs(cross(along_, b - a)) > pitch_mm_ / 2) return;
        layers.back().fill.push_back({std::lround(cross(along_, a) / pitch_mm_ - 0.5),
                                      std::min(from, to), std::max(from, to)});
    }
    void operator()(const format::Arc& arc) {
        const Segment segment{point(arc.to), quantum_.mm(arc.sagitta)};
        extrude(length_mm(point(arc.from), segment));
        add(arc.from, segment);
    }
    void operator()(const format::Circle& circle) {
        const Point2 centre(quantum_.mm(circle.center_x), quantum_.mm(circle.center_y));
        const double radius = (point(circle.from) - centre).norm();
        extrude(2 * pi * radius);
        if (is_outer())
            layers.back().walls.push_back(FullCircle{centre, radius, circle.counter_clockwise});
    }
    template <class Other>
    void operator()(const Other&) {}

    std::vector<PrintedLayer> layers;

private:
    Point2 point(const format::Point& p) const { return {quantum_.mm(p.x), quantum_.mm(p.y)}; }
    bool is_outer() const { return style_.role == format::Role::outer_wall; }
    void extrude(double length) {
        layers.back().volume_mm3 += length * format::cross_section_mm2(style_);
    }
    // Walls are whole: one that has come back to its start is followed by another.
    void add(const format::Point& from, const Segment& segment) {
        if (!is_outer()) return;
        std::vector<Contour>& walls = layers.back().walls;
        if (!open_) walls.push_back(Path{point(from), {}});
        Path& path = std::get<Path>(walls.back());
        path.segments.push_back(segment);
        open_ = segment.end != path.start;
    }

    format::Quantum quantum_;
    format::PathStyle style_{};
    bool open_ = false;
    Vector2 along_ = Vector2::UnitX();
    double pitch_mm_ = 1;
};

std::vector<PrintedLayer> layers_in(const std::string& lyr) {
    auto reader = format::Reader::open(lyr);
    REQUIRE(reader);
    PrintReader print(reader->header().quantum);
    for (;;) {
        const auto next = reader->next();
        REQUIRE(next);
        if (!*next) return print.layers;
        std::visit(print, **next);
    }
}

std::vector<double> wall_areas(const std::string& lyr) {
    std::vector<double> areas;
    for (const PrintedLayer& layer : layers_in(lyr)) areas.push_back(layer.enclosed_mm2());
    return areas;
}

struct Expected {
    double area_mm2;
    std::size_t contours, united_layers;
};

// How often a text is in a file.
long occurrences(const std::string& path, const std::string& text) {
    const std::string bytes = bytes_of(path);
    long count = 0;
    for (std::size_t at = 0; (at = bytes.find(text, at)) != std::string::npos; ++at) ++count;
    return count;
}

void check_print(const std::vector<Model>& solids, const Expected& expected) {
    const std::string lyr = scratch("solids.lyr");
    const Summary summary = printed(together(solids), lyr, solid());
    CHECK(summary.solids == solids.size());
    CHECK(summary.layers == 50);
    CHECK(summary.contours == 50 * expected.contours);
    CHECK(summary.united_layers == expected.united_layers);
    CHECK(occurrences(lyr + ".jsonl", "\"loops\":" + std::to_string(solids.size()) + ",") == 50);
    std::vector<PrintedLayer> layers = layers_in(lyr);
    REQUIRE(layers.size() == 50);
    for (PrintedLayer& layer : layers) {
        // Corners are rounded to the file's quantum, 1 um, along some 100 mm.
        CHECK(std::abs(layer.enclosed_mm2() - expected.area_mm2) < 0.05);
        CHECK(!layer.fill_overlaps());
        // Filled twice, a quarter of the smallest overlap here is more.
        CHECK(layer.volume_mm3 / layer_height_mm ==
              doctest::Approx(expected.area_mm2).epsilon(0.02));
    }
}

// Of a circle's segment beyond a chord at this distance from the centre.
double segment_area(double radius, double distance) {
    return radius * radius * std::acos(distance / radius) -
           distance * std::sqrt(radius * radius - distance * distance);
}

}  // namespace

TEST_CASE("slicer 7: solids that overlap, touch or lie within each other are printed as one") {
    const Model block = box(20, 10, block_height_mm);
    // Overlapping boxes, one a quarter over the other.
    check_print({block, at(block, 10, 5)}, {350, 1, 50});
    // A wall in common, of the same and of another length.
    check_print({block, at(block, 20, 0)}, {400, 1, 50});
    check_print({block, at(box(6, 4, block_height_mm), 13, 1)}, {224, 1, 50});
    // A rod in a box, across its wall, and on it from outside.
    check_print({block, at(rod(3), 2, 1)}, {200, 1, 50});
    check_print({block, at(rod(4), 8, 0)}, {200 + segment_area(4, 2), 1, 50});
    check_print({at(rod(3), 10, 0), block}, {200 + pi * 9 / 2, 1, 50});
    // Two rods; many boxes in a ring.
    check_print({rod(4), at(rod(4), 4, 0)}, {32 * pi - 2 * segment_area(4, 2), 1, 50});
    check_print({block, at(block, 0, 30), at(box(4, 40, block_height_mm), -12, 15),
                 at(box(4, 40, block_height_mm), 12, 15)},
                {720, 2, 50});
}

TEST_CASE("slicer 7: a single solid's contours pass untouched, in their order") {
    Diagnostics diagnostics;
    const auto model =
        load(std::string(LYR_FIXTURES) + "/parts/gearbox_base.step", {}, diagnostics);
    REQUIRE(model);
    const Section section = Cutter(*model, {}).cut(3.1);
    REQUIRE(section.solids.size() == 1);
    const RegionResult region = region_of(section, {});
    CHECK(!region.changed);
    const auto same = [](const Contour& a, const Contour& b) {
        const auto *circle = std::get_if<FullCircle>(&a), *other = std::get_if<FullCircle>(&b);
        if (circle && other)
            return circle->centre == other->centre && circle->radius_mm == other->radius_mm;
        const auto *path = std::get_if<Path>(&a), *twin = std::get_if<Path>(&b);
        return path && twin && path->start == twin->start &&
               std::ranges::equal(path->segments, twin->segments, [](auto& s, auto& t) {
                   return s.end == t.end && s.sagitta_mm == t.sagitta_mm;
               });
    };
    CHECK(std::ranges::equal(region.contours, section.solids.front().contours, same));
}

TEST_CASE("slicer 7: solids apart are printed apart, as they are") {
    const Model block = box(20, 10, block_height_mm);
    check_print({block, at(block, 20.01, 0)}, {400, 2, 0});
    check_print({block, at(rod(3), 0, 9)}, {200 + 9 * pi, 2, 0});
}

TEST_CASE("slicer 7: only the layers where solids meet are united, and reports keep them apart") {
    const std::string lyr = scratch("steps.lyr");
    const Model block = box(20, 10, block_height_mm);
    const Summary summary = printed(
        together({block, at(box(20, 10, block_height_mm / 2), 10, 5, -block_height_mm / 4)}), lyr);
    CHECK(summary.layers == 50);
    CHECK(summary.united_layers == 25);
    const auto areas = wall_areas(lyr);
    CHECK(areas.front() == doctest::Approx(350).epsilon(1e-4));
    CHECK(areas.back() == doctest::Approx(200).epsilon(1e-4));
    CHECK(bytes_of(lyr + ".jsonl").find("\"area_mm2\":400,\"length_mm\":120,\"loops\":2,") !=
          std::string::npos);
}

TEST_CASE("slicer 2, 7: the print is the same for any order of the solids and number of threads") {
    const std::vector<Model> solids{box(20, 10, block_height_mm), at(rod(4), 8, 0),
                                    at(rod(3), -10, 2), at(box(6, 4, block_height_mm), 13, 1),
                                    at(rod(2), 40, 0)};
    std::vector<Model> reversed(solids.rbegin(), solids.rend());
    Options options;
    options.threads = 1;
    printed(together(solids), scratch("one.lyr"), options);
    options.threads = 3;
    printed(together(reversed), scratch("two.lyr"), options);
    CHECK(bytes_of(scratch("one.lyr")) == bytes_of(scratch("two.lyr")));
}

TEST_CASE("slicer 7: lying askew, solids that share a wall are one as well") {
    const std::string lyr = scratch("askew.lyr");
    for (const Vector3& up : {Vector3(0.3, 0.5, 0.8), Vector3(1, 2, 3), Vector3(0, 0.1, 1)}) {
        const Model block = box(20, 10, block_height_mm);
        const auto turned = [&](const Model& model) { return transformed(model, turned_up(up)); };
        const Summary apart = printed(turned(together({at(block, -10, 0), at(block, 10, 0)})), lyr,
                                      {}, Stands::askew);
        const auto areas = wall_areas(lyr);
        const Summary whole = printed(turned(box(40, 10, block_height_mm)), lyr, {}, Stands::askew);
        const auto expected = wall_areas(lyr);
        CHECK(apart.layers == whole.layers);
        CHECK(apart.contours == whole.contours);
        CHECK(apart.united_layers > whole.layers / 4);
        REQUIRE(areas.size() == expected.size());
        for (std::size_t i = 0; i < areas.size(); ++i)
            CHECK(std::abs(areas[i] - expected[i]) < 0.05);
    }
}
