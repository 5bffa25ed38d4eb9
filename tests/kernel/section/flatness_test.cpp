// Flatness beside the normals of points that sections of the model give.

#include "kernel/section/flatness.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "kernel/brep/placement.h"
#include "kernel/freeform_solids.h"
#include "kernel/section/cutter.h"
#include "kernel/solids.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

constexpr FlatnessLimits fine{.least = 0.05, .most = 1, .height_mm = 0.02};

// Sections this exact lie on faces closer than anything here is asked.
constexpr Tolerance exact{1e-4};

// By this much, heights are off where they are compared.
constexpr double height_step_mm = 1e-5;

FlatnessProfile profile_of(const Model& model, const FlatnessLimits& limits = fine) {
    const FlatnessSurvey survey(model, limits);
    std::vector<FlatPart> parts;
    for (std::size_t f = 0; f < model.faces.size(); ++f) {
        const FaceFlatness face = survey.of(FaceId{f});
        parts.insert(parts.end(), face.parts.begin(), face.parts.end());
    }
    return FlatnessProfile(parts);
}

struct Sample {
    double z_mm, flatness;
};

// Points inside the segments of a section, on the faces that they lie on.
std::vector<Point2> points_inside(const Contour& contour) {
    std::vector<Point2> points;
    if (const auto* circle = std::get_if<FullCircle>(&contour)) {
        for (int i = 0; i < 16; ++i) {
            const double a = 0.1 + i * pi / 8;
            points.push_back(circle->centre +
                             circle->radius_mm * Vector2(std::cos(a), std::sin(a)));
        }
        return points;
    }
    Point2 from = std::get<Path>(contour).start;
    for (const Segment& segment : std::get<Path>(contour).segments) {
        points.push_back(point_at(from, segment, 0.5));
        from = segment.end;
    }
    return points;
}

// A point on the extension of another face too counts with the least of their flatness.
std::vector<Sample> samples_at(const Model& model, const Cutter& cutter, double z_mm) {
    std::vector<Sample> samples;
    for (const SolidSection& solid : cutter.cut(z_mm).solids) {
        for (const Contour& contour : solid.contours) {
            for (const Point2& at : points_inside(contour)) {
                Sample sample{z_mm, 2};
                const Point3 point(at.x(), at.y(), z_mm);
                for (const Face& face : model.faces) {
                    const Point2 uv = invert(face.surface, point);
                    const Point3 foot = evaluate(face.surface, uv);
                    if ((foot - point).norm() > 10 * exact.total_mm) continue;
                    const double flatness = std::abs(normal(face.surface, uv).z());
                    if (flatness < sample.flatness) sample = {foot.z(), flatness};
                }
                if (sample.flatness <= 1) samples.push_back(sample);
            }
        }
    }
    return samples;
}

double flattest(const std::vector<Sample>& samples) {
    double greatest = 0;
    for (const Sample& sample : samples) greatest = std::max(greatest, sample.flatness);
    return greatest;
}

double at_height(const FlatnessProfile& profile, double z) {
    return profile.between(z - height_step_mm, z + height_step_mm);
}

struct SurveyedSolid {
    std::string name;
    Model model;
    int heights = 6;
    std::size_t placements = 5;
    bool has_tip = false;  // a point where normals differ, and sections near it are short
};

// The same ball on a free-form surface, with a pole where its seam begins and one where it ends.
Model freeform_ball(double radius) {
    Model model = sphere(radius, true);
    Frame meridian;
    meridian.y = Vector3::UnitZ();
    meridian.z = -Vector3::UnitY();
    model.faces[0].surface = std::make_shared<const BSplineSurface>(
        revolved(rational(Circle{meridian, radius}, -pi / 2, pi / 2), Frame{}));
    return model;
}

// A ball's cap over z = -cut on a free-form surface: one loop, and the highest point inside.
Model freeform_cap(double radius, double cut) {
    Model model = cut_ball(radius, cut);
    model.faces[0].surface = freeform_ball(radius).faces[0].surface;
    return model;
}

