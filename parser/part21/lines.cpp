// Marks every 4 KiB, so that a question costs one block however large the file is.

#include "parser/part21/lines.h"

#include <algorithm>
#include <limits>

namespace lyr::part21 {
namespace {

bool ends_line(std::string_view text, std::size_t i) {
    return text[i] == '\n' || (text[i] == '\r' && (i + 1 == text.size() || text[i + 1] != '\n'));
}

// Line feeds, and carriage returns that stand alone.
std::size_t ends_between(std::string_view text, std::size_t first, std::size_t last) {
    const std::string_view part = text.substr(first, last - first);
    auto ends = static_cast<std::size_t>(std::count(part.begin(), part.end(), '\n'));
    for (std::size_t i = part.find('\r'); i != part.npos; i = part.find('\r', i + 1))
        ends += ends_line(text, first + i) ? 1 : 0;
    return ends;
}

std::uint32_t clamp(std::size_t number) {
    return static_cast<std::uint32_t>(
        std::min<std::size_t>(number, std::numeric_limits<std::uint32_t>::max()));
}

}  // namespace

std::vector<Lines::Mark> Lines::marks_of(std::string_view text) {
    std::vector<Mark> marks;
    Mark mark{1, 0};
    for (std::size_t first = 0; first < text.size(); first += block) {
        marks.push_back(mark);
        const std::size_t last = std::min(first + block, text.size());
        const std::size_t ends = ends_between(text, first, last);
        if (ends == 0) continue;
        std::size_t start = last;
        while (!ends_line(text, start - 1)) --start;
        mark = {clamp(std::size_t{mark.line} + ends), start};
    }
    marks.push_back(mark);
    return marks;
}

LineColumn Lines::locate(std::string_view text, std::size_t offset) const {
    const std::vector<Mark>& marks = marks_.get([&] { return marks_of(text); });
    offset = std::min(offset, text.size());
    Mark mark = marks[std::min(offset / block, marks.size() - 1)];
    for (std::size_t i = offset / block * block; i < offset; ++i) {
        if (ends_line(text, i)) mark = {clamp(std::size_t{mark.line} + 1), i + 1};
    }
    return {mark.line, clamp(offset - mark.line_start + 1)};
}

}  // namespace lyr::part21
