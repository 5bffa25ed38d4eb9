// Reading an ISO 10303-21 exchange structure (a STEP file, editions 1 to 3) into a table of
// instances.
//
// The file is mapped into memory and gone over once: each instance leaves its #id, its place and
// the number of its keyword in flat arrays. Arguments are read later, in place, when asked for
// (value.h). This room knows the exchange structure and nothing of what the entities mean.
//
//     auto file = part21::File::open("part.step");            if (!file) return file.error();
//     for (InstanceIndex solid : file->instances_of("MANIFOLD_SOLID_BREP")) {
//         auto args = file->arguments(solid);                  if (!args) return args.error();
//         auto shell = (*args)[1].as_reference();              if (!shell) return shell.error();
//         if (file->is(*shell, "CLOSED_SHELL")) ...
//     }
//
// Contract
//  1. No input crashes it, makes it recurse with the input's depth or makes it run for longer than
//     in proportion to the input's size.
//  2. open() succeeds only on a whole file: every instance of every DATA section is in the table,
//     no string, comment or bracket is left open, no #id is defined twice, none is beyond 64 bits,
//     no list is nested deeper than max_depth. Otherwise the error says where (file:line:column,
//     #id) and what was expected.
//  3. What is no STEP file is refused with the name of what it looks like; an IFC building model is
//     refused with status unsupported.
//  4. Whitespace, comments and a byte order mark may stand before ISO-10303-21;. An odd or missing
//     header entry is a warning, as is a missing END-ISO-10303-21; after a closed DATA section.
//  5. ANCHOR, REFERENCE and SIGNATURE sections are passed over; the #ids that a REFERENCE section
//     takes from other files are remembered, so that a use of one can be explained.
//  6. Lookup by #id takes constant time; all functions that are const may be called from several
//     threads.
//  7. Columns count bytes, from 1. Lines end with LF, CR LF or CR.

#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "parser/part21/value.h"

namespace lyr::part21 {

// Brackets inside brackets. Schemas nest lists three deep at most; 64 leaves room and bounds the
// stack.
inline constexpr int max_depth = 64;

// The HEADER section, decoded; what a file leaves out is empty.
struct Header {
    std::vector<std::string> description;
    std::string implementation_level;
    std::string name;
    std::string time_stamp;
    std::vector<std::string> authors;
    std::vector<std::string> organizations;
    std::string preprocessor_version;
    std::string originating_system;
    std::string authorization;
    std::vector<std::string> schemas;  // as written: "AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }"
};

class File {
public:
    static Result<File> open(const std::string& path);
    // The same from memory; `name` is what diagnostics call it.
    static Result<File> parse(std::string name, std::string text);

    File(File&&) noexcept;
    File& operator=(File&&) noexcept;
    ~File();

    const std::string& name() const;
    std::string_view text() const;  // as it was read
    const Header& header() const;
    const Diagnostics& diagnostics() const;  // warnings met while indexing

    // Instances, in the order of the file.
    std::size_t instance_count() const;
    std::uint64_t id(InstanceIndex instance) const;
    InstanceIndex find(std::uint64_t id) const;  // not valid() when the file defines no such #id

    // Keywords, upper case. One that does not occur in the file has no KeywordId (not valid()).
    KeywordId keyword_id(std::string_view upper_case) const;
    std::string_view keyword(KeywordId keyword) const;

    // Records. An instance in external mapping, #1=(A(..)B(..)), has several: it is complex. The
    // order of records is that of the file. (One in external mapping with a single record is
    // simple.)
    bool is_complex(InstanceIndex instance) const;
    std::size_t record_count(InstanceIndex instance) const;
    RecordIndex record(InstanceIndex instance, std::size_t number) const;
    // The record with this keyword; not valid() when there is none.
    RecordIndex record(InstanceIndex instance, std::string_view upper_case) const;
    RecordIndex record(InstanceIndex instance, KeywordId keyword) const;
    KeywordId keyword_of(RecordIndex record) const;
    InstanceIndex instance_of(RecordIndex record) const;

    // The keyword of a simple instance; of a complex one "(A B C)", all of them.
    std::string type_name(InstanceIndex instance) const;
    // The keyword of a simple instance; not valid() for a complex one.
    KeywordId keyword_of(InstanceIndex instance) const;
    // Whether one of its records has this keyword.
    bool is(InstanceIndex instance, std::string_view upper_case) const;
    bool is(InstanceIndex instance, KeywordId keyword) const;
    // All instances with a record of this keyword, in the order of the file; one scan over
    // integers.
    std::vector<InstanceIndex> instances_of(std::string_view upper_case) const;
    // The same of all keywords that match.
    std::vector<InstanceIndex> instances_where(
        const std::function<bool(std::string_view keyword)>& matches) const;

    // Errors: the text of the record is malformed. For an instance: its only record; that it is
    // complex is an error too, since its arguments are spread over its records.
    Result<Arguments> arguments(RecordIndex record) const;
    Result<Arguments> arguments(InstanceIndex instance) const;

    // The numbers of an instance that is written plainly as KEYWORD('a name',(1.,2.,3.)), as most are in a file; how many
    // there are is returned. None: it is not, or there are more than `out` holds; arguments() will tell.
    std::optional<std::size_t> plain_reals(InstanceIndex instance, std::span<double> out) const;

    // Where an instance stands, and a diagnostic there.
    Location location(InstanceIndex instance) const;
    Diagnostic error(InstanceIndex instance, std::string message,
                     ExitStatus status = ExitStatus::input) const;

    // The file that a REFERENCE section names for this #id, "<part.stp#anchor>".
    std::optional<std::string_view> external_reference(std::uint64_t id) const;

private:
    explicit File(std::unique_ptr<Table> table);
    std::unique_ptr<Table> table_;
};

}  // namespace lyr::part21
