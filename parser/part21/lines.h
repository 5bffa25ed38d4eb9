// From a byte offset to line and column, at need: an index of the text is made at the first
// question.

#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "base/lazy.h"

namespace lyr::part21 {

struct LineColumn {
    std::uint32_t line = 1;    // from 1; lines end with LF, CR LF or CR
    std::uint32_t column = 1;  // bytes, from 1
};

class Lines {
public:
    LineColumn locate(std::string_view text, std::size_t offset) const;

private:
    struct Mark {  // at a multiple of `block`
        std::uint32_t line;
        std::size_t line_start;
    };
    static constexpr std::size_t block = 1 << 12;

    static std::vector<Mark> marks_of(std::string_view text);

    Lazy<std::vector<Mark>> marks_;
};

}  // namespace lyr::part21
