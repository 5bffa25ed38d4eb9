// How much a layer is slowed down that would be printed too quickly to cool.
//
// Contract: all speeds are multiplied by one factor, so that the whole takes `least_time_s` without accelerations; those that
// would come under `least_speed_mm_s` stay there, or as they are if they are slower, and the others give way for them. 1 where
// it takes as long anyway; where even the least speeds are too quick, a factor that leads to these.

#pragma once

#include <span>

namespace lyr::slicer {

struct Timed {
    double length_mm, speed_mm_s;
};

double time_s(std::span<const Timed> pieces);

double slowing(std::span<const Timed> pieces, double least_time_s, double least_speed_mm_s);

}  // namespace lyr::slicer
