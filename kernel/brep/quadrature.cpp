// Knots are taken in groups if there are too many, their spans in parts if too few.

#include "kernel/brep/quadrature.h"

#include <algorithm>
#include <cstddef>

namespace lyr {

std::vector<double> panel_borders(const std::vector<double>& knots, double from, double to,
                                  const Fineness& fineness) {
    std::vector<double> spans{from};
    for (const double knot : knots) {
        if (knot > spans.back() && knot < to) spans.push_back(knot);
    }
    spans.push_back(to);
    const auto count = static_cast<int>(spans.size()) - 1;
    const int every = (count + fineness.most - 1) / fineness.most;
    const int parts = (fineness.fewest + count - 1) / count;
    std::vector<double> borders;
    for (std::size_t i = 0; i + 1 < spans.size(); i += static_cast<std::size_t>(every)) {
        const double next = spans[std::min(i + static_cast<std::size_t>(every), spans.size() - 1)];
        for (int k = 0; k < parts; ++k) {
            borders.push_back(spans[i] + (next - spans[i]) * k / parts);
        }
    }
    borders.push_back(to);
    return borders;
}

}  // namespace lyr
