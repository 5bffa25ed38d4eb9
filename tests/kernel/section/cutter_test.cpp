// Invariants of sections: closed whatever the height and the position, areas that add up to the volume,
// contours on the surfaces within the tolerance.

#include "kernel/section/cutter.h"

#include <doctest/doctest.h>

#include <random>
#include <string>

#include "kernel/brep/placement.h"
#include "kernel/section_figures.h"
#include "kernel/solids.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

// By rings: the height of the tube over the rim, integrated over the disc.
double spindle_dome_volume(double major, double minor, double radius, bool inner_sheet) {
    const auto height = [&](double r) {
        const double from_tube = inner_sheet ? r + major : r - major;
        return std::sqrt(minor * minor - from_tube * from_tube);
    };
    constexpr int rings = 200000;
    double volume = 0;
    for (int i = 0; i < rings; ++i) {
        const double r = radius * (i + 0.5) / rings;
        volume += 2 * pi * r * (height(r) - height(radius)) * radius / rings;
    }
    return volume;
}

struct Case {
    std::string name;
    Model model;
    double volume_mm3;
};

std::vector<Case> solids() {
    const double ball_volume = pi * 64 * (3 * 6 - 8) / 3;  // 8 high over the cut
    return {{"box", box(7, 5, 3), 105},
            {"cylinder, seam", frustum(4, 4, 9, Side::seam), pi * 144},
            {"cylinder, halves", frustum(4, 4, 9, Side::halves), pi * 144},
            {"cylinder, two loops", frustum(4, 4, 9, Side::two_loops), pi * 144},
            {"half round", half_round(3, 8), pi * 36},
            {"frustum, seam", frustum(2, 5, 6, Side::seam), pi * 6 / 3 * (4 + 10 + 25)},
            {"frustum, halves", frustum(5, 2, 6, Side::halves), pi * 6 / 3 * (4 + 10 + 25)},
            {"frustum, two loops", frustum(5, 2, 6, Side::two_loops), pi * 6 / 3 * (4 + 10 + 25)},
            {"cone, seam", cone_with_apex(3, 8, true), pi * 9 * 8 / 3},
            {"cone, no seam", cone_with_apex(3, 8, false), pi * 9 * 8 / 3},
            {"sphere, seam", sphere(5, true), pi * 4 / 3 * 125},
            {"sphere, no edge", sphere(5, false), pi * 4 / 3 * 125},
            {"cut ball", cut_ball(6, 2), ball_volume},
            {"torus, seams", torus(6, 2, true), 2 * pi * pi * 6 * 4},
            {"torus, no edge", torus(6, 2, false), 2 * pi * pi * 6 * 4},
            {"halved ball", halved_ball(5), pi * 4 / 3 * 125},
            {"halved torus", halved_torus(6, 2), 2 * pi * pi * 6 * 4},
            {"dented dome", spindle_dome(2, 5, 6, false), spindle_dome_volume(2, 5, 6, false)},
            {"pointed dome", spindle_dome(2, 5, 2.5, true), spindle_dome_volume(2, 5, 2.5, true)}};
}

std::vector<Eigen::Affine3d> positions() {
    std::vector<Eigen::Affine3d> result{Eigen::Affine3d::Identity()};
    for (const Vector3& axis : {Vector3(1, 0, 0), Vector3(0, 1, 0)}) {
        for (const double angle : {pi / 2, -pi / 2, pi}) {
            result.emplace_back(Eigen::AngleAxisd(angle, axis));
        }
    }
    std::mt19937 random(11);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 6; ++i) {
        const Vector3 axis = Vector3(normal(random), normal(random), normal(random)).normalized();
        Eigen::Affine3d position(Eigen::AngleAxisd(normal(random), axis));
        position.pretranslate(Vector3(30 * normal(random), 10, 5 * normal(random)));
        result.push_back(position);
    }
    // Almost upright and almost level.
    for (const double angle : {1e-12, 1e-8, 1e-5, pi / 2 - 1e-12, pi / 2 - 1e-8, pi / 2 - 1e-5}) {
        result.emplace_back(Eigen::AngleAxisd(angle, Vector3(1, 2, 0).normalized()));
    }
    Eigen::Affine3d mirrored = result[8];
    mirrored.prescale(Vector3(1, -1, 1));
    result.push_back(mirrored);
    return result;
}

}  // namespace

