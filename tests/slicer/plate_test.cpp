// Contract of slicer/plate.h, by number, and prints of several copies.

#include "slicer/plate.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "format/arc.h"
#include "format/reader.h"
#include "scratch.h"

using namespace lyr;
using namespace lyr::slicer;

namespace {

using Box2 = Eigen::AlignedBox2d;

struct Wish {
    double width_mm = 30, depth_mm = 20, height_mm = 10;
    std::uint32_t copies = 1;
    std::array<double, 2> at_mm{0, 0}, plate_mm{0, 0};
    double spacing_mm = 6;
    profile::AdhesionKind adhesion = profile::AdhesionKind::none;
};

profile::Profile profile_of(const Wish& wish) {
    profile::Profile profile;
    profile.plate.copies = wish.copies;
    profile.plate.at_mm = wish.at_mm;
    profile.plate.size_mm = wish.plate_mm;
    profile.plate.spacing_mm = wish.spacing_mm;
    profile.adhesion.kind = wish.adhesion;
    return profile;
}

Eigen::AlignedBox3d box_of(const Wish& wish) {
    const Vector3 corner(wish.at_mm[0], wish.at_mm[1], 0);
    return {corner, Vector3(corner + Vector3(wish.width_mm, wish.depth_mm, wish.height_mm))};
}

std::vector<Box2> boxes_of(const Wish& wish, const PlateLayout& layout) {
    const Point2 corner(wish.at_mm[0], wish.at_mm[1]);
    std::vector<Box2> boxes;
    for (const Vector2& shift : layout.shifts)
        boxes.emplace_back(Point2(corner + shift),
                           Point2(corner + shift + Vector2(wish.width_mm, wish.depth_mm)));
    return boxes;
}

double least_distance_mm(const std::vector<Box2>& boxes) {
    double least_mm = 1e9;
    for (std::size_t i = 0; i < boxes.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            least_mm = std::min(least_mm, boxes[i].exteriorDistance(boxes[j]));
    return least_mm;
}

std::size_t stated_number(const std::string& text, const std::string& before) {
    const std::size_t at = text.find(before);
    REQUIRE_MESSAGE(at != std::string::npos, text);
    return static_cast<std::size_t>(std::stoul(text.substr(at + before.size())));
}

}  // namespace

TEST_CASE("plate 1, 2: copies are as far apart as asked for, on the plate, and all there") {
    for (const std::uint32_t copies : {1u, 2u, 3u, 5u, 7u, 12u, 30u})
        for (const double depth_mm : {20.0, 3.3, 90.123456})
            for (const bool is_stated : {false, true})
                for (const double spacing_mm : {0.0, 6.0}) {
                    Wish wish{.depth_mm = depth_mm, .copies = copies, .at_mm = {5, -7.5}};
                    wish.spacing_mm = spacing_mm;
                    if (is_stated) wish.plate_mm = {300, 620}, wish.at_mm = {5, 7};
                    const auto layout = lay_out(box_of(wish), profile_of(wish));
                    REQUIRE(layout);
                    const auto boxes = boxes_of(wish, *layout);
                    REQUIRE(boxes.size() == copies);
                    CHECK(layout->shifts[0] == Vector2(0, 0));
                    CHECK(layout->columns * layout->rows >= copies);
                    CHECK(layout->columns * (layout->rows - 1) < copies);
                    if (copies > 1) {
                        const double gap_mm = least_distance_mm(boxes);
                        CHECK(gap_mm > spacing_mm - 1e-9);
                        CHECK(gap_mm < spacing_mm + 0.0011);
                    }
                    for (const Vector2& shift : layout->shifts)
                        for (const double length_mm : {shift.x(), shift.y()})
                            CHECK(std::abs(length_mm * 1e3 - std::round(length_mm * 1e3)) < 1e-6);
                    const Box2 plate(Point2(0, 0), Point2(300, 620));
                    for (const Box2& box : boxes) CHECK((!is_stated || plate.contains(box)));
                }
}

TEST_CASE("plate 2: of the grids that fit it is next to a square, and turned with the plate") {
    const auto grid = [](Wish wish) {
        const auto layout = lay_out(box_of(wish), profile_of(wish));
        REQUIRE(layout);
        return std::pair(layout->columns, layout->rows);
    };
    CHECK(grid({.copies = 6}) == std::pair<std::size_t, std::size_t>(2, 3));
    CHECK(grid({.width_mm = 20, .depth_mm = 30, .copies = 6}) ==
          std::pair<std::size_t, std::size_t>(3, 2));
    CHECK(grid({.width_mm = 10, .depth_mm = 10, .copies = 9}) ==
          std::pair<std::size_t, std::size_t>(3, 3));
    CHECK(grid({.copies = 6, .plate_mm = {500, 30}}) == std::pair<std::size_t, std::size_t>(6, 1));
    CHECK(grid({.copies = 6, .plate_mm = {30, 500}}) == std::pair<std::size_t, std::size_t>(1, 6));
}

TEST_CASE(
    "plate 2: too many copies are refused with how many would fit, one less than that is not") {
    for (const double width_mm : {100.0, 63.0, 200.0})
        for (const double depth_mm : {20.0, 46.0, 180.0}) {
            Wish wish{.copies = 1'000, .at_mm = {3, 0}, .plate_mm = {width_mm, depth_mm}};
            const auto refused = lay_out(box_of(wish), profile_of(wish));
            REQUIRE(!refused);
            CHECK(refused.error().status == ExitStatus::geometry);
            const std::size_t most = stated_number(refused.error().message, "at most ");
            CHECK(most >= 1);
            wish.copies = static_cast<std::uint32_t>(most);
            CHECK(lay_out(box_of(wish), profile_of(wish)));
            ++wish.copies;
            CHECK(!lay_out(box_of(wish), profile_of(wish)));
        }
    // No size is stated: there is a limit all the same.
    const Wish endless{.width_mm = 900, .depth_mm = 900, .copies = 10'000};
    CHECK(!lay_out(box_of(endless), profile_of(endless)));
}

TEST_CASE("plate 1: brims are as far apart as copies without") {
    Wish wish{.copies = 4, .adhesion = profile::AdhesionKind::brim};
    const auto layout = lay_out(box_of(wish), profile_of(wish));
    REQUIRE(layout);
    // At least 5 mm each, in whole lines of less than 0.45 mm.
    const double gap_mm = least_distance_mm(boxes_of(wish, *layout));
    CHECK(gap_mm >= 6 + 2 * 5);
    CHECK(gap_mm < 6 + 2 * (5 + 0.5));
}

TEST_CASE("plate 3: each copy follows a neighbour") {
    for (std::uint32_t copies = 1; copies <= 40; ++copies)
        for (const double depth_mm : {20.0, 45.0}) {
            const Wish wish{.depth_mm = depth_mm, .copies = copies};
            const auto layout = lay_out(box_of(wish), profile_of(wish));
            REQUIRE(layout);
            std::vector<std::uint32_t> sorted = layout->order;
            std::sort(sorted.begin(), sorted.end());
            REQUIRE(sorted.size() == copies);
            for (std::uint32_t i = 0; i < copies; ++i) CHECK(sorted[i] == i);
            for (std::size_t i = 1; i < copies; ++i) {
                const auto a = layout->order[i - 1], b = layout->order[i];
                const auto columns = static_cast<std::uint32_t>(layout->columns);
                const auto apart = [](std::uint32_t p, std::uint32_t q) {
                    return p > q ? p - q : q - p;
                };
                CHECK(apart(a % columns, b % columns) <= 1);
                CHECK(apart(a / columns, b / columns) <= 1);
            }
        }
}

TEST_CASE("plate: the outline holds all boxes and nothing where none is") {
    for (std::uint32_t copies = 1; copies <= 12; ++copies) {
        const Wish wish{.copies = copies};
        const auto layout = lay_out(box_of(wish), profile_of(wish));
        REQUIRE(layout);
        REQUIRE(layout->outline.size() == 1);
        const double pitch_x = 36, pitch_y = 26;
        const auto columns = static_cast<double>(layout->columns);
        const auto rows = static_cast<double>(layout->rows);
        const double missing = columns * rows - copies;
        const double whole_mm2 = (columns * pitch_x - 6) * (rows * pitch_y - 6);
        CHECK(area_mm2(layout->outline[0]) ==
              doctest::Approx(whole_mm2 - missing * pitch_x * pitch_y));
    }
}

namespace {

Summary printed(const std::string& part, const std::string& name, const Options& options) {
    Diagnostics diagnostics;
    auto model = load(std::string(LYR_FIXTURES) + "/parts/" + part, options, diagnostics);
    REQUIRE(model);
    const auto summary = print(
        std::move(*model), part, lyr::tests::scratch(name), "", options,
        [](const char*, std::size_t, std::size_t) {}, diagnostics);
    REQUIRE(summary);
    CHECK(diagnostics.empty());
    return *summary;
}

Options thick_layers() {
    Options options;
    options.profile.layer.height_mm = options.profile.layer.first_height_mm = 0.35;
    options.profile.travel.wipe_mm = 1;
    return options;
}

// What is extruded and travelled for one object, by layer of the part; points from the first one on.
struct Trace {
    std::vector<std::size_t> kinds;
    std::vector<format::Point> points;
    std::vector<double> bends;
};

format::Point less(const format::Point& a, const format::Point& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

// Ends of a hatch and centres are rounded twice.
constexpr std::int64_t most_quanta_off = 3;

// From a piece's start to where the hatch's grid has it.
bool is_rounding(const format::Travel& travel) {
    const format::Point way = less(travel.to, travel.from);
    return std::max({std::abs(way.x), std::abs(way.y), std::abs(way.z)}) <= most_quanta_off;
}

// By object and height. Ways to an object's start belong to nobody.
using Traces = std::map<std::pair<std::uint32_t, std::int64_t>, Trace>;

class Tracer {
public:
    void take(const format::Operation& operation, const format::Reader& reader) {
        if (const auto* start = std::get_if<format::LayerStart>(&operation)) {
            object_ = reader.layer().state.object;
            z_ = start->start.z;
            enters_ = true;
        } else if (const auto* object = std::get_if<format::Object>(&operation)) {
            object_ = object->object;
            enters_ = true;
        } else if (const auto* line = std::get_if<format::Line>(&operation)) {
            enters_ = false;
            put(operation, line->to, 0);
        } else if (const auto* arc = std::get_if<format::Arc>(&operation)) {
            enters_ = false;
            put(operation, arc->to, static_cast<double>(arc->sagitta));
        } else if (const auto* circle = std::get_if<format::Circle>(&operation)) {
            enters_ = false;
            put(operation, {circle->center_x, circle->center_y, circle->to.z}, 0);
        } else if (const auto* travel = std::get_if<format::Travel>(&operation)) {
            if (!enters_ && !is_rounding(*travel)) put(operation, travel->to, 0);
        }
    }

    Traces traces;

private:
    void put(const format::Operation& operation, const format::Point& to, double bend) {
        Trace& trace = traces[{object_, z_}];
        trace.kinds.push_back(operation.index());
        trace.points.push_back(to);
        trace.bends.push_back(bend);
    }

    std::uint32_t object_ = 0;
    std::int64_t z_ = 0;
    bool enters_ = true;
};

Traces traces_of(const std::string& name) {
    auto reader = format::Reader::open(lyr::tests::scratch(name));
    REQUIRE(reader);
    Tracer tracer;
    while (const format::Operation* operation = reader->read()) tracer.take(*operation, *reader);
    CHECK(!reader->error());
    return tracer.traces;
}

void check_same_shape(const Trace& a, const Trace& b) {
    REQUIRE(a.kinds == b.kinds);
    std::int64_t worst = 0;
    double worst_bend = 0;
    for (std::size_t i = 0; i < a.points.size(); ++i) {
        const format::Point off =
            less(less(a.points[i], a.points[0]), less(b.points[i], b.points[0]));
        worst = std::max({worst, std::abs(off.x), std::abs(off.y), std::abs(off.z)});
        worst_bend = std::max(worst_bend, std::abs(a.bends[i] - b.bends[i]));
    }
    CHECK(worst <= most_quanta_off);
    CHECK(worst_bend <= 2);
}

void check_copies(const Traces& one, const Traces& many, std::uint32_t copies) {
    CHECK(many.size() == copies * one.size());
    for (const auto& [key, trace] : one)
        for (std::uint32_t object = 1; object <= copies; ++object) {
            CAPTURE(key.second);
            const auto found = many.find({object, key.second});
            REQUIRE(found != many.end());
            check_same_shape(trace, found->second);
        }
}

}  // namespace

TEST_CASE("plate: every copy is printed like the only one, in every layer, whole") {
    Options options = thick_layers();
    printed("cube_hole.step", "one.lyr", options);
    options.profile.plate.copies = 5;
    const Summary summary = printed("cube_hole.step", "five.lyr", options);
    CHECK(summary.placed == "5 copies in 3 rows, 6 mm apart, layer by layer\n");
    check_copies(traces_of("one.lyr"), traces_of("five.lyr"), 5);
    auto reader = format::Reader::open(lyr::tests::scratch("five.lyr"));
    REQUIRE(reader);
    CHECK(reader->header().metadata.objects.size() == 5);
    CHECK(reader->header().metadata.objects[4] == "cube_hole.step 5");
    // Before it goes to another copy the filament is drawn back; and a layer begins with the copy that ended the last.
    std::set<std::uint32_t> in_layer;
    std::uint32_t object = 0;
    bool drawn_back = false;
    while (const format::Operation* operation = reader->read()) {
        if (std::holds_alternative<format::LayerStart>(*operation)) {
            const std::uint32_t first = reader->layer().state.object;
            if (object != 0) {
                CHECK(in_layer.size() == 5);
                CHECK(first == object);
            }
            in_layer = {first};
            object = first;
        }
        if (const auto* next = std::get_if<format::Object>(operation)) {
            CHECK(in_layer.insert(next->object).second);
            object = next->object;
            drawn_back = false;
        }
        if (const auto* retract = std::get_if<format::Retract>(operation))
            drawn_back = retract->depth_mm > 0 || drawn_back;
        if (std::holds_alternative<format::PathStart>(*operation) && in_layer.size() > 1)
            CHECK(drawn_back);
        // Along the copy that was left, not the one that is gone to.
        if (const auto* wipe = std::get_if<format::Wipe>(operation)) CHECK(wipe->left_mm < 1.01);
    }
}

TEST_CASE("plate: one skirt goes around all copies, brims around each do not touch") {
    Options options = thick_layers();
    options.profile.plate.copies = 3;
    options.profile.plate.at_mm = {50, 50};
    for (const auto kind : {profile::AdhesionKind::skirt, profile::AdhesionKind::brim}) {
        options.profile.adhesion.kind = kind;
        const Summary summary = printed("cuboid.step", "around.lyr", options);
        auto reader = format::Reader::open(lyr::tests::scratch("around.lyr"));
        REQUIRE(reader);
        std::map<std::uint32_t, Box2> around;
        std::uint32_t object = 0;
        const auto reach = [&](const format::Point& point) {
            const auto role = reader->path().role;
            if (role == format::Role::skirt || role == format::Role::brim)
                around[object].extend(Point2(static_cast<double>(point.x) * 1e-3,
                                             static_cast<double>(point.y) * 1e-3));
        };
        while (const format::Operation* operation = reader->read()) {
            if (std::holds_alternative<format::LayerStart>(*operation)) {
                if (reader->layer().index > 0) break;
                object = reader->layer().state.object;
            }
            if (const auto* next = std::get_if<format::Object>(operation)) object = next->object;
            if (const auto* line = std::get_if<format::Line>(operation)) reach(line->to);
            if (const auto* arc = std::get_if<format::Arc>(operation)) reach(arc->to);
        }
        std::vector<Box2> boxes;
        for (const auto& [number, box] : around) boxes.push_back(box);
        const double width_mm = options.profile.perimeters.width_mm;
        if (kind == profile::AdhesionKind::skirt) {
            REQUIRE(boxes.size() == 1);
            CHECK(around.count(0) == 1);
            // Two beside each other, one behind; 6 mm around, and half of a line.
            const Vector3 size = summary.box.sizes();
            const double reach_mm = 6 + width_mm / 2;
            CHECK((boxes[0].min() - Point2(50 - reach_mm, 50 - reach_mm)).norm() < 0.01);
            const double columns = boxes[0].sizes().x() > 1.5 * size.x() + 12 ? 2 : 1;
            CHECK(boxes[0].sizes().x() ==
                  doctest::Approx(columns * (size.x() + 6) - 6 + 2 * reach_mm).epsilon(1e-4));
        } else {
            REQUIRE(boxes.size() == 3);
            CHECK(least_distance_mm(boxes) == doctest::Approx(6 + width_mm).epsilon(1e-3));
        }
    }
}

TEST_CASE(
    "plate: copies cost the time and the material of as many parts, and the same bytes on any "
    "thread") {
    Options options = thick_layers();
    const Summary one = printed("cube_hole.step", "one.lyr", options);
    options.profile.plate.copies = 4;
    std::set<std::string> results;
    for (const unsigned threads : {1u, 3u}) {
        options.threads = threads;
        const Summary four = printed("cube_hole.step", "threads.lyr", options);
        CHECK(four.filament_mm == doctest::Approx(4 * one.filament_mm).epsilon(1e-4));
        // A layer may be slowed down alone, but not with three others.
        CHECK(four.estimate.time_s() < 4.1 * one.estimate.time_s());
        CHECK(four.estimate.time_s() > 2 * one.estimate.time_s());
        std::ifstream file(lyr::tests::scratch("threads.lyr"), std::ios::binary);
        results.insert({std::istreambuf_iterator<char>(file), {}});
    }
    CHECK(results.size() == 1);
}

TEST_CASE("travels inside of a part never retracted, however long") {
    std::map<double, std::size_t> retractions;
    for (const double inside_mm : {0.0, 5.0, 30.0}) {
        Options options = thick_layers();
        options.profile.travel.retract_inside_mm = inside_mm;
        printed("cuboid.step", "inside.lyr", options);
        auto reader = format::Reader::open(lyr::tests::scratch("inside.lyr"));
        REQUIRE(reader);
        double depth_mm = 0, travelled_mm = 0;
        while (const format::Operation* operation = reader->read()) {
            if (const auto* retract = std::get_if<format::Retract>(operation)) {
                retractions[inside_mm] += retract->depth_mm > depth_mm;
                depth_mm = retract->depth_mm;
            }
            const auto* travel = std::get_if<format::Travel>(operation);
            if (!travel) travelled_mm = 0;
            if (!travel || depth_mm > 0) continue;
            const double mm = reader->header().quantum.nm * 1e-6;
            travelled_mm += mm * std::hypot(static_cast<double>(travel->to.x - travel->from.x),
                                            static_cast<double>(travel->to.y - travel->from.y));
            if (inside_mm > 0) CHECK(travelled_mm < inside_mm + 1e-3);
        }
    }
    CHECK(retractions[5.0] > retractions[30.0]);
    CHECK(retractions[30.0] >= retractions[0.0]);
}

TEST_CASE(
    "encode: the way from a brim to the walls retracts, also where the bed's origin is inside") {
    Options options = thick_layers();
    options.profile.adhesion.kind = profile::AdhesionKind::brim;
    options.profile.travel.retract_min_travel_mm = 0.1;
    options.profile.plate.at_mm = {-40, -10};
    printed("cuboid.step", "origin.lyr", options);
    auto reader = format::Reader::open(lyr::tests::scratch("origin.lyr"));
    REQUIRE(reader);
    bool drawn_back = false;
    while (const format::Operation* operation = reader->read()) {
        const format::Role role = reader->path().role;
        if (const auto* path = std::get_if<format::PathStart>(operation))
            if (path->style.role != format::Role::brim) break;
        if (std::holds_alternative<format::Line>(*operation) && role == format::Role::brim)
            drawn_back = false;
        if (const auto* retract = std::get_if<format::Retract>(operation))
            drawn_back = drawn_back || retract->depth_mm > 0;
    }
    CHECK(drawn_back);
}
