// Cells and borders of free-form surfaces: a tiling, few, and true to their kind.

#include "kernel/section/height_mesh.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "kernel/geometry/random_surfaces.h"

using namespace lyr;

namespace {

using std::numbers::pi;

HeightMesh mesh_of(const BSplineSurface& surface) {
    return height_mesh(std::make_shared<const BSplineSurface>(surface));
}

double slope_u(const HeightMesh& mesh, const Point2& uv) {
    return partials(*mesh.surface, uv).du.z();
}
double slope_v(const HeightMesh& mesh, const Point2& uv) {
    return partials(*mesh.surface, uv).dv.z();
}

}  // namespace

TEST_CASE("cells 1: they tile the parameters' rectangle") {
    test::Random random(1);
    for (int number = 0; number < 60; ++number) {
        CAPTURE(number);
        const BSplineSurface s = test::random_surface(random);
        const HeightMesh mesh = mesh_of(s);
        double area = 0;
        for (const MonotoneCell& cell : mesh.cells) {
            CHECK(cell.from_u < cell.to_u);
            CHECK(cell.from_v < cell.to_v);
            area += (cell.to_u - cell.from_u) * (cell.to_v - cell.from_v);
        }
        const double whole = (s.end_u() - s.start_u()) * (s.end_v() - s.start_v());
        CHECK(area == doctest::Approx(whole).epsilon(1e-12));
    }
}

TEST_CASE("cells 2: where a slope is said to have one sign, it has; flat cells are flat") {
    test::Random random(2);
    for (int number = 0; number < 60; ++number) {
        CAPTURE(number);
        const HeightMesh mesh = mesh_of(test::random_surface(random));
        for (const MonotoneCell& cell : mesh.cells) {
            double low = 1e9, high = -1e9;
            for (int i = 0; i < 6; ++i) {
                const Point2 uv(random.between(cell.from_u, cell.to_u),
                                random.between(cell.from_v, cell.to_v));
                const double u = slope_u(mesh, uv), v = slope_v(mesh, uv);
                const double z = evaluate(*mesh.surface, uv).z();
                low = std::min(low, z);
                high = std::max(high, z);
                // Relative to slopes of up to hundreds of millimetres a knot, round-off.
                constexpr double round_off = 1e-9;
                const bool over_u =
                    cell.kind == CellKind::graph_over_u || cell.kind == CellKind::both;
                const bool over_v =
                    cell.kind == CellKind::graph_over_v || cell.kind == CellKind::both;
                if (over_u) CHECK((cell.rises_v ? v : -v) >= -round_off);
                if (over_v) CHECK((cell.rises_u ? u : -u) >= -round_off);
            }
            if (cell.kind == CellKind::flat) CHECK(high - low <= flat_cell_mm);
        }
    }
}

// The line's homogeneous control points, and those of the cubic with its ends and derivatives there.
double worst_distance_from_cubic(const BezierPatch& patch, bool along_u, double fixed) {
    const int degree = along_u ? patch.degree_u : patch.degree_v;
    const auto at = [&](double t) { return along_u ? Point2(t, fixed) : Point2(fixed, t); };
    const Partials first = partials(patch, at(0)), last = partials(patch, at(1));
    const Vector3 leaves = along_u ? first.du : first.dv, arrives = along_u ? last.du : last.dv;
    double worst = 0;
    for (double t = 0; t <= 1; t += 1.0 / (16 * degree)) {
        const double r = 1 - t;
        const Point3 cubic = r * r * (1 + 2 * t) * first.point + t * t * (3 - 2 * t) * last.point +
                             r * r * t * leaves - t * t * r * arrives;
        worst = std::max(worst, (partials(patch, at(t)).point - cubic).norm());
    }
    return worst;
}

TEST_CASE("patch 2: the quartic part bounds the distance from cubics, and not too generously") {
    std::mt19937 engine(3);
    std::uniform_real_distribution<double> coordinate(-1, 1);
    for (int degree = 1; degree <= 9; ++degree) {
        for (int number = 0; number < 10; ++number) {
            CAPTURE(degree);
            BezierPatch patch{0, 1, 0, 1, degree, 1 + number % 9, {}};
            for (int i = 0; i < (patch.degree_u + 1) * (patch.degree_v + 1); ++i)
                patch.control_points.push_back(
                    {coordinate(engine), coordinate(engine), coordinate(engine), 1});
            const QuarticPart part = quartic_part(patch);
            double along_u = 0, along_v = 0;
            for (const double fixed : {0.0, 0.3, 0.5, 0.8, 1.0}) {
                along_u = std::max(along_u, worst_distance_from_cubic(patch, true, fixed));
                along_v = std::max(along_v, worst_distance_from_cubic(patch, false, fixed));
            }
            CHECK(along_u <= part.along_u_mm + 1e-12);
            CHECK(along_v <= part.along_v_mm + 1e-12);
            CHECK(part.along_u_mm <= 1000 * along_u + 1e-12);
            CHECK(part.along_v_mm <= 1000 * along_v + 1e-12);
        }
    }
}

TEST_CASE("mesh 2: every border piece has the cells on its two sides, at the rim one") {
    test::Random random(3);
    for (int number = 0; number < 60; ++number) {
        CAPTURE(number);
        const HeightMesh mesh = mesh_of(test::random_surface(random));
        const BSplineSurface& s = *mesh.surface;
        for (const BorderPiece& piece : mesh.pieces) {
            CHECK(piece.start < piece.end);
            const double low = piece.along_u ? s.start_v() : s.start_u();
            const double high = piece.along_u ? s.end_v() : s.end_u();
            const bool closed = piece.along_u ? s.closed_v : s.closed_u;
            const bool rim = !closed && (piece.fixed == low || piece.fixed == high);
            CHECK(((piece.left >= 0) + (piece.right >= 0)) == (rim ? 1 : 2));
        }
    }
}

TEST_CASE("mesh 1: around every cell the border falls as often as it rises, at any height") {
    test::Random random(4);
    for (int number = 0; number < 30; ++number) {
        const HeightMesh mesh = mesh_of(test::random_surface(random));
        for (int plane = 0; plane < 10; ++plane) {
            const double z = random.between(-8, 8);
            std::vector<int> balance(mesh.cells.size(), 0);
            for (const BorderPiece& piece : mesh.pieces) {
                const int rise =
                    (mesh.vertices[piece.to].z_mm > z) - (mesh.vertices[piece.from].z_mm > z);
                if (piece.left >= 0) balance[static_cast<std::size_t>(piece.left)] += rise;
                if (piece.right >= 0) balance[static_cast<std::size_t>(piece.right)] -= rise;
            }
            for (const int sum : balance) CHECK(sum == 0);
        }
    }
}

TEST_CASE("cells: round-off along a level circle does not divide it without end") {
    const Frame upright{Point3::Zero(), Vector3::UnitX(), Vector3::UnitZ(), -Vector3::UnitY()};
    const BSplineSurface ball = revolved(rational(Circle{upright, 5}, -pi / 2, pi / 2), Frame{});
    CHECK(mesh_of(ball).cells.size() < 200);
    for (const double lean : {1e-12, 1e-9, 1e-6, 1e-3, 0.1}) {
        CAPTURE(lean);
        const Eigen::Affine3d turn(Eigen::AngleAxisd(lean, Vector3(1, 2, 0).normalized()));
        CHECK(mesh_of(transformed(ball, turn)).cells.size() < 1000);
    }
}
