// Keywords as small numbers: each spelling that occurs in the file is met once by a hash of its
// bytes, and spellings that differ in case only share a number.

#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "parser/part21/value.h"

namespace lyr::part21 {

class Keywords {
public:
    Keywords();

    // `spelling` must stay where it is: it is a piece of the file's text.
    KeywordId intern(std::string_view spelling);
    // Not valid() for a keyword that has not been met.
    KeywordId find(std::string_view upper_case) const;
    std::size_t count() const { return texts_.size(); }
    std::string_view text(KeywordId keyword) const { return texts_[keyword.value]; }

private:
    struct Slot {
        std::string_view spelling;  // empty: free
        KeywordId keyword;
    };

    std::size_t slot_of(std::string_view spelling) const;
    void insert(std::string_view spelling, KeywordId keyword);
    void grow();

    std::vector<Slot> slots_;  // open addressing, a power of two, at most half full
    std::size_t used_ = 0;
    std::deque<std::string> texts_;  // upper case; a deque does not move its strings
};

}  // namespace lyr::part21
