// What cutting one free-form face asks of its model alone, made when the first plane meets it.
//
// Contract
//  1. Made once, whichever thread asks first; the result does not depend on which.
//  2. hull() is known without making anything: the face's heights lie within.

#pragma once

#include "base/lazy.h"
#include "kernel/brep/model.h"
#include "kernel/section/containment.h"
#include "kernel/section/face_heights.h"
#include "kernel/section/height_mesh.h"

namespace lyr {

class FreeformFace {
public:
    // Keeps references. `loops`: the heights of the face's edges.
    FreeformFace(const Model& model, FaceId face, const std::vector<double>& vertex_level_mm,
                 HeightRange loops);

    HeightRange hull() const { return hull_; }
    const HeightMesh& mesh() const;
    const Containment& containment() const;

    // The heights of the face: those of its edges and of the highest and lowest points inside.
    HeightRange heights() const;

    // A range, and what of the face is beyond it: found faster than all of its heights.
    HeightRange extended(HeightRange range) const;

private:
    HeightRange extended(HeightRange range, const HeightMesh& mesh) const;

    const Model& model_;
    FaceId face_;
    const std::vector<double>& vertex_level_mm_;
    HeightRange loops_, hull_;
    Lazy<HeightMesh> mesh_;
    Lazy<Containment> containment_;
    Lazy<HeightRange> heights_;
};

}  // namespace lyr
