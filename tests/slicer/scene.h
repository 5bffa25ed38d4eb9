// What tests of the slicer begin with: models put somewhere, files of parts, a place for prints, and a layer.

#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include "kernel/brep/placement.h"
#include "scratch.h"
#include "slicer/outline.h"

namespace lyr::testing {

inline const std::string parts = std::string(LYR_FIXTURES) + "/parts/";

using tests::scratch;

inline std::string bytes_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

inline Model at(Model model, double x, double y, double z = 0) {
    return transformed(std::move(model), Eigen::Affine3d(Eigen::Translation3d(x, y, z)));
}

inline Model turned(Model model, double angle_rad, const Vector3& axis) {
    return transformed(std::move(model),
                       Eigen::Affine3d(Eigen::AngleAxisd(angle_rad, axis.normalized())));
}

inline constexpr slicer::LayerSpan span{0.2, 0.4};

}  // namespace lyr::testing
