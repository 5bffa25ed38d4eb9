// From z a layer reaches up to R(z), and R rises with z: a part of a layer has steps no deeper than the whole. So k
// layers reach every height from k times the thinnest up to R applied k times, and nothing else. The fewest layers are
// the first that reach far enough, and from the end back each layer begins where they reach, or the thinnest below the
// next one's beginning, whichever is lower.

#include "slicer/layer_sequence.h"

#include <algorithm>
#include <cmath>

#include "kernel/geometry/tolerance.h"

namespace lyr::slicer {
namespace {

// Halvings of a factor between 0 and 1: after so many, thicknesses differ by less than resolution_mm.
constexpr int halvings = 30;

class Reaching {
public:
    Reaching(double from_mm, double to_mm, const FlatnessProfile& flatness,
             const StepLimits& limits)
        : from_mm_(from_mm), to_mm_(to_mm), flatness_(flatness), limits_(limits) {}

    // How far each of `count` layers reaches, with the thinnest `least_mm` and others `share` of what they might be.
    std::vector<double> tops(std::size_t count, double least_mm, double share) const {
        std::vector<double> result;
        double z = from_mm_;
        for (std::size_t i = 0; i < count; ++i) {
            const double reach =
                flatness_.reach(z, z + limits_.thickness.most_mm, limits_.depth_mm);
            z += std::max(least_mm, share * (reach - z));
            result.push_back(z);
        }
        return result;
    }

    std::size_t fewest() const {
        double z = from_mm_;
        std::size_t count = 0;
        for (; z < to_mm_ - resolution_mm; ++count) {
            z = std::max(z + limits_.thickness.least_mm,
                         flatness_.reach(z, z + limits_.thickness.most_mm, limits_.depth_mm));
        }
        return count;
    }

    bool arrives(std::size_t count, double least_mm, double share) const {
        return tops(count, least_mm, share).back() >= to_mm_ - resolution_mm;
    }

private:
    double from_mm_, to_mm_;
    const FlatnessProfile& flatness_;
    const StepLimits& limits_;
};

// The least number between two for which a condition holds that holds for all greater ones, and for `high`.
template <class Condition>
double least_that(double low, double high, Condition holds) {
    if (holds(low)) return low;
    for (int i = 0; i < halvings; ++i) {
        const double middle = (low + high) / 2;
        (holds(middle) ? high : low) = middle;
    }
    return high;
}

}  // namespace

std::vector<double> layer_tops(double from_mm, double to_mm, const FlatnessProfile& flatness,
                               const StepLimits& limits) {
    const double height = to_mm - from_mm;
    const Reaching reaching(from_mm, to_mm, flatness, limits);
    double least_mm = limits.thickness.least_mm, share = 1;
    std::size_t count = reaching.fewest();
    // No number of them may fit; as thick as their mean they always do.
    const auto most = static_cast<std::size_t>(std::floor((height + resolution_mm) / least_mm));
    if (count > most) {
        count = std::max<std::size_t>(most, 1);
        least_mm = least_that(least_mm, height / static_cast<double>(count),
                              [&](double least) { return reaching.arrives(count, least, 1); });
    } else {
        share =
            least_that(0, 1, [&](double part) { return reaching.arrives(count, least_mm, part); });
    }
    std::vector<double> tops = reaching.tops(count, least_mm, share);
    tops.back() = to_mm;
    for (std::size_t i = tops.size() - 1; i > 0; --i)
        tops[i - 1] = std::min(tops[i - 1], tops[i] - least_mm);
    return tops;
}

}  // namespace lyr::slicer