TEST_CASE("cutter 2, 3: in every position the areas of closed contours add up to the volume") {
    const Tolerance tolerance{0.001};
    const std::vector<Case> cases = solids();
    for (std::size_t which = 0; which < cases.size(); ++which) {
        const Case& solid = cases[which];
        CAPTURE(solid.name);
        // Every second position, in turns.
        for (std::size_t number = which % 2; number < positions().size(); number += 2) {
            CAPTURE(number);
            const Eigen::Affine3d position = positions()[number];
            const Model model = transformed(solid.model, position);
            const Cutter cutter(model, tolerance);
            const HeightRange range = cutter.height_range();
            constexpr int planes = 400, looked_at = 7;
            const double step = (range.top_mm - range.bottom_mm) / planes;
            double volume = 0, worst = 0, allowed = 0;
            for (int i = 0; i < planes; ++i) {
                const Section section = cutter.cut(range.bottom_mm + (i + 0.5) * step);
                REQUIRE(section.open == 0);
                REQUIRE(section.diagnostics.empty());
                volume += step * area_of(section);
                allowed += step * length_of(section) * tolerance.total_mm;
                if (i % looked_at == 0) worst = std::max(worst, worst_distance(model, section));
            }
            // The midpoint rule on an area that starts like a square root is good to planes^-1.5.
            CHECK(std::abs(volume - solid.volume_mm3) < 2e-4 * solid.volume_mm3 + allowed);
            CHECK(worst <= tolerance.total_mm);
        }
    }
}

TEST_CASE("cutter 3: a solid that is inside out is reported and left out") {
    const Tolerance tolerance{0.005};
    for (const Case& solid : solids()) {
        CAPTURE(solid.name);
        const Model turned = transformed(solid.model, positions()[9]);
        const Model hollow = inside_out(turned);
        const Cutter cutter(turned, tolerance), inverse(hollow, tolerance);
        const HeightRange range = cutter.height_range();
        for (double share = 0.03; share < 1; share += 0.07) {
            const double z = range.bottom_mm + share * (range.top_mm - range.bottom_mm);
            const Section a = cutter.cut(z), b = inverse.cut(z);
            CHECK(a.open == 0);
            CHECK(b.open == (area_of(a) > tolerance.total_mm * length_of(a) ? 1 : 0));
            CHECK(b.diagnostics.size() == b.open);
            if (b.open > 0) CHECK(b.solids.empty());
        }
    }
}

TEST_CASE("cutter: no height fails, also where a plane touches or holds faces and edges") {
    const Tolerance tolerance{0.005};
    for (const Case& solid : solids()) {
        for (std::size_t p = 0; p < 7; ++p) {
            CAPTURE(solid.name);
            CAPTURE(p);
            const Model model = transformed(solid.model, positions()[p]);
            const Cutter cutter(model, tolerance);
            const HeightRange range = cutter.height_range();
            std::vector<double> special{range.bottom_mm, range.top_mm, 0, 1, 2, 3, 4, -2, -4};
            for (const Vertex& vertex : model.vertices) special.push_back(vertex.point.z());
            for (const double height : special) {
                for (const double off : {0.0, 1e-15, -1e-15, 1e-12, -1e-12, 1e-9, -1e-9, 1e-8,
                                         -1e-8, 1e-7, -1e-7, 1e-6, -1e-6}) {
                    const Section section = cutter.cut(height + off);
                    CHECK(section.open == 0);
                    CHECK(area_of(section) >= -1e-9);
                    CHECK(std::isfinite(area_of(section)));
                }
            }
        }
    }
}

TEST_CASE(
    "cutter: a side face that begins at the level tangent the plane touches is cut on its own "
    "side") {
    // Round-off puts the crossings of the two end arcs on different sides of the tangent.
    for (const double turn : {pi / 2, -pi / 2}) {
        Model model = transformed(half_round(0.625, 1.5),
                                  Eigen::Affine3d(Eigen::AngleAxisd(turn, Vector3::UnitY())));
        for (Edge& edge : model.edges) {
            auto* circle = std::get_if<Circle>(&edge.curve);
            if (circle && edge.source % 2) circle->frame.x += 1e-8 * circle->frame.y;
        }
        const Cutter cutter(model, {});
        for (const double z : {-0.625, -0.625 + 1e-15, 0.625, 0.625 - 1e-15, 0.0}) {
            const Section section = cutter.cut(z);
            CHECK(section.open == 0);
            CHECK(section.diagnostics.empty());
            CHECK(area_of(section) >= -1e-9);
        }
    }
}

TEST_CASE("cutter: a plane through the circle where two faces meet gives the section once") {
    for (const double off : {0.0, 1e-12, -1e-12, 1e-9, -1e-9, 1e-7, -1e-7, 1e-5, -1e-5, 1e-3}) {
        const Model ball = halved_ball(5), ring = halved_torus(6, 2);
        CHECK(area_of(Cutter(ball, {}).cut(off)) == doctest::Approx(pi * 25).epsilon(1e-6));
        CHECK(area_of(Cutter(ring, {}).cut(off)) == doctest::Approx(pi * 48).epsilon(1e-6));
    }
}

