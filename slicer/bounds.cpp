// Heights are what the kernel knows exactly; so each axis is turned up in its turn.

#include "slicer/bounds.h"

#include "kernel/brep/placement.h"
#include "kernel/section/cutter.h"

namespace lyr::slicer {

Eigen::AlignedBox3d bounding_box(const Model& model, const Tolerance& tolerance) {
    Eigen::AlignedBox3d box;
    for (int axis = 0; axis < 3; ++axis) {
        const Model turned = transformed(model, turned_up(Vector3::Unit(axis)));
        const HeightRange range = Cutter(turned, tolerance).height_range();
        box.min()[axis] = range.bottom_mm;
        box.max()[axis] = range.top_mm;
    }
    return box;
}

}  // namespace lyr::slicer
