// Adaptive layers of whole parts: what each may be, where they end, and what must not matter.

#include "slicer/adaptive.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "kernel/brep/placement.h"
#include "kernel/freeform_solids.h"
#include "kernel/section/flatness.h"
#include "kernel/solids.h"
#include "slicer/scene.h"

using namespace lyr;
using namespace lyr::slicer;
using namespace lyr::testing;

namespace {

constexpr double sections_a_layer = 3;

// Of sections whose points are taken to the surface.
constexpr Tolerance close{1e-4};

Options options_of(double cusp_mm) {
    Options options;
    options.profile.layer.adaptive = true;
    options.profile.layer.cusp_mm = cusp_mm;
    return options;
}

struct Planned {
    Model model;
    double height_mm;
    LayerPlan plan;
    Diagnostics diagnostics;
};

Planned planned(const Model& model, const Options& options) {
    const HeightRange range = Cutter(model, {}).height_range();
    const Eigen::Affine3d down(Eigen::Translation3d(0, 0, -range.bottom_mm));
    Planned result{transformed(model, down), range.top_mm - range.bottom_mm, {}, {}};
    result.plan = adaptive_plan(result.model, result.height_mm, options, result.diagnostics);
    return result;
}

Model mirrored(const Model& model) {
    Eigen::Affine3d mirror = Eigen::Affine3d::Identity();
    mirror.linear()(0, 0) = -1;
    return transformed(model, mirror);
}

Model upside_down(const Model& model) {
    return turned(model, pi, Vector3::UnitX());
}

Model part(const std::string& file) {
    Diagnostics found;
    auto model = load(std::string(LYR_FIXTURES) + "/parts/" + file, {}, found);
    REQUIRE(model);
    return std::move(*model);
}

// Of points of the section's contours, on whichever face they are: the least of those that hold one.
double flattest_at(const Model& model, const Cutter& cutter, double z_mm) {
    double flattest = 0;
    for (const SolidSection& solid : cutter.cut(z_mm).solids) {
        for (const Contour& contour : solid.contours) {
            const auto* path = std::get_if<Path>(&contour);
            std::vector<Point2> points;
            if (!path) {
                const FullCircle& circle = std::get<FullCircle>(contour);
                points.push_back(circle.centre + Vector2(circle.radius_mm, 0));
            }
            for (std::size_t i = 0; path && i < path->segments.size(); ++i) {
                const Point2 from = i > 0 ? path->segments[i - 1].end : path->start;
                points.push_back(point_at(from, path->segments[i], 0.5));
            }
            for (const Point2& at : points) {
                double least = 2;
                const Point3 point(at.x(), at.y(), z_mm);
                for (const Face& face : model.faces) {
                    const Point2 uv = invert(face.surface, point);
                    if ((evaluate(face.surface, uv) - point).norm() > 10 * close.total_mm) continue;
                    least = std::min(least, std::abs(normal(face.surface, uv).z()));
                }
                if (least <= 1) flattest = std::max(flattest, least);
            }
        }
    }
    return flattest;
}

// Contracts 1 and 2, beside the faces themselves.
void check_layers(const Planned& planned, const Options& options) {
    const profile::Layer& layer = options.profile.layer;
    const Cutter cutter(planned.model, close);
    const auto& spans = planned.plan.spans;
    REQUIRE(!spans.empty());
    CHECK(spans.front().bottom_mm == 0);
    CHECK(spans.front().top_mm == layer.first_height_mm);
    CHECK(std::abs(spans.back().top_mm - planned.height_mm) <= level_rise_mm);
    double sum = 0;
    for (std::size_t i = 0; i < spans.size(); ++i) {
        sum += spans[i].height_mm();
        if (i == 0) continue;
        CAPTURE(i);
        CHECK(spans[i].bottom_mm == spans[i - 1].top_mm);
        const double thickness = spans[i].height_mm();
        CHECK(thickness >= layer.min_height_mm - 2 * resolution_mm);
        CHECK(thickness <= layer.max_height_mm + 2 * resolution_mm);
        if (thickness <= planned.plan.figures.thinnest_mm + 2 * resolution_mm) continue;
        for (double k = 0.5; k < sections_a_layer; ++k) {
            const double z = spans[i].bottom_mm + k / sections_a_layer * thickness;
            CAPTURE(z);
            CHECK(thickness * flattest_at(planned.model, cutter, z) <= layer.cusp_mm + 1e-5);
        }
    }
    CHECK(sum == doctest::Approx(planned.height_mm).epsilon(1e-9));
}

bool has_end_at(const LayerPlan& plan, double z_mm) {
    return std::any_of(plan.spans.begin(), plan.spans.end(), [&](const LayerSpan& span) {
        return std::abs(span.top_mm - z_mm) <= resolution_mm;
    });
}

// By how much the ends of layers differ; as many of them.
double difference(const LayerPlan& a, const LayerPlan& b) {
    REQUIRE(a.spans.size() == b.spans.size());
    double greatest = 0;
    for (std::size_t i = 0; i < a.spans.size(); ++i)
        greatest = std::max(greatest, std::abs(a.spans[i].top_mm - b.spans[i].top_mm));
    return greatest;
}

}  // namespace

