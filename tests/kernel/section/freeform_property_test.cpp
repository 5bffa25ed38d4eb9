// Random lofts and bodies of revolution: what must hold of any of them, whichever way they lie.

#include <doctest/doctest.h>

#include "kernel/brep/placement.h"
#include "kernel/brep/volume.h"
#include "kernel/freeform_solids.h"
#include "kernel/geometry/random_curves.h"
#include "kernel/section/cutter.h"
#include "kernel/section_figures.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

std::vector<double> clamped_knots(int degree, std::size_t count) {
    std::vector<double> knots(static_cast<std::size_t>(degree) + 1, 0.0);
    const std::size_t spans = count - static_cast<std::size_t>(degree);
    for (std::size_t i = 1; i < spans; ++i) knots.push_back(static_cast<double>(i));
    knots.resize(count + static_cast<std::size_t>(degree) + 1, static_cast<double>(spans));
    return knots;
}

// A tower of random star-shaped rings, smooth along v, each ring a B-spline that closes with a corner, with flat ends.
Model loft(test::Random& random) {
    const int degree_u = random.integer(2, 5), degree_v = random.integer(1, 5);
    const auto ring_points = static_cast<std::size_t>(degree_u + random.integer(3, 6));
    const auto rings = static_cast<std::size_t>(degree_v + random.integer(1, 4));
    const bool rational = random.coin();
    BSplineSurface s{degree_u,
                     degree_v,
                     ring_points,
                     rings,
                     clamped_knots(degree_u, ring_points),
                     clamped_knots(degree_v, rings),
                     {},
                     {}};
    s.closed_u = true;
    s.control_points.resize(ring_points * rings);
    if (rational) s.weights.resize(ring_points * rings);
    for (std::size_t j = 0; j < rings; ++j) {
        const double z = 5.0 * static_cast<double>(j);
        // Inner rings bulge and sag; the ends are flat.
        const double wave = j == 0 || j + 1 == rings ? 0 : 1.5;
        for (std::size_t i = 0; i < ring_points; ++i) {
            const bool last = i + 1 == ring_points;
            const double angle =
                2 * pi * static_cast<double>(i) / static_cast<double>(ring_points - 1);
            const double radius = random.between(6, 12);
            Point3 p(radius * std::cos(angle), radius * std::sin(angle),
                     z + random.between(-wave, wave));
            if (last) p = s.control_points[j];
            s.control_points[i * rings + j] = p;
            const double weight = random.between(0.6, 1.6);
            if (rational) s.weights[i * rings + j] = last ? s.weights[j] : weight;
        }
    }
    // Along v all weights of an end's line belong to the boundary curve as they are.
    const auto line = [&](bool along_u, std::size_t at) {
        BSplineCurve curve{
            along_u ? s.degree_u : s.degree_v, along_u ? s.knots_u : s.knots_v, {}, {}};
        curve.closed = along_u;
        for (std::size_t i = 0; i < (along_u ? ring_points : rings); ++i) {
            const std::size_t k = along_u ? i * rings + at : at * rings + i;
            curve.control_points.push_back(s.control_points[k]);
            if (rational) curve.weights.push_back(s.weights[k]);
        }
        return curve;
    };
    Builder b;
    const Point3 &low = s.control_points.front(), &high = s.control_points[rings - 1];
    const VertexId bottom = b.vertex(low.x(), low.y(), low.z()),
                   top = b.vertex(high.x(), high.y(), high.z());
    const EdgeId lower = b.edge(line(true, 0), bottom, bottom),
                 upper = b.edge(line(true, rings - 1), top, top),
                 seam = b.edge(line(false, 0), bottom, top);
    b.face(std::make_shared<const BSplineSurface>(s), true,
           {{{lower}, {seam}, {upper, true}, {seam, true}}});
    b.face(Plane{Builder::looking(low, -Vector3::UnitZ())}, true, {{{lower, true}}});
    b.face(Plane{Builder::looking(high, Vector3::UnitZ())}, true, {{{upper}}});
    return b.finish();
}

// A vase without edges: a random profile from the axis up to the axis.
BSplineCurve profile(test::Random& random) {
    BSplineCurve c;
    c.degree = random.integer(2, 6);
    const auto count = static_cast<std::size_t>(c.degree + random.integer(2, 5));
    c.knots = clamped_knots(c.degree, count);
    for (std::size_t i = 0; i < count; ++i) {
        const bool end = i == 0 || i + 1 == count;
        c.control_points.push_back({end ? 0 : random.between(4, 12), 0,
                                    4.0 * static_cast<double>(i) + random.between(-2.5, 2.5)});
    }
    return c;
}

