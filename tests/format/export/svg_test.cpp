// What is drawn is what is in the file: the picture is parsed back and compared motion by motion.

#include "format/export/svg.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "../files.h"
#include "../sample.h"
#include "../worked_example.h"
#include "format/export/svg_text.h"
#include "svg_reader.h"

using namespace lyr;
using namespace lyr::format;

namespace {

// Of a radius: nine digits are written.
constexpr double radius_relative = 1e-8;

struct Expected {
    Role role = Role::other;
    double width_mm = 0;
    std::vector<Operation> motions, circles;
};

// A layer's motions in the groups that the picture should have.
struct ExpectedLayer {
    std::vector<Expected> groups;
    std::vector<Travel> travels;
    Bounds motion;
};

ExpectedLayer expected_layer(const std::string& path, std::uint32_t index) {
    ExpectedLayer layer;
    auto reader = Reader::open(path);
    REQUIRE(reader.ok());
    std::optional<std::uint32_t> at;
    while (const Operation* operation = reader->read()) {
        if (const auto* start = std::get_if<LayerStart>(operation)) at = start->index;
        if (at != index) continue;
        layer.motion = reader->layer().totals.motion;
        if (const auto* travel = std::get_if<Travel>(operation)) layer.travels.push_back(*travel);
        const bool circle = std::holds_alternative<Circle>(*operation);
        if (!circle && !std::holds_alternative<Line>(*operation) &&
            !std::holds_alternative<Arc>(*operation))
            continue;
        const PathStyle& style = reader->path();
        if (layer.groups.empty() || layer.groups.back().role != style.role ||
            layer.groups.back().width_mm != style.width_mm)
            layer.groups.push_back({style.role, style.width_mm, {}, {}});
        (circle ? layer.groups.back().circles : layer.groups.back().motions).push_back(*operation);
    }
    REQUIRE(!reader->error());
    std::stable_partition(layer.groups.begin(), layer.groups.end(), [](const Expected& group) {
        return group.role < Role::outer_wall || group.role > Role::thin_wall;
    });
    return layer;
}

struct Check {
    Quantum quantum;
    const test::Drawn& drawn;

    void at(double x, double y, const Point& point) const {
        CHECK(quantum.quanta(x) == point.x);
        CHECK(quantum.quanta(y) == point.y);
        CHECK(std::abs(x - quantum.mm(point.x)) < 1e-9);
        CHECK(std::abs(y - quantum.mm(point.y)) < 1e-9);
    }
    void operator()(const Line& line) const {
        REQUIRE(drawn.kind == 'L');
        at(drawn.x0, drawn.y0, line.from);
        at(drawn.x, drawn.y, line.to);
    }
    void operator()(const Arc& arc) const {
        REQUIRE(drawn.kind == 'A');
        at(drawn.x0, drawn.y0, arc.from);
        at(drawn.x, drawn.y, arc.to);
        CHECK(drawn.positive == (arc.sagitta > 0));
        const ArcShape shape = arc_shape(arc);
        const double radius_mm = shape.radius * quantum.mm(1);
        CHECK(std::abs(drawn.radius - radius_mm) <= radius_relative * radius_mm);
        CHECK(drawn.large == (std::abs(shape.sweep_rad) > std::numbers::pi));
        // Near half a turn the length follows from the radius badly: there only within a percent.
        const double length_mm = shape.length() * quantum.mm(1);
        const bool half = std::abs(std::abs(shape.sweep_rad) - std::numbers::pi) < 0.1;
        CHECK(test::arc_length_mm(drawn) == doctest::Approx(length_mm).epsilon(half ? 1e-2 : 1e-6));
    }
    void operator()(const Circle& circle) const {
        REQUIRE(drawn.kind == 'C');
        at(drawn.x, drawn.y, {circle.center_x, circle.center_y, 0});
        const double radius_mm =
            std::hypot(circle.from.x - circle.center_x, circle.from.y - circle.center_y) *
            quantum.mm(1);
        CHECK(std::abs(drawn.radius - radius_mm) <= radius_relative * radius_mm);
    }
    template <class Other>
    void operator()(const Other&) const {
        FAIL("not a motion");
    }
};

std::string svg_of(const std::string& path, std::uint32_t layer, bool travels = true) {
    auto reader = Reader::open(path);
    REQUIRE(reader.ok());
    const auto svg = layer_svg(*reader, layer, {.travels = travels});
    REQUIRE_MESSAGE(svg.ok(), to_string(svg.error()));
    return *svg;
}

void compare(const std::string& path, Quantum quantum, std::uint32_t index) {
    const ExpectedLayer expected = expected_layer(path, index);
    const test::Picture picture = test::parse_svg(svg_of(path, index));
    REQUIRE(picture.groups.size() == expected.groups.size());
    for (std::size_t g = 0; g < expected.groups.size(); ++g) {
        const Expected& wanted = expected.groups[g];
        const test::Group& group = picture.groups[g];
        CHECK(group.title == name_of(wanted.role));
        CHECK(group.widest_stroke_mm == doctest::Approx(wanted.width_mm));
        std::vector<Operation> motions = wanted.motions;
        motions.insert(motions.end(), wanted.circles.begin(), wanted.circles.end());
        REQUIRE(group.motions.size() == motions.size());
        for (std::size_t i = 0; i < motions.size(); ++i)
            std::visit(Check{quantum, group.motions[i]}, motions[i]);
    }
    std::size_t flat = 0;
    for (const Travel& travel : expected.travels) {
        REQUIRE(flat < picture.travels.size());
        Check{quantum, picture.travels[flat]}(Line{travel.from, travel.to, false});
        ++flat;
    }
    CHECK(flat == picture.travels.size());
    CHECK(test::parse_svg(svg_of(path, index, false)).travels.empty());
    // The page shows all of it, y upwards.
    const double low_x = quantum.mm(expected.motion.low.x),
                 low_y = quantum.mm(expected.motion.low.y);
    const double high_x = quantum.mm(expected.motion.high.x);
    const double high_y = quantum.mm(expected.motion.high.y);
    CHECK(picture.left < low_x);
    CHECK(picture.left + picture.width > high_x);
    CHECK(picture.top < -high_y);
    CHECK(picture.top + picture.height > -low_y);
}

}  // namespace

