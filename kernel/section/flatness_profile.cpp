// Parts are painted in falling order of flatness over the heights between their ends, each height once: where one has
// painted, a link leads past it.

#include <algorithm>
#include <numeric>
#include <utility>

#include "kernel/geometry/tolerance.h"
#include "kernel/section/flatness.h"

namespace lyr {
namespace {

// The first step not painted yet, from `step` on.
std::size_t unpainted(std::vector<std::size_t>& next, std::size_t step) {
    std::size_t last = step;
    while (next[last] != last) last = next[last];
    while (next[step] != last) step = std::exchange(next[step], last);
    return last;
}

}  // namespace

FlatnessProfile::FlatnessProfile(std::vector<FlatPart> parts) {
    for (const FlatPart& part : parts)
        borders_.insert(borders_.end(), {part.bottom_mm, part.top_mm});
    std::sort(borders_.begin(), borders_.end());
    borders_.erase(std::unique(borders_.begin(), borders_.end()), borders_.end());
    if (borders_.empty()) return;
    flatness_.assign(borders_.size() - 1, 0);
    std::sort(parts.begin(), parts.end(),
              [](const FlatPart& a, const FlatPart& b) { return a.flatness > b.flatness; });
    std::vector<std::size_t> next(borders_.size());
    std::iota(next.begin(), next.end(), std::size_t{0});
    const auto index = [&](double z_mm) {
        return static_cast<std::size_t>(std::lower_bound(borders_.begin(), borders_.end(), z_mm) -
                                        borders_.begin());
    };
    for (const FlatPart& part : parts) {
        const std::size_t end = index(part.top_mm);
        for (std::size_t i = unpainted(next, index(part.bottom_mm)); i < end;
             i = unpainted(next, i)) {
            flatness_[i] = part.flatness;
            next[i] = i + 1;
        }
    }
}

// The step that holds the heights right above z; those below all steps are in the first, empty or not.
std::size_t FlatnessProfile::step_at(double z_mm) const {
    const auto above = std::upper_bound(borders_.begin(), borders_.end(), z_mm + resolution_mm);
    return static_cast<std::size_t>(above - borders_.begin()) - (above == borders_.begin() ? 0 : 1);
}

double FlatnessProfile::between(double bottom_mm, double top_mm) const {
    double greatest = 0;
    for (std::size_t i = step_at(bottom_mm);
         i < flatness_.size() && borders_[i] < top_mm - resolution_mm; ++i) {
        greatest = std::max(greatest, flatness_[i]);
    }
    return greatest;
}

double FlatnessProfile::reach(double bottom_mm, double limit_mm, double depth_mm) const {
    double top = limit_mm;
    for (std::size_t i = step_at(bottom_mm); i < flatness_.size() && borders_[i] < top; ++i) {
        const double allowed = depth_mm / flatness_[i];
        if (flatness_[i] > 0) top = std::min(top, std::max(bottom_mm + allowed, borders_[i]));
    }
    return top;
}

}  // namespace lyr
