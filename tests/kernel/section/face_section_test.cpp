#include "kernel/section/face_section.h"

#include <doctest/doctest.h>

#include <numbers>

using namespace lyr;

namespace {

FaceCrossing on_line(std::uint32_t crossing, bool enters, double x) {
    return {crossing, enters, {{x, 0, 0}, {x, 0, 0}}};
}

FaceCrossing on_circle(std::uint32_t crossing, bool enters, double angle) {
    const Point3 point(std::cos(angle), std::sin(angle), 0);
    return {crossing, enters, {point, point}};
}

const SurfaceSection line = LineSection{{1, 0}};
const SurfaceSection circle = CircleSection{{0, 0}, 1, {1, 0}, {true, false}, 0};

}  // namespace

TEST_CASE("face section 2: crossings in any order are paired along the line") {
    const std::vector<FaceCrossing> crossings{on_line(0, false, 4), on_line(1, true, 3),
                                              on_line(2, false, 2), on_line(3, true, 1)};
    const FaceSpans spans = pair_crossings(line, crossings);
    REQUIRE(spans.spans.size() == 2);
    CHECK(spans.spans[0].enter == 3);
    CHECK(spans.spans[0].leave == 2);
    CHECK(spans.spans[1].enter == 1);
    CHECK(spans.spans[1].leave == 0);
    CHECK(spans.unpaired.empty());
    CHECK(spans.forced == 0);
}

TEST_CASE("face section 2: on a circle a span may run over the cut of the angle") {
    const std::vector<FaceCrossing> crossings{on_circle(0, true, 3.0), on_circle(1, false, -3.0)};
    const FaceSpans spans = pair_crossings(circle, crossings);
    REQUIRE(spans.spans.size() == 1);
    CHECK(spans.spans[0].to - spans.spans[0].from ==
          doctest::Approx(2 * std::numbers::pi - 6.0).epsilon(1e-12));
}

TEST_CASE("face section 3: a seam gives one span all the way round") {
    const std::vector<FaceCrossing> crossings{on_circle(0, true, 1), on_circle(0, false, 1)};
    const FaceSpans spans = pair_crossings(circle, crossings);
    REQUIRE(spans.spans.size() == 1);
    CHECK(spans.spans[0].to - spans.spans[0].from ==
          doctest::Approx(2 * std::numbers::pi).epsilon(1e-12));
}

TEST_CASE("face section 4: neighbours exchanged by round-off are paired in their order") {
    const std::vector<FaceCrossing> crossings{on_line(0, true, 0), on_line(1, false, 1 + 1e-12),
                                              on_line(2, true, 1), on_line(3, false, 2)};
    const FaceSpans spans = pair_crossings(line, crossings);
    REQUIRE(spans.spans.size() == 2);
    CHECK(spans.spans[0].enter == 0);
    CHECK(spans.spans[0].leave == 1);
    CHECK(spans.spans[1].enter == 2);
    CHECK(spans.spans[1].leave == 3);
}

TEST_CASE("face section: an enter without a leave is left over, not lost") {
    const FaceSpans spans = pair_crossings(line, std::vector{on_line(5, true, 0)});
    CHECK(spans.spans.empty());
    REQUIRE(spans.unpaired.size() == 1);
    CHECK(spans.unpaired[0] == 5);
}

TEST_CASE("section 5: to an end far off its component only a straight line leads (111FACE)") {
    Frame lying;
    lying.z = Vector3::UnitY();
    lying.x = Vector3::UnitZ();
    lying.y = lying.z.cross(lying.x);
    // Cut beside the axis: a hyperbola.
    const SurfaceSection section =
        section_of(Cone{lying, 3.2, std::numbers::pi / 180}, true, 3.1, 100);
    REQUIRE(std::holds_alternative<ConeSection>(section));
    const Point2 start = at(section, {0, -0.27}).point, end = at(section, {0, -0.19}).point;
    const Vector2 aside(0.3, 1);
    for (const double off_mm : {0.0, 1e-6, 0.01}) {
        std::vector<Segment> out;
        CHECK(trace(section, 0, -0.27, -0.19, start, end + off_mm * aside, {}, out));
        CHECK(out.back().end == end + off_mm * aside);
        CHECK(out.size() < 20);
    }
    for (const double off_mm : {3.0, 300.0}) {
        std::vector<Segment> out;
        CHECK_FALSE(trace(section, 0, -0.27, -0.19, start, end - off_mm * aside, {}, out));
        REQUIRE(out.size() == 1);
        CHECK(out[0].end == end - off_mm * aside);
        CHECK(out[0].sagitta_mm == 0);
    }
    CHECK(is_unbroken(section, -0.27, 1.5));
    CHECK_FALSE(is_unbroken(section, -0.27, 1.6));
    CHECK_FALSE(is_unbroken(section, -2, 1));
}
