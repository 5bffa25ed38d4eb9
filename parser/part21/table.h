// What a File owns, and what Values look into: the text and the arrays that index it.
//
// Records of the header come first, then those of the instances in the order of the file; the
// records of instance i are first_record[i] .. first_record[i + 1] - 1.

#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "parser/part21/keywords.h"
#include "parser/part21/lines.h"
#include "parser/part21/lookup.h"
#include "parser/part21/part21.h"
#include "parser/part21/source.h"

namespace lyr::part21 {

struct Table {
    std::string name;
    Source source;

    std::vector<std::uint64_t> ids;            // per instance
    std::vector<std::uint64_t> places;         // per instance: offset of its #
    std::vector<std::uint32_t> first_record;   // per instance, and one more
    std::vector<KeywordId> record_keywords;    // per record
    std::vector<std::uint64_t> record_places;  // per record: offset of its opening bracket

    struct External {
        std::uint64_t id;
        std::string_view resource;  // "<part.stp#anchor>"
    };
    std::vector<External> externals;  // sorted by id

    Keywords keywords;
    Lookup lookup;
    Lines lines;
    Header header;
    Diagnostics warnings;

    const char* begin() const { return source.text().data(); }
    const char* end() const { return begin() + source.text().size(); }
    const char* at(std::size_t offset) const { return begin() + offset; }
    std::size_t offset_of(const char* p) const { return static_cast<std::size_t>(p - begin()); }

    InstanceIndex find(std::uint64_t id) const { return lookup.find(id, ids); }
    // Not valid() for a record of the header.
    InstanceIndex instance_of(RecordIndex record) const;
    const External* external(std::uint64_t id) const;

    Location location(std::size_t offset) const;
    Location location(std::size_t offset, RecordIndex record) const;

    Result<Arguments> arguments(RecordIndex record) const;
};

// The steps of File::open(), each in a file of its own.
Status index_text(Table& table);  // index.cpp: fills the arrays; header and warnings included
// header.cpp: decodes the records 0 .. count - 1 into table.header; what is odd is a warning.
void decode_header(Table& table, std::size_t count);
// look_alike.cpp: what a text that is not Part 21 seems to be: "an ASCII STL file".
std::string look_alike(std::string_view text);

}  // namespace lyr::part21