TEST_CASE("adaptive 1, 2: no layer has deeper steps than it may on any face that it crosses") {
    const Options options = options_of(0.05);
    check_layers(planned(sphere(7, true), options), options);
    check_layers(planned(cone_with_apex(5, 8, true), options), options);
    check_layers(planned(turned(frustum(5, 5, 12, Side::seam), 0.4, {1, 0.3, 0}), options),
                 options);
    check_layers(planned(torus(9, 3, true), options), options);
    check_layers(planned(turned(torus(9, 3, true), 1, {1, 0.2, 0}), options), options);
    check_layers(planned(half_round(6, 15), options), options);
}

TEST_CASE("adaptive 1, 2: free-form solids as well") {
    const Options options = options_of(0.08);
    check_layers(planned(bent_cube(BezierVolume(3, 3, 0.2, false, 3)), options), options);
    check_layers(planned(bent_cube(BezierVolume(2, 3, 0.2, true, 3)), options), options);
}

TEST_CASE("adaptive 1, 2, 3: the gearbox base; layers end on all of its level faces") {
    const Options options = options_of(0.05);
    const Planned gearbox = planned(part("gearbox_base.step"), options);
    CHECK(gearbox.diagnostics.empty());
    CHECK(gearbox.plan.spans.size() < gearbox.plan.figures.uniform_layers);
    std::size_t levels = 0;
    for (const Face& face : gearbox.model.faces) {
        const auto* plane = std::get_if<Plane>(&face.surface);
        if (!plane || std::abs(plane->frame.z.z()) < 1 - 1e-12) continue;
        const double z = plane->frame.origin.z();
        CHECK((std::abs(z) <= resolution_mm || has_end_at(gearbox.plan, z)));
        ++levels;
    }
    CHECK(levels > 5);
    check_layers(gearbox, options);
}

TEST_CASE("adaptive: upright walls alone are printed as thick as may be") {
    const Options options = options_of(0.02);
    const Planned box20 = planned(box(5, 5, 20), options);
    CHECK(box20.plan.spans.size() == 1 + 66);
    CHECK(box20.plan.figures.deeper_layers == 0);
    for (std::size_t i = 1; i < box20.plan.spans.size(); ++i)
        CHECK(box20.plan.spans[i].height_mm() == doctest::Approx(0.3));
    check_layers(planned(frustum(5, 5, 10.07, Side::halves), options), options);
}

TEST_CASE("adaptive 3: level faces that no layer can end on are named") {
    const Options options = options_of(0.05);
    const Planned low = planned(box(5, 5, 0.15), options);
    CHECK(low.plan.spans.size() == 1);
    REQUIRE(low.diagnostics.size() == 1);
    CHECK(low.diagnostics[0].where.z_mm == 0.15);
    CHECK(low.diagnostics[0].where.entity > 0);
    const Planned little = planned(box(5, 5, 0.24), options);
    CHECK(little.plan.spans.size() == 1);
    CHECK(little.diagnostics.size() == 1);
    const Planned more = planned(box(5, 5, 0.27), options);
    CHECK(more.plan.spans.size() == 2);
    CHECK(more.plan.spans.back().height_mm() == doctest::Approx(0.1));
    CHECK(more.diagnostics.size() == 1);
    CHECK(planned(box(5, 5, 0.3), options).diagnostics.empty());
}

TEST_CASE("adaptive 4: turned about the vertical or mirrored, a part has the same layers") {
    const Options options = options_of(0.05);
    const auto same = [&](const Model& model, double off_mm) {
        const LayerPlan plan = planned(model, options).plan;
        CHECK(difference(plan, planned(mirrored(model), options).plan) <= off_mm);
        CHECK(difference(plan, planned(turned(model, 0.8, Vector3::UnitZ()), options).plan) <=
              off_mm);
    };
    same(sphere(7, true), 2 * resolution_mm);
    same(half_round(6, 15), 2 * resolution_mm);
    same(hexagon_under_cone(10, 7, 12), 2 * resolution_mm);
    // Cells of a leaning axis begin elsewhere.
    same(turned(torus(9, 3, true), 1, {1, 0.2, 0}), 0.02);
}

TEST_CASE("adaptive: upside down, a part whose first layer matters not has as many layers") {
    const Options options = options_of(0.05);
    for (const Model& model : {sphere(7, true), torus(9, 3, true)}) {
        CHECK(planned(model, options).plan.spans.size() ==
              planned(upside_down(model), options).plan.spans.size());
    }
    const LayerPlan domed = planned(half_round(6, 15), options).plan;
    CHECK(domed.spans.back().height_mm() == doctest::Approx(0.1).epsilon(0.05));
    CHECK(domed.spans[2].height_mm() > 0.25);
    const LayerPlan bowl = planned(upside_down(half_round(6, 15)), options).plan;
    CHECK(bowl.spans.back().height_mm() > 0.25);
    CHECK(bowl.spans[2].height_mm() == doctest::Approx(0.1).epsilon(0.05));
}

TEST_CASE("adaptive 4: any number of threads") {
    Options options = options_of(0.03);
    const Model model = part("transmission_pulley_at3_t10_center.step");
    std::vector<LayerPlan> plans;
    for (const unsigned threads : {1u, 2u, 5u}) {
        options.threads = threads;
        plans.push_back(planned(model, options).plan);
    }
    CHECK(difference(plans[0], plans[1]) == 0);
    CHECK(difference(plans[0], plans[2]) == 0);
}