// pi r^2 dz along the profile, panel by panel.
double volume_of_revolution(const BSplineCurve& c) {
    constexpr int panels = 20'000;
    double volume = 0;
    const double width = (c.domain_end() - c.domain_start()) / panels;
    for (int i = 0; i < panels; ++i) {
        const auto at = point_and_tangent(c, c.domain_start() + (i + 0.5) * width);
        volume += pi * at.point.x() * at.point.x() * at.tangent.z() * width;
    }
    return volume;
}

// Closed, and adding up to the volume.
void check_sections(const Model& model, double volume_mm3) {
    const SectionSum sum = sum_of_sections(model, Tolerance{0.001}, 300);
    CHECK(std::abs(sum.volume_mm3 - volume_mm3) < 5e-4 * volume_mm3 + sum.allowed_mm3);
}

std::size_t loops_of(const Section& section) {
    std::size_t loops = 0;
    for (const SolidSection& solid : section.solids) loops += solid.contours.size();
    return loops;
}

// Seen in a mirror, sections are the mirrored ones.
void check_mirrored(const Model& model) {
    const Tolerance tolerance{0.001};
    Eigen::Affine3d mirror = Eigen::Affine3d::Identity();
    mirror.scale(Vector3(-1, 1, 1));
    const Model other = transformed(model, mirror);
    const Cutter cutter(model, tolerance), mirrored(other, tolerance);
    const HeightRange range = cutter.height_range();
    for (double share = 0.017; share < 1; share += 0.11) {
        CAPTURE(share);
        const double z = range.bottom_mm + share * (range.top_mm - range.bottom_mm);
        const Section a = cutter.cut(z), b = mirrored.cut(z);
        REQUIRE(loops_of(a) == loops_of(b));
        CHECK(worst_distance(model, a) <= tolerance.total_mm);
        CHECK(worst_distance(other, b) <= tolerance.total_mm);
        CHECK(std::abs(area_of(a) - area_of(b)) <= 2 * tolerance.total_mm * length_of(a));
        const auto moment = [](const Section& section) {
            // Twice the area's first moment about x = 0, by a polygon: enough to tell left from right.
            double sum = 0;
            for (const SolidSection& solid : section.solids) {
                for (const Contour& contour : solid.contours) {
                    const auto* path = std::get_if<Path>(&contour);
                    if (!path) continue;
                    Point2 from = path->start;
                    for (const Segment& segment : path->segments) {
                        Point2 last = from;
                        for (const double along : {0.25, 0.5, 0.75, 1.0}) {
                            const Point2 next = point_at(from, segment, along);
                            sum += cross(last, next) * (last.x() + next.x()) / 3;
                            last = next;
                        }
                        from = segment.end;
                    }
                }
            }
            return sum;
        };
        CHECK(std::abs(moment(a) + moment(b)) <= 0.05 * length_of(a) * length_of(a));
    }
}

}  // namespace

TEST_CASE("free-form: random lofts have their volume in every position") {
    test::Random random(21);
    for (int number = 0; number < 24; ++number) {
        CAPTURE(number);
        const Model upright = loft(random);
        const double volume_mm3 = signed_volume_mm3(upright, ShellId{0});
        REQUIRE(volume_mm3 > 0);
        const bool moved = number >= 4;
        check_sections(moved ? transformed(upright, random.similarity(false)) : upright,
                       volume_mm3);
    }
}

TEST_CASE("free-form: random bodies of revolution have their volume in every position") {
    test::Random random(22);
    for (int number = 0; number < 24; ++number) {
        CAPTURE(number);
        const BSplineCurve c = profile(random);
        Builder b;
        b.face(std::make_shared<const BSplineSurface>(revolved(c, Frame{})), true, {});
        const Model upright = b.finish();
        const bool moved = number >= 4;
        check_sections(moved ? transformed(upright, random.similarity(false)) : upright,
                       volume_of_revolution(c));
    }
}

// Found by this test: where a span ended in a corner, its tangent there could be that of the corner's other side.
TEST_CASE("free-form: contours in a mirror are the mirrored ones, both within the tolerance") {
    test::Random random(23);
    for (int number = 0; number < 4; ++number) {
        CAPTURE(number);
        check_mirrored(transformed(loft(random), random.similarity(false)));
        const BezierVolume volume(2 + number % 3, 20, 0.35, number % 2 == 1,
                                  static_cast<unsigned>(number));
        check_mirrored(transformed(bent_cube(volume), random.similarity(false)));
    }
}
