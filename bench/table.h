// Figures as text: tables in Markdown, aligned so that a terminal shows them well too.

#pragma once

#include <string>
#include <vector>

namespace lyr::bench {

struct Table {
    std::string title;
    std::vector<std::string> header;
    std::vector<std::vector<std::string>> rows;  // as long as the header
};

// To standard output, at once. The first column is aligned to the left, the others to the right.
void print(const Table& table);

// Three significant digits, never with an exponent: "1230", "12.3", "0.00123".
std::string number(double value);

// With the unit that suits it: "12.3 ns", "1.23 us", "123 ms", "12.3 s".
std::string duration(double seconds);

// What was required and what came out.
struct Requirement {
    std::string what;
    double measured, wanted;
    bool at_most = false;  // else at least
    std::string unit{};

    bool met() const;
};

using Requirements = std::vector<Requirement>;

// True if all are met.
bool print(const Requirements& requirements);

}  // namespace lyr::bench
