// Optimal string alignment distance, three rows of the table at a time.

#include "base/nearest_name.h"

#include <algorithm>
#include <vector>

namespace lyr {
namespace {

// Longer names are not worth the quadratic time; no known one comes near.
constexpr std::size_t longest_name = 128;

std::size_t edits(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) above[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            row[j] = std::min({above[j] + 1, row[j - 1] + 1, replaced});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
        before.swap(above);
        above.swap(row);
    }
    return above[b.size()];
}

}  // namespace

std::string nearest_name(std::string_view name, std::span<const std::string> known) {
    if (name.size() > longest_name) return {};
    std::size_t fewest = std::max<std::size_t>(2, name.size() / 3) + 1;
    std::string nearest;
    for (const std::string& candidate : known) {
        const std::size_t count = edits(name, candidate);
        if (count >= fewest || count >= candidate.size()) continue;
        fewest = count;
        nearest = candidate;
    }
    return nearest;
}

}  // namespace lyr
