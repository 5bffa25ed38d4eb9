// Heights are what the kernel knows exactly; so each axis is turned up in its turn.

#include "slicer/bounds.h"

#include "kernel/brep/placement.h"
#include "kernel/section/cutter.h"
#include "slicer/layers.h"

namespace lyr::slicer {

Eigen::AlignedBox3d bounding_box(const Model& model, const Tolerance& tolerance, unsigned threads) {
    Eigen::AlignedBox3d box;
    in_order(
        3, threads,
        [&](std::size_t axis) {
            const auto number = static_cast<Eigen::Index>(axis);
            const Model turned = transformed(model, turned_up(Vector3::Unit(number)));
            return Cutter(turned, tolerance).height_range();
        },
        [&](std::size_t axis, const HeightRange& range) {
            box.min()[static_cast<Eigen::Index>(axis)] = range.bottom_mm;
            box.max()[static_cast<Eigen::Index>(axis)] = range.top_mm;
            return true;
        });
    return box;
}

}  // namespace lyr::slicer