TEST_CASE("svg 1 and 2: every motion is drawn where the file has it") {
    for (const std::uint32_t nm : {1000u, 250u, 7u}) {
        const Quantum quantum{nm};
        std::vector<EncodedLayer> layers;
        for (std::uint32_t i = 0; i < 3; ++i) {
            test::RandomLayer layer(i * 31 + nm, 0.2 * (i + 1), quantum, 400);
            auto encoded = layer.finish();
            REQUIRE(encoded.ok());
            layers.push_back(std::move(*encoded));
        }
        const std::string path = test::scratch("svg");
        test::write_layers(path, quantum, {}, layers);
        for (std::uint32_t i = 0; i < 3; ++i) compare(path, quantum, i);
    }
}

TEST_CASE("svg 2: the worked example has its lines, its arc, its circle and its travels") {
    const std::string path = test::scratch("svg_example");
    REQUIRE(test::write_worked_example(path).ok());
    compare(path, Quantum{1000}, 0);
    const std::string svg = svg_of(path, 0);
    CHECK(svg.find("M10 10L20 10A5 5 0 0 1 20 20L10 20L10 10") != std::string::npos);
    CHECK(svg.find("<circle cx=\"15\" cy=\"15\" r=\"1\"/>") != std::string::npos);
    CHECK(svg.find("Layer 1 of 1, z = 0.200 mm") != std::string::npos);
    CHECK(svg.find("outer wall") != std::string::npos);
    CHECK(svg.find("solid infill") != std::string::npos);
}

TEST_CASE("svg 3: names that are no XML cannot break the picture") {
    Metadata metadata;
    metadata.source_name = "a<b>&\"'\x01\xff\xc3\xa4.step";
    const auto layer = test::worked_layer(Quantum{1000});
    REQUIRE(layer.ok());
    const std::string path = test::scratch("svg_names");
    test::write_layers(path, Quantum{1000}, metadata, {*layer});
    const std::string svg = svg_of(path, 0);
    CHECK(svg.find("a&lt;b&gt;&amp;") != std::string::npos);
    CHECK(svg.find("\xc3\xa4.step") != std::string::npos);
    CHECK(svg.find('\x01') == std::string::npos);
    CHECK(svg.find('\xff') == std::string::npos);
}

TEST_CASE("svg: layers without motions are drawn, layers that are not there are errors") {
    LayerEncoder encoder(Quantum{1000}, {});
    auto layer = encoder.finish();
    REQUIRE(layer.ok());
    const std::string path = test::scratch("svg_empty");
    test::write_layers(path, Quantum{1000}, {}, {*layer});
    const test::Picture picture = test::parse_svg(svg_of(path, 0));
    CHECK(picture.groups.empty());
    CHECK(picture.width > 0);
    CHECK(picture.height > 0);
    auto reader = Reader::open(path);
    REQUIRE(reader.ok());
    const auto missing = layer_svg(*reader, 1, {});
    REQUIRE(!missing.ok());
    CHECK(missing.error().status == ExitStatus::input);
    CHECK(missing.error().message.find("no layer 2; the file has 1 layer") != std::string::npos);
}

TEST_CASE("svg 1: quanta are written with all their digits") {
    const auto text = [](std::int64_t quanta, std::uint32_t nm) {
        std::string out;
        append_mm(out, quanta, Quantum{nm});
        return out;
    };
    CHECK(text(0, 1000) == "0");
    CHECK(text(12345, 1000) == "12.345");
    CHECK(text(-5, 1000) == "-0.005");
    CHECK(text(10000, 1000) == "10");
    CHECK(text(-1, 1) == "-0.000001");
    CHECK(text(coordinate_limit, 1'000'000) == "2147483647");
    CHECK(text(-coordinate_limit, 999'999) == "-2147481499.516353");
}
