// The numbers are those of the contract in kernel/geometry/bspline_surface.h.

#include "kernel/geometry/bspline_surface.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "kernel/geometry/bspline_jet.h"
#include "kernel/geometry/random_surfaces.h"
#include "kernel/geometry/surface.h"
#include "kernel/geometry/tolerance.h"

using namespace lyr;
using lyr::test::Random;

namespace {

// De Casteljau on intermediate points of at most 100 mm: far below what coordinates carry.
constexpr double patch_bound_mm = 1e-10;

Point3 bezier_at(const BezierPatch& patch, double u, double v) {
    const auto order_u = static_cast<std::size_t>(patch.degree_u) + 1;
    const auto order_v = static_cast<std::size_t>(patch.degree_v) + 1;
    auto c = patch.control_points;
    for (std::size_t i = 0; i < order_u; ++i) {
        for (std::size_t level = order_v - 1; level > 0; --level) {
            for (std::size_t j = 0; j < level; ++j) {
                c[i * order_v + j] = (1 - v) * c[i * order_v + j] + v * c[i * order_v + j + 1];
            }
        }
    }
    for (std::size_t level = order_u - 1; level > 0; --level) {
        for (std::size_t i = 0; i < level; ++i) {
            c[i * order_v] = (1 - u) * c[i * order_v] + u * c[(i + 1) * order_v];
        }
    }
    return c[0].head<3>() / c[0].w();
}

// The smallest distance on a grid, then on ever finer ones about the best point so far.
double sampled_distance_mm(const BSplineSurface& s, const Point3& p) {
    constexpr int steps = 60;
    Point2 low(s.start_u(), s.start_v()), high(s.end_u(), s.end_v());
    double least = 1e9;
    for (int round = 0; round < 8; ++round) {
        Point2 best = low;
        for (int i = 0; i <= steps; ++i) {
            for (int j = 0; j <= steps; ++j) {
                const Point2 share(i / double(steps), j / double(steps));
                const Point2 uv = low + share.cwiseProduct(high - low);
                const double distance = (evaluate(s, uv) - p).norm();
                if (distance <= least) {
                    least = distance;
                    best = uv;
                }
            }
        }
        const Vector2 reach = 2.0 / steps * (high - low);
        low = (best - reach).cwiseMax(Point2(s.start_u(), s.start_v()));
        high = (best + reach).cwiseMin(Point2(s.end_u(), s.end_v()));
    }
    return least;
}

}  // namespace

TEST_CASE("1: partials are the limits of differences") {
    Random random(1);
    for (int i = 0; i < 1000; ++i) {
        const BSplineSurface s = test::random_surface(random);
        const Point2 uv = test::random_parameters(random, s);
        const Partials at = partials(s, uv);
        CHECK((at.point - evaluate(s, uv)).norm() <= 1e-12);
        // A kink within the step would spoil the difference, hence one-sided towards each side: one of both is good.
        const double h = 1e-6;
        const auto off = [&](const Vector2& step, const Vector3& slope) {
            const double ahead = ((evaluate(s, uv + h * step) - at.point) / h - slope).norm();
            const double behind = ((at.point - evaluate(s, uv - h * step)) / h - slope).norm();
            return std::min(ahead, behind) / (1 + slope.norm());
        };
        CHECK(off(Vector2::UnitX(), at.du) <= 1e-3);
        CHECK(off(Vector2::UnitY(), at.dv) <= 1e-3);
    }
}

TEST_CASE("1: parameters outside the domain are clamped, or wrap where the surface closes") {
    Random random(2);
    int closed = 0;
    for (int i = 0; i < 200; ++i) {
        const BSplineSurface s = test::random_surface(random);
        const Point2 uv = test::random_parameters(random, s);
        const double turn = s.end_u() - s.start_u();
        if (s.closed_u) {
            ++closed;
            CHECK((evaluate(s, uv + Vector2(3 * turn, 0)) - evaluate(s, uv)).norm() <= 1e-9);
        } else {
            CHECK(evaluate(s, {s.end_u() + 1, uv.y()}) == evaluate(s, {s.end_u(), uv.y()}));
        }
        CHECK(evaluate(s, {uv.x(), s.start_v() - 1}) == evaluate(s, {uv.x(), s.start_v()}));
    }
    CHECK(closed > 10);
}

TEST_CASE("1: degrees up to the highest") {
    Random random(3);
    for (int i = 0; i < 20; ++i) {
        BSplineSurface s = test::random_surface(random, highest_surface_degree);
        const Point2 uv = test::random_parameters(random, s);
        const Point2 found = invert(s, evaluate(s, uv));
        CHECK((evaluate(s, found) - evaluate(s, uv)).norm() <= resolution_mm);
    }
}

