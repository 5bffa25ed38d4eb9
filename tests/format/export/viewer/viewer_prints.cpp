// For the viewer's test, which is no C++: prints to look at, and what the reader says of a print.
//
//     viewer_prints make FOLDER        writes kinds.lyr (every kind of operation, at random), small.lyr (likewise, a few
//                                      kB), far.lyr (a circle far from the head's start) and large.lyr (200 layers, a million operations)
//     viewer_prints dump FILE LAYER    a layer's motions, one a line, in quanta: kind, role, from, to, and of an arc the
//                                      sagitta, of a circle its centre and 1 if counter-clockwise; then style
//     viewer_prints heads FILE         a line for each layer: operations, estimated ms, and motions of the layer

#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "format/sample.h"

namespace {

using namespace lyr;
using namespace lyr::format;

[[noreturn]] void fail(const std::string& message) {
    std::fprintf(stderr, "viewer_prints: %s\n", message.c_str());
    std::exit(1);
}

void append(Writer& writer, Result<EncodedLayer> layer) {
    if (!layer) fail(to_string(layer.error()));
    if (Status appended = writer.append(std::move(*layer)); !appended)
        fail(to_string(appended.error()));
}

Writer begin(const std::string& path, Quantum quantum, const std::string& name) {
    Metadata metadata;
    metadata.source_name = name;
    metadata.generator = "viewer_prints";
    auto writer = Writer::create(path, quantum, metadata);
    if (!writer) fail(to_string(writer.error()));
    return std::move(*writer);
}

void finish(Writer& writer) {
    if (const auto totals = writer.finish(); !totals) fail(to_string(totals.error()));
}

void make_kinds(const std::string& path, std::uint32_t layers, int calls) {
    const Quantum quantum{1000};
    Writer writer = begin(path, quantum, "kinds <of> \"operations\" & more");
    for (std::uint32_t seed = 1; seed <= layers; ++seed)
        append(writer, test::RandomLayer(seed, 0.2 * seed, quantum, calls).finish());
    finish(writer);
}

// A hexagon with rounded corners.
void add_cell(LayerEncoder& layer, double x_mm, double y_mm, double radius_mm) {
    constexpr double corner_share = 0.25;
    const auto corner = [&](int k) {
        const double angle = k * std::numbers::pi / 3;
        return std::pair{x_mm + radius_mm * std::cos(angle), y_mm + radius_mm * std::sin(angle)};
    };
    const auto between = [&](int from, int to, double share) {
        const auto [ax, ay] = corner(from);
        const auto [bx, by] = corner(to);
        return std::pair{ax + share * (bx - ax), ay + share * (by - ay)};
    };
    const auto [start_x, start_y] = between(0, 1, corner_share);
    layer.travel_to(start_x, start_y);
    // The arc of 60 degrees that touches both sides.
    const double chord_mm = corner_share * radius_mm * std::sqrt(3);
    const double sagitta_mm = chord_mm / 2 * std::tan(std::numbers::pi / 12);
    for (int k = 0; k < 6; ++k) {
        const auto [line_x, line_y] = between(k, k + 1, 1 - corner_share);
        layer.line_to(line_x, line_y);
        const auto [arc_x, arc_y] = between(k + 1, k + 2, corner_share);
        layer.arc_to(arc_x, arc_y, sagitta_mm);
    }
}

EncodedLayer large_layer(std::uint32_t index) {
    LayerState state = test::RandomLayer::state(0.2 * (index + 1));
    state.estimated_time_s = 60 + 40 * std::sin(0.05 * index);
    LayerEncoder layer({1000}, state);
    constexpr int columns = 20, rows = 18;
    const double radius_mm = 3 + std::sin(0.03 * index);
    for (int row = 0; row < rows; ++row) {
        layer.begin_path({.role = row % 3 == 0 ? Role::inner_wall : Role::outer_wall,
                          .width_mm = 0.45,
                          .height_mm = 0.2,
                          .speed_mm_s = 40.0 + 4 * row});
        for (int column = 0; column < columns; ++column)
            add_cell(layer, 10.0 * column, 10.0 * row + 5 * (column % 2), radius_mm);
        layer.retract();
        layer.unretract();
    }
    layer.begin_path(
        {.role = Role::sparse_infill, .width_mm = 0.5, .height_mm = 0.2, .speed_mm_s = 150});
    for (int k = 0; k < 300; ++k)
        layer.line_to(0.65 * k, (k % 4 < 2) == (index % 2 == 0) ? -8 : -18);
    auto encoded = layer.finish();
    if (!encoded) fail(to_string(encoded.error()));
    return std::move(*encoded);
}

void make_large(const std::string& path) {
    Writer writer = begin(path, {1000}, "large.step");
    for (std::uint32_t index = 0; index < 200; ++index) append(writer, large_layer(index));
    finish(writer);
}

// A circle that the head comes to from far away, and leaves for another far place.
void make_far(const std::string& path) {
    Writer writer = begin(path, {1000}, "far");
    LayerState state = test::RandomLayer::state(0.2);
    state.start_x_mm = state.start_y_mm = 0;
    LayerEncoder layer({1000}, state);
    layer.begin_path(
        {.role = Role::outer_wall, .width_mm = 0.4, .height_mm = 0.2, .flow = 1, .speed_mm_s = 50});
    const double turn = 0.3;
    layer.travel_to(105 + 5 * std::cos(turn), 105 + 5 * std::sin(turn));
    layer.circle(105, 105, true);
    layer.travel_to(0, 250);
    append(writer, layer.finish());
    finish(writer);
}

void print_place(const Point& from, const Point& to) {
    std::printf(" %" PRId64 " %" PRId64 " %" PRId64 " %" PRId64 " %" PRId64 " %" PRId64, from.x,
                from.y, from.z, to.x, to.y, to.z);
}

void print_motion(const Operation& operation, const PathStyle& style) {
    const auto kind = [&](const char* name, int role) { std::printf("%s %d", name, role); };
    const int role = static_cast<int>(style.role);
    if (const auto* line = std::get_if<Line>(&operation)) {
        kind("line", role), print_place(line->from, line->to), std::printf(" 0 0 0");
    } else if (const auto* arc = std::get_if<Arc>(&operation)) {
        kind("arc", role), print_place(arc->from, arc->to);
        std::printf(" %" PRId64 " 0 0", arc->sagitta);
    } else if (const auto* circle = std::get_if<Circle>(&operation)) {
        kind("circle", role), print_place(circle->from, circle->to);
        std::printf(" %" PRId64 " %" PRId64 " %d", circle->center_x, circle->center_y,
                    circle->counter_clockwise);
    } else if (const auto* travel = std::get_if<Travel>(&operation)) {
        kind("travel", -1), print_place(travel->from, travel->to), std::printf(" 0 0 0");
    } else if (const auto* wipe = std::get_if<Wipe>(&operation)) {
        kind("wipe", -1), print_place(wipe->from, wipe->to);
        std::printf(" %" PRId64 " 0 0", wipe->sagitta);
    } else {
        return;
    }
    std::printf(" %.9g %.9g %.9g %.9g\n", style.width_mm, style.height_mm, style.flow,
                style.speed_mm_s);
}

Reader open(const std::string& path) {
    auto reader = Reader::open(path);
    if (!reader) fail(to_string(reader.error()));
    return std::move(*reader);
}

void dump(const std::string& path, std::uint32_t wanted) {
    Reader reader = open(path);
    if (Status sought = reader.seek_layer(wanted); !sought) fail(to_string(sought.error()));
    while (const Operation* operation = reader.read()) {
        if (reader.layer().index != wanted) break;
        print_motion(*operation, reader.path());
    }
    if (reader.error()) fail(to_string(*reader.error()));
}

void heads(const std::string& path) {
    Reader reader = open(path);
    std::uint64_t motions = 0;
    Layer layer;
    const auto end_layer = [&] {
        std::printf("%" PRIu64 " %.0f %" PRIu64 "\n", layer.totals.operations,
                    layer.state.estimated_time_s * 1000, motions);
    };
    bool begun = false;
    while (const Operation* operation = reader.read()) {
        if (std::holds_alternative<LayerStart>(*operation)) {
            if (begun) end_layer();
            begun = true;
            motions = 0;
            layer = reader.layer();
        }
        motions +=
            std::holds_alternative<Line>(*operation) || std::holds_alternative<Arc>(*operation) ||
            std::holds_alternative<Circle>(*operation) ||
            std::holds_alternative<Travel>(*operation) || std::holds_alternative<Wipe>(*operation);
    }
    if (reader.error()) fail(to_string(*reader.error()));
    if (begun) end_layer();
}

}  // namespace

int main(int argc, char** argv) {
    const std::string command = argc > 2 ? argv[1] : "";
    const std::string path = argc > 2 ? argv[2] : "";
    if (command == "make" && argc == 3) {
        make_kinds(path + "/kinds.lyr", 12, 400);
        make_kinds(path + "/small.lyr", 3, 20);
        make_far(path + "/far.lyr");
        make_large(path + "/large.lyr");
    } else if (command == "dump" && argc == 4) {
        dump(path, static_cast<std::uint32_t>(std::strtoul(argv[3], nullptr, 10)));
    } else if (command == "heads" && argc == 3) {
        heads(path);
    } else {
        fail("usage: make FOLDER | dump FILE LAYER | heads FILE");
    }
    return 0;
}