TEST_CASE("cutter: at the saddles of a standing torus the two lobes touch and each is cut once") {
    for (const bool seam : {true, false}) {
        for (const double turn : {pi / 2, -pi / 2}) {
            const Model model = transformed(
                torus(6, 2, seam), Eigen::Affine3d(Eigen::AngleAxisd(turn, Vector3::UnitX())));
            const Cutter cutter(model, {});
            for (const double saddle : {-4.0, 4.0}) {
                const double near = area_of(cutter.cut(saddle + 1e-6));
                for (const double off : {0.0, 1e-15, -1e-15, 1e-12, -1e-12, 1e-9, -1e-9}) {
                    const Section section = cutter.cut(saddle + off);
                    CHECK(section.open == 0);
                    CHECK(area_of(section) == doctest::Approx(near).epsilon(1e-3));
                }
            }
        }
    }
}

TEST_CASE("cutter 5: a chamfered hexagon is cut right at its own corners") {
    // A cone over a hexagon: planes through the corners meet three edges in one point.
    const Model model = hexagon_under_cone(4, 2, 3);
    const Cutter cutter(model, {});
    std::vector<double> heights;
    for (const Vertex& vertex : model.vertices) heights.push_back(vertex.point.z());
    const HeightRange range = cutter.height_range();
    for (const double height : heights) {
        for (const double off : {0.0, 1e-15, -1e-15, 1e-12, -1e-12, 1e-9, -1e-9, 1e-8, -1e-8}) {
            const double z = height + off;
            const double above = area_of(cutter.cut(z + 1e-4)),
                         below = area_of(cutter.cut(z - 1e-4));
            if (z + 1e-4 >= range.top_mm || z - 1e-4 <= range.bottom_mm) continue;
            const Section section = cutter.cut(z);
            CHECK(section.open == 0);
            CHECK(section.diagnostics.empty());
            CHECK(area_of(section) > std::min(above, below) - 1e-2);
            CHECK(area_of(section) < std::max(above, below) + 1e-2);
        }
    }
}

TEST_CASE("cutter: circles stay circles") {
    const Tolerance tolerance{0.005};
    for (const Side side : {Side::seam, Side::halves, Side::two_loops}) {
        for (const Model& model : {frustum(4, 4, 9, side), frustum(2, 5, 6, side)}) {
            const Section section = Cutter(model, tolerance).cut(1);
            REQUIRE(section.solids.size() == 1);
            REQUIRE(section.solids[0].contours.size() == 1);
            const auto* circle = std::get_if<FullCircle>(&section.solids[0].contours[0]);
            REQUIRE(circle);
            CHECK(circle->counter_clockwise);
        }
    }
    const Section ring = Cutter(torus(6, 2, true), tolerance).cut(1);
    REQUIRE(ring.solids[0].contours.size() == 2);
    for (const Contour& contour : ring.solids[0].contours) {
        CHECK(std::holds_alternative<FullCircle>(contour));
    }
}

TEST_CASE("cutter 4: renumbered and reversed edges give the same figures") {
    const Tolerance tolerance{0.005};
    Model model = transformed(frustum(2, 5, 6, Side::halves), positions()[8]);
    Model other = model;
    for (Edge& edge : other.edges) {
        std::swap(edge.start, edge.end);
        std::swap(edge.t_start, edge.t_end);
    }
    for (Coedge& coedge : other.coedges) coedge.reversed = !coedge.reversed;
    const Cutter a(model, tolerance), b(other, tolerance);
    const HeightRange range = a.height_range();
    for (double share = 0.01; share < 1; share += 0.01) {
        const double z = range.bottom_mm + share * (range.top_mm - range.bottom_mm);
        CHECK(area_of(a.cut(z)) == doctest::Approx(area_of(b.cut(z))).epsilon(1e-9));
    }
}

TEST_CASE("cutter 2: a missing face is counted and located, not bridged") {
    Model model = box(7, 5, 3);
    model.faces.pop_back();
    model.faces.erase(model.faces.begin());
    model.shells[0].face_count = static_cast<std::uint32_t>(model.faces.size());
    const Section section = Cutter(model, {}).cut(0.1);
    CHECK(section.open > 0);
    REQUIRE(!section.diagnostics.empty());
    CHECK(section.diagnostics[0].where.entity != 0);
    CHECK(section.diagnostics[0].where.z_mm == 0.1);
}
