// What diff() finds is what was changed.

#include "format/export/diff.h"

#include <doctest/doctest.h>

#include <functional>

#include "format/sample.h"
#include "scratch.h"

using namespace lyr;
using namespace lyr::format;

namespace {

struct Part {
    double z_mm = 0.2;
    double shift_mm = 0;  // of one corner
    double thickness_mm = 0.2;
    int more = 0;  // motions
    Quantum quantum{1000};
};

EncodedLayer layer_of(const Part& part) {
    LayerState state;
    state.z_mm = part.z_mm;
    state.height_mm = part.thickness_mm;
    LayerEncoder layer(part.quantum, state);
    layer.begin_path({Role::outer_wall, 0.45, 0.2, 1, 60, 0});
    layer.line_to(10, 0);
    layer.line_to(10 + part.shift_mm, 10);
    for (int i = 0; i < part.more; ++i) layer.line_to(9 - i, 10);
    layer.arc_to(0, 10, 1);
    layer.line_to(0, 0);
    auto encoded = layer.finish();
    REQUIRE(encoded.ok());
    return *encoded;
}

std::string write(const std::string& name, const std::vector<Part>& parts,
                  const Metadata& metadata = {}) {
    const std::string path = lyr::tests::scratch("diff-" + name + ".lyr");
    const Quantum quantum = parts.empty() ? Quantum{1000} : parts.front().quantum;
    auto writer = Writer::create(path, quantum, metadata);
    REQUIRE(writer.ok());
    for (const Part& part : parts) REQUIRE(writer->append(layer_of(part)).ok());
    REQUIRE(writer->finish().ok());
    return path;
}

Difference found(const std::string& a, const std::string& b) {
    const auto difference = diff(a, b);
    REQUIRE_MESSAGE(difference.ok(), to_string(difference.error()));
    return *difference;
}

const std::vector<Part> three{{0.2}, {0.4}, {0.6}};

}  // namespace

TEST_CASE("diff 1: a print does not differ from itself, nor from itself in another unit") {
    const std::string a = write("a", three);
    Difference d = found(a, a);
    CHECK_FALSE(d.any());
    CHECK(d.same_layers == 3);
    std::vector<Part> fine = three;
    for (Part& part : fine) part.quantum = Quantum{500};
    d = found(a, write("fine", fine));
    CHECK(d.layers.empty());
    REQUIRE(d.metadata.size() == 1);
    CHECK(d.metadata[0].key == "quantum_nm");
}

TEST_CASE("diff 3: one corner that moved is one operation, and how far it moved") {
    std::vector<Part> moved = three;
    moved[1].shift_mm = 0.25;
    const Difference d = found(write("a", three), write("b", moved));
    REQUIRE(d.layers.size() == 1);
    CHECK(d.same_layers == 2);
    const LayerDifference& layer = d.layers[0];
    CHECK(layer.a == 1u);
    CHECK(layer.b == 1u);
    CHECK(layer.first == 3);
    // The line to it and the arc from it, whose beginning is another one.
    CHECK(layer.changed_a == 2);
    CHECK(layer.changed_b == 2);
    CHECK(layer.farthest_mm == doctest::Approx(0.25));
    CHECK(layer.first_a == "line to (10.000, 10.000, 0.400)");
    CHECK(layer.first_b == "line to (10.250, 10.000, 0.400)");
    CHECK(d.b.roles[1].length_mm > d.a.roles[1].length_mm);
}

TEST_CASE("diff 3: motions that were added, and the layer's state") {
    std::vector<Part> more = three;
    more[0].more = 2;
    more[2].thickness_mm = 0.25;
    const Difference d = found(write("a", three), write("b", more));
    REQUIRE(d.layers.size() == 2);
    CHECK(d.layers[0].first == 4);
    CHECK(d.layers[0].changed_b == d.layers[0].changed_a + 2);
    CHECK(d.layers[0].farthest_mm > 1);
    CHECK(d.layers[1].first == 0);
    CHECK(d.layers[1].state == std::vector<std::string>{"thickness 0.2, 0.25 mm"});
    const Difference back = found(write("b", more), write("a", three));
    CHECK(back.layers[0].farthest_mm == d.layers[0].farthest_mm);
}

TEST_CASE("diff 2: layers that only one has, between, above, and in another pass") {
    const std::string a = write("a", three);
    Difference d = found(a, write("b", {{0.2}, {0.3}, {0.4}, {0.6}, {0.8}}));
    REQUIRE(d.layers.size() == 2);
    CHECK_FALSE(d.layers[0].a.has_value());
    CHECK(d.layers[0].b == 1u);
    CHECK(d.layers[1].b == 4u);
    CHECK(d.same_layers == 3);
    // Two parts, one after the other; the first one is a layer lower in b.
    const std::string two = write("two", {{0.2}, {0.4}, {0.6}, {0.2}, {0.4}});
    d = found(two, write("b", {{0.2}, {0.4}, {0.2}, {0.4}}));
    REQUIRE(d.layers.size() == 1);
    CHECK(d.layers[0].a == 2u);
    CHECK_FALSE(d.layers[0].b.has_value());
    CHECK(d.same_layers == 4);
    d = found(write("none", {}), a);
    CHECK(d.layers.size() == 3);
    CHECK(found(a, write("none", {})).layers.size() == 3);
}

TEST_CASE("diff 1: metadata and settings by their keys, where values come from apart") {
    Metadata a, b;
    a.material = "PLA";
    b.material = "PETG";
    a.objects = {"one", "two"};
    b.objects = {"one"};
    a.configuration = "[layer]\nheight = 0.2   # default\nkept = \"a # b\"\n[infill]\ngone = 1\n";
    b.configuration = "[layer]\nheight = 0.1   # --set\nkept = \"a # b\" # x\n";
    const Difference d = found(write("a", three, a), write("b", three, b));
    CHECK(d.layers.empty());
    REQUIRE(d.metadata.size() == 2);
    CHECK(d.metadata[0].key == "material");
    CHECK(d.metadata[0].a == "PLA");
    CHECK(d.metadata[0].b == "PETG");
    CHECK(d.metadata[1].key == "object 2");
    CHECK_FALSE(d.metadata[1].b.has_value());
    REQUIRE(d.configuration.size() == 2);
    CHECK(d.configuration[0].key == "infill.gone");
    CHECK_FALSE(d.configuration[0].b.has_value());
    CHECK(d.configuration[1].key == "layer.height");
    CHECK(d.configuration[1].b == "0.1");
}

TEST_CASE("diff: random prints differ from others and not from themselves; the text says so") {
    const auto random = [](std::uint32_t seed) {
        const std::string path = lyr::tests::scratch("diff-random.lyr" + std::to_string(seed));
        auto writer = Writer::create(path, Quantum{1000}, {});
        auto layer = test::RandomLayer(seed, 0.2, Quantum{1000}, 2000).finish();
        REQUIRE(layer.ok());
        REQUIRE(writer->append(*layer).ok());
        REQUIRE(writer->finish().ok());
        return path;
    };
    const std::string a = random(1), b = random(2);
    CHECK_FALSE(found(a, a).any());
    const Difference d = found(a, b);
    REQUIRE(d.layers.size() == 1);
    CHECK(d.layers[0].farthest_mm > 1);
    const std::string text = to_text(d, "a.lyr", "b.lyr");
    CHECK(text.starts_with("a.lyr  ->  b.lyr\n1 layer, 1 layer; 0 the same\n"));
    CHECK(text.find("ends up to ") != std::string::npos);
    CHECK(text.find("outer wall") != std::string::npos);
}
