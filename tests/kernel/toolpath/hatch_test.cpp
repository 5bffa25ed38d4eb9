#include "kernel/toolpath/hatch.h"

#include <doctest/doctest.h>

#include <numbers>
#include <random>

#include "kernel/region/regions.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

double covered_mm2(const Hatch& hatch) {
    double length = 0;
    for (const HatchSpan& span : hatch.spans) length += span.end_mm - span.start_mm;
    return length * hatch.pitch_mm;
}

// A rounded slot with a bulge inwards: lines, arcs of both turns.
Path rounded() {
    Path path{{-5, -2}, {}};
    path.segments.push_back({{5, -2}});
    path.segments.push_back(arc_with_sweep({5, -2}, {5, 2}, pi));
    path.segments.push_back(arc_with_sweep({5, 2}, {-5, 2}, -0.4 * pi));
    path.segments.push_back(arc_with_sweep({-5, 2}, {-5, -2}, 1.3 * pi));
    return path;
}

// Whether a point is inside by its winding: the sum of the angles under which the contour is seen, arcs by many
// chords. Independent of the code under test.
bool inside(std::span<const Contour> contours, const Point2& point) {
    double turn = 0;
    const auto add = [&](Point2 a, Point2 b) {
        a -= point;
        b -= point;
        turn += std::atan2(cross(a, b), a.dot(b));
    };
    for (const Contour& contour : contours) {
        if (const auto* c = std::get_if<FullCircle>(&contour)) {
            const double out = (point - c->centre).norm() < c->radius_mm ? 2 * pi : 0;
            turn += c->counter_clockwise ? out : -out;
            continue;
        }
        const Path& path = std::get<Path>(contour);
        Point2 from = path.start;
        for (const Segment& segment : path.segments) {
            for (int i = 0; i < 200; ++i) {
                add(point_at(from, segment, i / 200.0), point_at(from, segment, (i + 1) / 200.0));
            }
            from = segment.end;
        }
    }
    return turn > pi;
}

}  // namespace

TEST_CASE("hatch: covers the area of lines and arcs, in any direction") {
    const std::vector<Contour> region{rounded(), FullCircle{{1, -0.5}, 0.7, false}};
    double area = 0;
    for (const Contour& contour : region) area += area_mm2(contour);
    for (double angle = 0; angle < pi; angle += 0.1) {
        CHECK(covered_mm2(hatch(region, angle, 0.002)) == doctest::Approx(area).epsilon(1e-4));
    }
}

TEST_CASE("hatch 2: every span's ends lie on the boundary, its middle inside, the gaps outside") {
    const std::vector<Contour> region{rounded(), FullCircle{{1, -0.5}, 0.7, false}};
    for (double angle = 0.05; angle < pi; angle += 0.37) {
        const Hatch rows = hatch(region, angle, 0.13);
        const Vector2 left(-rows.direction.y(), rows.direction.x());
        for (std::size_t row = 0; row < rows.row_count(); ++row) {
            const double offset = rows.first_offset_mm + static_cast<double>(row) * rows.pitch_mm;
            const auto at = [&](double along) {
                return Point2(along * rows.direction + offset * left);
            };
            for (std::uint32_t s = rows.row_start[row]; s < rows.row_start[row + 1]; ++s) {
                const HatchSpan& span = rows.spans[s];
                REQUIRE(span.start_mm < span.end_mm);
                for (const double end : {span.start_mm, span.end_mm}) {
                    double off = std::abs((at(end) - Point2(1, -0.5)).norm() - 0.7);
                    const Path path = rounded();
                    Point2 from = path.start;
                    for (const Segment& segment : path.segments) {
                        off = std::min(off, distance_mm(from, segment, at(end)));
                        from = segment.end;
                    }
                    CHECK(off < 1e-9);
                }
                CHECK(inside(region, at((span.start_mm + span.end_mm) / 2)));
                if (s + 1 < rows.row_start[row + 1]) {
                    CHECK(!inside(region, at((span.end_mm + rows.spans[s + 1].start_mm) / 2)));
                }
            }
        }
    }
}

TEST_CASE("hatch 1: rows through corners and along edges cross an even number of times") {
    // Rows at (k + 1/2): corners and horizontal edges lie exactly on rows.
    const std::vector<Contour> region{rectangle(-3.5, -2.5, 4.5, 3.5)};
    const Hatch rows = hatch(region, 0, 1);
    CHECK(covered_mm2(rows) == doctest::Approx(48));
    CHECK(rows.spans.size() == 6);
    const std::vector<Contour> diamond{
        Path{{0, -2.5}, {{{2.5, 0}}, {{0, 2.5}}, {{-2.5, 0}}, {{0, -2.5}}}}};
    for (const double angle : {0.0, pi / 2, pi, -pi / 2, pi / 4}) {
        CHECK(covered_mm2(hatch(diamond, angle, 1)) == doctest::Approx(12.5).epsilon(0.2));
    }
    // A circle that touches rows at its top and bottom.
    const std::vector<Contour> circle{FullCircle{{0, 0}, 2.5, true}};
    for (const HatchSpan& span : hatch(circle, 0, 1).spans) CHECK(span.end_mm > span.start_mm);
}

TEST_CASE("hatch 3: overlapping and touching regions are one") {
    const std::vector<Contour> overlapping{rectangle(0, 0, 4, 4), rectangle(2, 0, 6, 4)};
    CHECK(covered_mm2(hatch(overlapping, 0, 0.1)) == doctest::Approx(24));
    const std::vector<Contour> touching{rectangle(0, 0, 4, 4), rectangle(4, 0, 6, 4)};
    const Hatch rows = hatch(touching, 0, 0.5);
    CHECK(rows.spans.size() == rows.row_count());
}

TEST_CASE("hatch 4: rows of different regions are in register") {
    const Hatch a = hatch(std::vector<Contour>{rectangle(0, 0.2, 1, 7)}, 0.3, 0.4);
    const Hatch b = hatch(std::vector<Contour>{rectangle(9, -3.1, 11, 2)}, 0.3, 0.4);
    const double rows_apart = (a.first_offset_mm - b.first_offset_mm) / 0.4;
    CHECK(std::abs(rows_apart - std::round(rows_apart)) < 1e-9);
}