TEST_CASE("2: the patches together are the surface, and neighbours share their border") {
    Random random(4);
    for (int i = 0; i < 300; ++i) {
        const BSplineSurface s = test::random_surface(random);
        const BezierPatches all = bezier_patches(s);
        REQUIRE(all.patches.size() == all.spans_u * all.spans_v);
        CHECK(all.patches.front().from_u == s.start_u());
        CHECK(all.patches.back().to_v == s.end_v());
        const auto order_u = static_cast<std::size_t>(s.degree_u) + 1;
        const auto order_v = static_cast<std::size_t>(s.degree_v) + 1;
        for (std::size_t k = 0; k < all.patches.size(); ++k) {
            const BezierPatch& patch = all.patches[k];
            for (const auto& [a, b] : {std::pair(0.0, 0.0), {0.3, 0.8}, {1.0, 0.5}, {1.0, 1.0}}) {
                const Point2 uv(patch.from_u + a * (patch.to_u - patch.from_u),
                                patch.from_v + b * (patch.to_v - patch.from_v));
                CHECK((bezier_at(patch, a, b) - evaluate(s, uv)).norm() <= patch_bound_mm);
            }
            if (k % all.spans_v > 0) {
                const BezierPatch& before = all.patches[k - 1];
                CHECK(before.to_v == patch.from_v);
                for (std::size_t j = 0; j < order_u; ++j) {
                    CHECK(before.control_points[j * order_v + order_v - 1] ==
                          patch.control_points[j * order_v]);
                }
            }
            if (k >= all.spans_v) {
                const BezierPatch& before = all.patches[k - all.spans_v];
                for (std::size_t j = 0; j < order_v; ++j) {
                    CHECK(before.control_points[(order_u - 1) * order_v + j] ==
                          patch.control_points[j]);
                }
            }
        }
    }
}

TEST_CASE("3: a point of the surface is found again") {
    Random random(5);
    for (int i = 0; i < 1500; ++i) {
        const BSplineSurface s = test::random_surface(random);
        Point2 uv = test::random_parameters(random, s);
        if (i % 5 == 0) uv.x() = random.coin() ? s.start_u() : s.end_u();
        if (i % 7 == 0) uv.y() = random.coin() ? s.start_v() : s.end_v();
        const Point3 p = evaluate(s, uv);
        CHECK((evaluate(s, invert(s, p)) - p).norm() <= resolution_mm);
        // Beyond a kink, another part of these crumpled sheets may be nearer to the guess.
        const Vector2 nudge(random.between(-0.01, 0.01), random.between(-0.01, 0.01));
        const Point2 guess = smooth_window(s, uv).clamped(uv + nudge);
        CHECK((evaluate(s, invert_near(s, p, guess)) - p).norm() <= resolution_mm);
    }
}

TEST_CASE("3: no sampled point is nearer") {
    Random random(6);
    for (int i = 0; i < 150; ++i) {
        const BSplineSurface s = test::random_surface(random);
        const Point3 p = Point3(25, 25, 0) + random.vector(i % 2 == 0 ? 25 : 60);
        const Point2 uv = invert(s, p);
        CHECK(uv.x() >= s.start_u());
        CHECK(uv.x() <= s.end_u());
        CHECK(uv.y() >= s.start_v());
        CHECK(uv.y() <= s.end_v());
        const double sampled = sampled_distance_mm(s, p);
        CHECK((evaluate(s, uv) - p).norm() <= sampled * (1 + 1e-6) + 1e-9);
    }
}

TEST_CASE("3: a point just off the surface has its foot there") {
    Random random(7);
    for (int i = 0; i < 300; ++i) {
        const BSplineSurface s = test::random_surface(random);
        const Point2 uv = test::random_parameters(random, s);
        const double off_mm = std::pow(10, random.between(-6, -2));
        const Point3 p = evaluate(s, uv) + off_mm * normal(s, uv);
        CHECK((evaluate(s, invert(s, p)) - p).norm() <= off_mm * (1 + 1e-6) + 1e-9);
    }
}

TEST_CASE("4: the normal is that of the partials, also at a pole") {
    Random random(8);
    for (int i = 0; i < 500; ++i) {
        const BSplineSurface s = test::random_surface(random);
        const Point2 uv = test::random_parameters(random, s);
        const Partials at = partials(s, uv);
        CHECK((normal(s, uv) - at.du.cross(at.dv).normalized()).norm() <= 1e-6);
    }
}

TEST_CASE("5: a surface moves, scales and is mirrored with its points and its normal") {
    Random random(9);
    for (int i = 0; i < 500; ++i) {
        const BSplineSurface s = test::random_surface(random);
        const Eigen::Affine3d t = random.similarity(true);
        const BSplineSurface moved = transformed(s, t);
        const Point2 uv = test::random_parameters(random, s);
        CHECK((evaluate(moved, uv) - t * evaluate(s, uv)).norm() <= 1e-9);
        const Vector3 expected = (t.linear() * normal(s, uv)).normalized();
        CHECK((normal(moved, uv) - expected).norm() <= 1e-6);
    }
}

TEST_CASE("6: a flat sheet is a plane with the surface's normal") {
    Random random(10);
    for (int i = 0; i < 200; ++i) {
        BSplineSurface s = test::random_surface(random);
        CHECK(!as_plane(s));
        for (Point3& p : s.control_points) p.z() = 3;
        // Steps shorter than those of the sheet keep it from folding over.
        for (std::size_t k = 0; k < s.control_points.size(); ++k) {
            const auto i_u = static_cast<double>(k / s.count_v),
                       i_v = static_cast<double>(k % s.count_v);
            s.control_points[k] = Point3(5 * i_u, 5 * i_v, 3) +
                                  Vector3(random.between(-1, 1), random.between(-1, 1), 0);
        }
        const Eigen::Affine3d t = random.similarity(true);
        const BSplineSurface moved = transformed(s, t);
        const std::optional<Plane> plane = as_plane(moved);
        REQUIRE(plane);
        const Point2 uv = test::random_parameters(random, s);
        CHECK(std::abs(plane->frame.to_local(evaluate(moved, uv)).z()) <= resolution_mm);
        CHECK((plane->frame.z - normal(moved, uv)).norm() <= 1e-6);
    }
}