// Half of a cone, cut along its axis: two edges end at the apex, where one parameter has no value.
Model half_cone(double radius, double height) {
    Builder b;
    const VertexId apex = b.vertex(0, 0, height), right = b.vertex(radius, 0, 0),
                   left = b.vertex(-radius, 0, 0);
    const EdgeId rim = b.edge(Circle{Frame{}, radius}, right, left);
    const EdgeId chord = b.line(left, right), up = b.line(left, apex), down = b.line(apex, right);
    b.face(Cone{Builder::looking({0, 0, height}, -Vector3::UnitZ()), 0, std::atan2(radius, height)},
           true, {{{rim}, {up}, {down}}});
    b.face(Plane{Builder::looking({0, 0, 0}, -Vector3::UnitZ())}, true,
           {{{rim, true}, {chord, true}}});
    b.face(Plane{Builder::looking({0, 0, 0}, -Vector3::UnitY())}, true,
           {{{chord}, {down, true}, {up, true}}});
    return b.finish();
}

Model freeform_half_cone(double radius, double height) {
    Model model = half_cone(radius, height);
    const Vector3 slope(-radius, 0, height);
    const Line side{{radius, 0, 0}, slope.normalized()};
    model.faces[0].surface =
        std::make_shared<const BSplineSurface>(revolved(rational(side, 0, slope.norm()), Frame{}));
    return model;
}

std::vector<SurveyedSolid> surveyed_solids() {
    std::vector<SurveyedSolid> all;
    all.push_back({"box", box(10, 20, 30)});
    all.push_back({"drilled box", drilled_box(20, 20, 10, 4)});
    all.push_back({"frustum", frustum(8, 3, 12, Side::halves)});
    all.push_back({"frustum of two loops", frustum(3, 8, 12, Side::two_loops)});
    all.push_back({"cylinder", frustum(5, 5, 12, Side::seam)});
    all.push_back({"cone", cone_with_apex(5, 8, true)});
    all.push_back({"cone without seam", cone_with_apex(5, 8, false)});
    all.push_back({"half cone", half_cone(5, 8)});
    all.push_back({"free-form half cone", freeform_half_cone(5, 8), 2, 2});
    all.push_back({"half round", half_round(6, 15)});
    all.push_back({"sphere", sphere(7, true)});
    all.push_back({"cut ball", cut_ball(7, 3)});
    all.push_back({"torus", torus(9, 3, true)});
    all.push_back({"halved torus", halved_torus(9, 3)});
    all.push_back({"spindle dome", spindle_dome(3, 5, 7, false), 6, 5, true});
    all.push_back({"hexagon under cone", hexagon_under_cone(10, 7, 12)});
    all.push_back({"free-form ball", freeform_ball(7), 1, 1});
    all.push_back({"free-form cap", freeform_cap(7, 3), 1, 1});
    all.push_back({"bent cube", bent_cube(BezierVolume(3, 12, 0.3, false, 5)), 1, 1});
    all.push_back({"rational bent cube", bent_cube(BezierVolume(2, 12, 0.3, true, 7)), 1, 1});
    return all;
}

std::vector<Eigen::Affine3d> placements() {
    const auto turned = [](double angle, const Vector3& axis) {
        return Eigen::Affine3d(Eigen::AngleAxisd(angle, axis.normalized()));
    };
    Eigen::Affine3d mirrored = turned(0.7, {1, -2, 0.4});
    mirrored.linear().col(0) *= -1;
    return {turned(1.1, {1, 2, 0.3}), mirrored, Eigen::Affine3d::Identity(),
            turned(pi / 2, Vector3::UnitX()), turned(0.4, Vector3::UnitY())};
}

