// Walking over the arguments of a record.
//
// Contract
//  1. check_record() takes any text and says where it is not a well-formed list of arguments.
//  2. The other functions take text that check_record() has accepted.

#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "parser/part21/value.h"

namespace lyr::part21 {

struct RecordCheck {
    std::uint64_t count = 0;        // of arguments
    const char* closing = nullptr;  // the closing bracket
    // Where it is malformed, and what was expected there.
    const char* fault = nullptr;
    std::string expected;
};
// `open`: the opening bracket. The places of the first arguments go to `places`, from `open`.
RecordCheck check_record(const char* open, const char* end, std::span<std::uint32_t> places);

Kind kind_at(const char* p, const char* end);
const char* skip_value(const char* p, const char* end);
// From a value to the next of its list, or nullptr behind the last.
const char* next_value(const char* p, const char* end);
// The first value behind an opening bracket, or nullptr in ().
const char* first_value(const char* open, const char* end);

}  // namespace lyr::part21
