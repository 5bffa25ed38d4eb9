#include "slicer/cooling.h"

#include <algorithm>

namespace lyr::slicer {

double time_s(std::span<const Timed> pieces) {
    double sum_s = 0;
    for (const Timed& piece : pieces) sum_s += piece.length_mm / piece.speed_mm_s;
    return sum_s;
}

// With each factor more pieces are at their least, and the next factor is smaller: as often as there are pieces at most.
double slowing(std::span<const Timed> pieces, double least_time_s, double least_speed_mm_s) {
    double factor = 1;
    for (double next = time_s(pieces) / least_time_s; next < factor;) {
        factor = next;
        double fixed_s = 0, free_s = 0;
        for (const Timed& piece : pieces) {
            const double least = std::min(piece.speed_mm_s, least_speed_mm_s);
            if (piece.speed_mm_s * factor <= least) {
                fixed_s += piece.length_mm / least;
            } else {
                free_s += piece.length_mm / piece.speed_mm_s;
            }
        }
        if (free_s > 0) next = free_s / (least_time_s - fixed_s);
    }
    return factor;
}

}  // namespace lyr::slicer