// Calls check(solid, model, cutter, profile, z) at some heights of every solid in every placement.
template <class Check>
void at_all_heights(Check check) {
    for (const SurveyedSolid& solid : surveyed_solids()) {
        CAPTURE(solid.name);
        for (std::size_t number = 0; number < solid.placements; ++number) {
            CAPTURE(number);
            const Model model = transformed(solid.model, placements()[number]);
            const Cutter cutter(model, exact);
            const FlatnessProfile profile = profile_of(model);
            const HeightRange range = cutter.height_range();
            for (int i = 0; i < solid.heights; ++i) {
                const double share = (i + 0.37) / solid.heights;
                const double z = range.bottom_mm + share * (range.top_mm - range.bottom_mm);
                CAPTURE(z);
                check(solid, model, cutter, profile, z);
            }
        }
    }
}

}  // namespace

TEST_CASE("flatness 1: no point of a face is flatter than the profile at its height") {
    std::size_t checked = 0;
    at_all_heights([&](const SurveyedSolid&, const Model& model, const Cutter& cutter,
                       const FlatnessProfile& profile, double z) {
        for (const Sample& sample : samples_at(model, cutter, z)) {
            ++checked;
            CHECK(sample.flatness <= std::max(at_height(profile, sample.z_mm), fine.least) + 1e-9);
        }
    });
    CHECK(checked > 2'000);
}

TEST_CASE("flatness 2: the profile is no flatter than some point nearby, but for the slack") {
    // Points of a section miss its flattest one by less than this.
    constexpr double missed = 0.02;
    at_all_heights([&](const SurveyedSolid& solid, const Model& model, const Cutter& cutter,
                       const FlatnessProfile& profile, double z) {
        const double bound = at_height(profile, z);
        if (bound <= fine.least || solid.has_tip) return;
        double there = 0;
        for (int i = -2; i <= 2; ++i) {
            const double near = z + i * fine.height_mm / 2;
            there = std::max(there, flattest(samples_at(model, cutter, near)));
        }
        CHECK(bound <= (1 + flatness_slack) * there + missed);
    });
}

TEST_CASE(
    "flatness 2: spheres, level cylinders and upright cones and tori have that of their height") {
    const auto check = [](const Model& model, double z, double flatness) {
        const double bound = at_height(profile_of(model), z);
        CAPTURE(z);
        CHECK(bound >= flatness - 1e-6);
        CHECK(bound <= flatness * 1.01);
    };
    for (const double z : {-6.9, -3.0, 1.0, 4.0, 6.9}) check(sphere(7, false), z, std::abs(z) / 7);
    for (const double z : {-2.9, 1.5, 2.5}) check(torus(9, 3, true), z, std::abs(z) / 3);
    for (const double z : {0.5, 3.0, 5.9}) check(half_round(6, 15), z, z / 6);
    for (const double z : {-5.0, 0.0, 5.0}) check(frustum(8, 3, 12, Side::seam), z, 5.0 / 13);
    for (const double z : {-3.0, 3.9}) check(cone_with_apex(6, 8, false), z, 0.6);
    CHECK(profile_of(box(1, 2, 3)).between(-5, 5) == 0);
    CHECK(profile_of(frustum(5, 5, 12, Side::halves)).between(-8, 8) == 0);
}

TEST_CASE("flatness 1: a free-form dome is level at its top, over its loops, too") {
    for (const Model& model : {freeform_cap(7, -3), freeform_cap(7, 3), freeform_ball(7)}) {
        const FlatnessProfile profile = profile_of(model);
        CHECK(profile.between(6.999, 7) == 1);
        CHECK(profile.between(7.001, 8) == 0);
        for (const double z : {4.0, 5.0, 6.5, 6.9}) {
            CAPTURE(z);
            CHECK(at_height(profile, z) >= z / 7 - 1e-5);
            CHECK(at_height(profile, z) <= (1 + flatness_slack) * (z + fine.height_mm) / 7);
        }
    }
}

// Bounds that did not become closer as cells became smaller, and edges to an apex that seemed to cross every cell, took
// a million.
TEST_CASE("flatness: no face takes many cells, however its axis leans") {
    for (const SurveyedSolid& solid : surveyed_solids()) {
        CAPTURE(solid.name);
        for (std::size_t number = 0; number < solid.placements; ++number) {
            CAPTURE(number);
            const Model model = transformed(solid.model, placements()[number]);
            const FlatnessSurvey survey(model, {.least = 0.2, .most = 0.6, .height_mm = 0.01});
            for (std::size_t f = 0; f < model.faces.size(); ++f)
                CHECK(survey.of(FaceId{f}).parts.size() < 20'000);
        }
    }
}

TEST_CASE("flatness 3: level faces have a height and no parts") {
    const Model model = frustum(8, 3, 12, Side::seam);
    const FlatnessSurvey survey(model, fine);
    std::vector<double> levels;
    for (std::size_t f = 0; f < model.faces.size(); ++f) {
        const FaceFlatness face = survey.of(FaceId{f});
        if (!face.level_mm) continue;
        levels.push_back(*face.level_mm);
        CHECK(face.parts.empty());
    }
    CHECK(levels == std::vector<double>{-6, 6});
    // Off level by what shows, they are faces like any other.
    const Model tilted =
        transformed(box(10, 10, 10), Eigen::Affine3d(Eigen::AngleAxisd(0.001, Vector3::UnitX())));
    const FlatnessSurvey of_tilted(tilted, fine);
    for (std::size_t f = 0; f < tilted.faces.size(); ++f) CHECK(!of_tilted.of(FaceId{f}).level_mm);
    CHECK(at_height(profile_of(tilted), 5) > 0.99);
    CHECK(at_height(profile_of(tilted), 4.9) == 0);
}

TEST_CASE("flatness 1: a fillet that ends level under a step does not reach over the step") {
    const FlatnessProfile profile = profile_of(half_round(6, 15));
    CHECK(profile.between(5.9, 6) == 1);
    CHECK(profile.between(6, 9) == 0);
    CHECK(profile.between(-9, 0) == 0);
}

TEST_CASE("flatness: of many parts the profile has the flattest at each height") {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> height(0, 100), flatness(0.1, 1);
    std::vector<FlatPart> parts;
    for (int i = 0; i < 60; ++i) {
        const auto [bottom, top] = std::minmax({height(random), height(random)});
        parts.push_back({bottom, bottom + (top - bottom) / 8, flatness(random)});
    }
    const FlatnessProfile profile(parts);
    for (int i = 0; i < 2000; ++i) {
        const auto [bottom, top] = std::minmax({height(random), height(random)});
        double expected = 0;
        for (const FlatPart& part : parts)
            if (part.bottom_mm < top && part.top_mm > bottom)
                expected = std::max(expected, part.flatness);
        CHECK(profile.between(bottom, top) == expected);
    }
    CHECK(FlatnessProfile({}).between(0, 1) == 0);
    CHECK(FlatnessProfile({}).reach(2, 5, 0.1) == 5);
}

TEST_CASE("flatness: a layer reaches as high as the depth of its steps allows, and no higher") {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> height(0, 20), flatness(0.1, 1);
    std::vector<FlatPart> parts;
    for (int i = 0; i < 40; ++i) {
        const double bottom = height(random);
        parts.push_back({bottom, bottom + 0.5, flatness(random)});
    }
    const FlatnessProfile profile(parts);
    constexpr double depth_mm = 0.1, most_mm = 0.6;
    double before = -1;
    for (double z = -1; z < 22; z += 0.01) {
        const double top = profile.reach(z, z + most_mm, depth_mm);
        CAPTURE(z);
        CHECK(top > z);
        CHECK(top <= z + most_mm);
        CHECK((top - z) * profile.between(z, top) <= depth_mm + 1e-6);
        CHECK(top >= before - 1e-6);
        before = top;
        if (top == z + most_mm) continue;
        const double higher = top + 1e-5;
        CHECK((higher - z) * profile.between(z, higher) > depth_mm);
    }
}
