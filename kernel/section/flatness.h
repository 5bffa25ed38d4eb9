// How flat the faces of a model lie, height by height: what the depth of the steps between layers follows from.
//
// The flatness of a surface at a point is |n_z| of its unit normal: 0 on an upright wall, 1 where it is level. A layer of
// thickness h leaves steps of depth h |n_z|, measured along the normal (docs/algorithms/adaptive.md).
//
// Contract
//  1. Of every point of a face, but for those of contract 3, the parts have one that spans its height and is no less
//     flat, or the point's flatness is at most FlatnessLimits::least. A face that bulges out of its loops by less than
//     FlatnessLimits::height_mm in height may have none for the bulge.
//  2. Parts are no flatter than the face by more than flatness_slack of it and reach no farther than
//     FlatnessLimits::height_mm; so planes, spheres, and cylinders, cones and tori whose axis is upright or level. Those
//     whose axis leans and free-form faces are, where their curvature radius is more than that height.
//     What is flatter than FlatnessLimits::most is said to be level.
//  3. A flat face that rises by less than level_rise_mm has no parts: if it is level itself, it has a level instead, on
//     which a layer can end; else it is too low for any layer to show it.
//  4. The result depends on the face, the limits and nothing else. of() may run on several threads.
//
// Method: planes, spheres, upright and level axes in closed form by the height alone. Leaning cylinders, cones and tori by
// cells of their parameters with intervals of the closed forms; free-form faces by Bezier patches and the
// Bernstein coefficients of their normals. Cells that no loop of the face crosses are in it or out of it as a whole.

#pragma once

#include <optional>
#include <vector>

#include "kernel/brep/model.h"
#include "kernel/brep/monotone.h"
#include "kernel/section/face_heights.h"

namespace lyr {

// A thousandth of the layers that printers make, and the coarsest quantum of a .lyr file.
inline constexpr double level_rise_mm = 1e-3;

// Of a bound, as a share of what it bounds. Half of it costs twice as many cells along each parameter and makes layers
// 1 % thicker.
inline constexpr double flatness_slack = 1.0 / 12;

struct FlatnessLimits {
    double least = 0, most = 1;  // what lies beyond need not be told apart
    double height_mm;            // by how much a part may reach out of its face
};

struct FlatPart {
    double bottom_mm, top_mm, flatness;
};

struct FaceFlatness {
    std::vector<FlatPart> parts{};
    std::optional<double> level_mm{};
};

class FlatnessSurvey {
public:
    // Keeps a reference to the model.
    FlatnessSurvey(const Model& model, const FlatnessLimits& limits);

    FaceFlatness of(FaceId face) const;

private:
    HeightRange whole_heights(FaceId face) const;

    const Model& model_;
    FlatnessLimits limits_;
    MonotoneEdges edges_;
    std::vector<HeightRange> loops_;  // by face
};

// Of many parts the flattest at each height.
class FlatnessProfile {
public:
    explicit FlatnessProfile(std::vector<FlatPart> parts);

    // The greatest flatness strictly between two heights; 0 where there is no part.
    double between(double bottom_mm, double top_mm) const;

    // The greatest height so that (height - bottom) x between(bottom, height) <= depth_mm, at most `limit_mm`.
    double reach(double bottom_mm, double limit_mm, double depth_mm) const;

private:
    std::size_t step_at(double z_mm) const;

    // From borders_[i] to borders_[i + 1] it is flatness_[i].
    std::vector<double> borders_, flatness_;
};

}  // namespace lyr
