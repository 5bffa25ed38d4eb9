#include "bench/table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace lyr::bench {
namespace {

using Row = std::vector<std::string>;

void print_row(const Row& row, const std::vector<std::size_t>& widths) {
    std::string line = "|";
    for (std::size_t c = 0; c < row.size(); ++c) {
        const std::string space(widths[c] - row[c].size(), ' ');
        line += c == 0 ? " " + row[c] + space + " |" : " " + space + row[c] + " |";
    }
    std::printf("%s\n", line.c_str());
}

}  // namespace

void print(const Table& table) {
    std::vector<std::size_t> widths;
    for (std::size_t c = 0; c < table.header.size(); ++c) {
        widths.push_back(table.header[c].size());
        for (const Row& row : table.rows) widths[c] = std::max(widths[c], row[c].size());
    }
    std::printf("\n%s\n\n", table.title.c_str());
    print_row(table.header, widths);
    std::string rule = "|";
    for (std::size_t c = 0; c < widths.size(); ++c) {
        rule += std::string(widths[c] + (c == 0 ? 2 : 1), '-') + (c == 0 ? "|" : ":|");
    }
    std::printf("%s\n", rule.c_str());
    for (const Row& row : table.rows) print_row(row, widths);
    std::fflush(stdout);
}

std::string number(double value) {
    if (!std::isfinite(value)) return "-";
    constexpr int significant = 3;
    const int before_point =
        value == 0 ? 1 : static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", std::max(0, significant - before_point), value);
    return text;
}

std::string duration(double seconds) {
    if (seconds < 1e-6) return number(seconds * 1e9) + " ns";
    if (seconds < 1e-3) return number(seconds * 1e6) + " us";
    if (seconds < 1) return number(seconds * 1e3) + " ms";
    return number(seconds) + " s";
}

bool Requirement::met() const {
    // What came out of no time, or of none at all, proves nothing.
    if (!std::isfinite(measured)) return false;
    return at_most ? measured <= wanted : measured >= wanted;
}

bool print(const Requirements& requirements) {
    Table table{"Requirements", {"what", "measured", "required", ""}, {}};
    bool all = true;
    for (const Requirement& r : requirements) {
        const std::string wanted = (r.at_most ? "at most " : "at least ") + number(r.wanted);
        table.rows.push_back(
            {r.what, number(r.measured) + r.unit, wanted + r.unit, r.met() ? "met" : "MISSED"});
        all = all && r.met();
    }
    print(table);
    return all;
}

}  // namespace lyr::bench
