// The longest chain of heights that layers fit between, by dynamic programming. From a certain distance on any height
// can follow any other, so only the few that are nearer are tried one by one.

#include "slicer/landings.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/geometry/tolerance.h"

namespace lyr::slicer {
namespace {

// From this distance on, some number of layers fits whatever the distance.
double always_fits_mm(const Thickness& allowed) {
    const double play = allowed.most_mm - allowed.least_mm;
    if (!(play > 0)) return std::numeric_limits<double>::infinity();
    return allowed.least_mm * std::ceil(allowed.least_mm / play);
}

// As near to `height_mm` as a whole number of layers comes.
double nearest_end(double height_mm, const Thickness& allowed) {
    if (fewest_layers(height_mm, allowed) > 0) return height_mm;
    const double count = std::floor(height_mm / allowed.most_mm);
    const double lower = count * allowed.most_mm, upper = (count + 1) * allowed.least_mm;
    return height_mm - lower <= upper - height_mm ? lower : upper;
}

struct Link {
    std::size_t before = 0, landed = 0;
    bool is_reached = false;
};

// Of heights and the start before them, each with the best way to it.
std::vector<Link> best_links(std::span<const double> heights, const Thickness& allowed) {
    std::vector<Link> links(heights.size());
    links[0].is_reached = true;
    const double far_mm = always_fits_mm(allowed);
    std::size_t near = 0;  // the first one that is not far
    std::size_t best_far = heights.size();
    for (std::size_t i = 1; i < heights.size(); ++i) {
        const auto try_from = [&](std::size_t j) {
            const std::size_t landed = links[j].landed + 1;
            if (links[j].is_reached && landed > links[i].landed) links[i] = {j, landed, true};
        };
        for (; near < i && heights[i] - heights[near] >= far_mm; ++near) {
            if (links[near].is_reached &&
                (best_far == heights.size() || links[near].landed > links[best_far].landed))
                best_far = near;
        }
        if (best_far < heights.size()) try_from(best_far);
        for (std::size_t j = near; j < i; ++j)
            if (fewest_layers(heights[i] - heights[j], allowed) > 0) try_from(j);
    }
    return links;
}

}  // namespace

std::size_t fewest_layers(double height_mm, const Thickness& allowed) {
    const double count = std::ceil((height_mm - resolution_mm) / allowed.most_mm);
    const bool fits = count >= 1 && count * allowed.least_mm <= height_mm + resolution_mm;
    return fits ? static_cast<std::size_t>(count) : 0;
}

std::vector<double> landings(double start_mm, std::span<const double> heights_mm,
                             const Thickness& allowed) {
    const double end_mm = start_mm + nearest_end(heights_mm.back() - start_mm, allowed);
    if (!(end_mm > start_mm)) return {};
    std::vector<double> heights{start_mm};
    for (const double height : heights_mm)
        if (height < end_mm) heights.push_back(height);
    heights.push_back(end_mm);
    const std::vector<Link> links = best_links(heights, allowed);
    std::vector<double> result;
    for (std::size_t i = heights.size() - 1; i > 0; i = links[i].before)
        result.push_back(heights[i]);
    std::reverse(result.begin(), result.end());
    return result;
}

}  // namespace lyr::slicer
