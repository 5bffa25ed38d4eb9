#include "kernel/contour/turned_round.h"

#include <doctest/doctest.h>

using namespace lyr;

namespace {

const Path open{{0, 0}, {{{3, 0}}, {{4, 1}, 0.2}, {{4, 5}, -0.7}}};
const Path closed{{0, 0}, {{{3, 0}}, {{4, 1}, 0.2}, {{0, 0}, 0.1}}};

}  // namespace

TEST_CASE("turned round: an open path runs from its end to its start, on the same points") {
    const Path back = turned_round(open);
    CHECK(back.start == open.segments.back().end);
    CHECK(back.segments.back().end == open.start);
    REQUIRE(back.segments.size() == 3);
    CHECK((point_at(back.start, back.segments[0], 0.3) -
           point_at(open.segments[1].end, open.segments[2], 0.7))
              .norm() < 1e-12);
    const Path again = turned_round(back);
    CHECK(again.start == open.start);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(again.segments[i].end == open.segments[i].end);
        CHECK(again.segments[i].sagitta_mm == open.segments[i].sagitta_mm);
    }
    CHECK(turned_round(Path{{1, 2}, {}}).start == Point2(1, 2));
}

TEST_CASE("turned round: a contour starts where it did, with its area's sign changed") {
    const Contour back = turned_round(Contour(closed));
    CHECK(start_of(back) == closed.start);
    CHECK(area_mm2(back) == doctest::Approx(-area_mm2(Contour(closed))));
    CHECK(length_mm(back) == doctest::Approx(length_mm(Contour(closed))));
    const auto circle = std::get<FullCircle>(turned_round(Contour(FullCircle{{1, 2}, 3, true})));
    CHECK(!circle.counter_clockwise);
    CHECK(circle.centre == Point2(1, 2));
    CHECK(circle.radius_mm == 3);
}
