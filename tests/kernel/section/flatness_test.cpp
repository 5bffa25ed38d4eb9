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
constexpr Tolerance exact{1e-5};

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
        for (const double share : {0.1, 0.6}) points.push_back(point_at(from, segment, share));
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

struct Solid {
    std::string name;
    Model model;
    int heights;
};

std::vector<Solid> solids() {
    std::vector<Solid> all;
    all.push_back({"box", box(10, 20, 30), 12});
    all.push_back({"drilled box", drilled_box(20, 20, 10, 4), 12});
    all.push_back({"frustum", frustum(8, 3, 12, Side::halves), 12});
    all.push_back({"frustum of two loops", frustum(3, 8, 12, Side::two_loops), 12});
    all.push_back({"cylinder", frustum(5, 5, 12, Side::seam), 12});
    all.push_back({"cone", cone_with_apex(5, 8, true), 12});
    all.push_back({"cone without seam", cone_with_apex(5, 8, false), 12});
    all.push_back({"half round", half_round(6, 15), 12});
    all.push_back({"sphere", sphere(7, true), 12});
    all.push_back({"cut ball", cut_ball(7, 3), 12});
    all.push_back({"torus", torus(9, 3, true), 8});
    all.push_back({"halved torus", halved_torus(9, 3), 8});
    all.push_back({"spindle dome", spindle_dome(3, 5, 7, false), 8});
    all.push_back({"hexagon under cone", hexagon_under_cone(10, 7, 12), 12});
    all.push_back({"bent cube", bent_cube(BezierVolume(3, 12, 0.3, false, 5)), 2});
    all.push_back({"rational bent cube", bent_cube(BezierVolume(2, 12, 0.3, true, 7)), 2});
    return all;
}

std::vector<Eigen::Affine3d> placements() {
    const auto turned = [](double angle, const Vector3& axis) {
        return Eigen::Affine3d(Eigen::AngleAxisd(angle, axis.normalized()));
    };
    Eigen::Affine3d mirrored = turned(0.7, {1, -2, 0.4});
    mirrored.linear().col(0) *= -1;
    return {Eigen::Affine3d::Identity(), turned(pi / 2, Vector3::UnitX()),
            turned(0.4, Vector3::UnitY()), turned(1.1, {1, 2, 0.3}), mirrored};
}

// Calls check(model, cutter, profile, z) at some heights of every solid in every placement.
template <class Check>
void at_all_heights(Check check) {
    for (const Solid& solid : solids()) {
        CAPTURE(solid.name);
        int number = 0;
        for (const Eigen::Affine3d& placement : placements()) {
            CAPTURE(number);
            ++number;
            const Model model = transformed(solid.model, placement);
            const Cutter cutter(model, exact);
            const FlatnessProfile profile = profile_of(model);
            const HeightRange range = cutter.height_range();
            for (int i = 0; i < solid.heights; ++i) {
                const double share = (i + 0.37) / solid.heights;
                const double z = range.bottom_mm + share * (range.top_mm - range.bottom_mm);
                CAPTURE(z);
                check(model, cutter, profile, z);
            }
        }
    }
}

}  // namespace

TEST_CASE("flatness 1: no point of a face is flatter than the profile at its height") {
    std::size_t checked = 0;
    at_all_heights([&](const Model& model, const Cutter& cutter, const FlatnessProfile& profile,
                       double z) {
        for (const Sample& sample : samples_at(model, cutter, z)) {
            ++checked;
            CHECK(sample.flatness <= std::max(at_height(profile, sample.z_mm), fine.least) + 1e-9);
        }
    });
    CHECK(checked > 10'000);
}

TEST_CASE("flatness 2: the profile is no flatter than some point nearby, but for the slack") {
    // Points of a section miss its flattest one by less than this.
    constexpr double missed = 0.02;
    at_all_heights(
        [&](const Model& model, const Cutter& cutter, const FlatnessProfile& profile, double z) {
            const double bound = at_height(profile, z);
            if (bound <= fine.least) return;
            double there = 0;
            for (int i = -2; i <= 2; ++i) {
                const double near = z + i * fine.height_mm / 2;
                there = std::max(there, flattest(samples_at(model, cutter, near)));
            }
            CHECK(bound <= (1 + flatness_slack) * there + missed);
        });
}
