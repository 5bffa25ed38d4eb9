// The arguments of a Part 21 record, read in place from the text of the file.
//
// A Value is a position in the text plus what kind of thing stands there; a number is converted, a
// string decoded, a reference looked up only when asked for. Values, Lists and Arguments are small,
// copied freely, allocate nothing and stay valid as long as their File lives (also when the File
// object is moved).
//
// Contract
//  1. Arguments exist only for a record whose whole text is well formed, so that walking over
//  arguments
//     and nested lists cannot fail; only the conversions (as_...) can.
//  2. A conversion that fails gives a Diagnostic with file:line:column of the value, the #id, the
//  keyword,
//     the number of the argument (from 1), what was expected and what stands there.
//  3. Numbers are exact: the double nearest to the decimal text, ties to even. An integer is read
//     where a real is expected, never the reverse. Beyond what the standard writes, these forms are
//     read too: "1E5" and "1e5" (no point, small e), ".5", "1.0D0" (Fortran's exponent). A real
//     beyond the range of double, an integer or #id beyond 64 bits is an error; a real too small
//     for double is zero.
//  4. as_reference() gives an instance that exists: a name that the file does not define, or that
//     it takes from another file (REFERENCE section), is an error that says so.
//  5. as_string() is valid UTF-8 whatever the file holds. The escapes S, P, X, X2 and X4 and
//     doubled quotes and backslashes are decoded; N and F directives and line breaks are dropped;
//     bytes beyond ASCII are UTF-8 where they form it, else ISO 8859-1; a lone backslash (Windows
//     paths) stands for itself.
//  6. Keywords and enumerations compare without regard to case; real files differ.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "base/typed_index.h"

namespace lyr::part21 {

struct Table;  // what a File owns: text and index

using InstanceIndex = TypedIndex<struct InstanceTag>;  // instances in the order of the file, from 0
using RecordIndex =
    TypedIndex<struct RecordTag>;                 // KEYWORD(arguments); an instance has one or more
using KeywordId = TypedIndex<struct KeywordTag>;  // keywords that occur in this file

// A keyword or enumeration item as it stands in the file. Compare with upper-case text.
struct Name {
    std::string_view as_written;

    std::string upper() const;
    friend bool operator==(Name name, std::string_view upper_case);
};

enum class Kind : std::uint8_t {
    unset,            // $
    derived,          // *
    integer,          // 12
    real,             // 1.2E3
    string,           // 'text'
    binary,           // "23A"
    enumeration,      // .ITEM. (also .T. .F. .U.)
    reference,        // #12
    value_reference,  // @12, edition 3: a value that stands in another file
    constant,         // #NAME or @NAME, edition 3: a constant of the schema
    list,             // (a,b,...)
    typed,            // KEYWORD(a)
};

enum class Logical : std::uint8_t { no, yes, unknown };

// A bit string: hexadecimal digits, of whose first digit `unused_bits` leading bits do not count.
struct Binary {
    int unused_bits = 0;
    std::string_view hex_digits;
};

class List;
struct Typed;

class Value {
public:
    Value() = default;  // unset, of no file

    Kind kind() const { return kind_; }
    bool is_unset() const { return kind_ == Kind::unset; }
    bool is_derived() const { return kind_ == Kind::derived; }
    bool is_list() const { return kind_ == Kind::list; }
    bool is_typed() const { return kind_ == Kind::typed; }
    bool is_reference() const { return kind_ == Kind::reference; }

    Result<double> as_real() const;
    Result<std::int64_t> as_integer() const;
    Result<InstanceIndex> as_reference() const;
    Result<std::string> as_string() const;
    Result<Binary> as_binary() const;
    Result<Name> as_enumeration() const;
    Result<Logical> as_logical() const;  // .T. .F. .U.
    Result<bool> as_boolean() const;     // .T. .F.
    Result<List> as_list() const;
    Result<Typed> as_typed() const;

    // The number behind #, also when nothing has that name.
    Result<std::uint64_t> as_id() const;

    // The value inside PARAMETER_VALUE(..), LENGTH_MEASURE(..) and the like, or the value itself.
    Value untyped() const;

    // A list of one kind in one call, appended to `out`.
    Status append_reals(std::vector<double>& out) const;
    Status append_integers(std::vector<std::int64_t>& out) const;
    Status append_references(std::vector<InstanceIndex>& out) const;
    // A short list such as coordinates: how many were stored; more than `out` holds is an error.
    Result<std::size_t> read_reals(std::span<double> out) const;

    // As in the file, shortened for messages.
    std::string excerpt() const;
    // "CIRCLE argument 3: <message>" at this place.
    Diagnostic error(std::string_view message, ExitStatus status = ExitStatus::input) const;
    // error("expected <what>, found <excerpt>")
    Diagnostic expected(std::string_view what) const;

private:
    friend class Arguments;
    friend class List;
    Value(const Table* table, std::size_t offset, RecordIndex record, std::size_t argument);
    static Value missing(const Table* table, std::size_t closing, RecordIndex record,
                         std::size_t argument);

    const Table* table_ = nullptr;
    std::size_t offset_ = 0;
    RecordIndex record_;
    std::uint16_t argument_ = 0;
    Kind kind_ = Kind::unset;
};

struct Typed {
    Name keyword;
    Value value;
};

// The members of (a,b,...): for (const Value& member : list).
class List {
public:
    class Iterator {
    public:
        Iterator() = default;  // at the end
        const Value& operator*() const { return value_; }
        const Value* operator->() const { return &value_; }
        Iterator& operator++();
        bool operator==(std::default_sentinel_t) const { return at_end_; }

    private:
        friend class List;
        friend class Arguments;
        // `place`: of the first value, or nullptr; `step` is added to its number at each one.
        Iterator(const Value& owner, const char* place, std::size_t argument, std::uint8_t step);

        Value value_;
        std::uint8_t step_ = 0;
        bool at_end_ = true;
    };

    List() = default;
    Iterator begin() const;
    std::default_sentinel_t end() const { return {}; }
    bool empty() const { return begin() == end(); }
    std::size_t count() const;  // walks over the list

private:
    friend class Value;
    explicit List(const Value& value) : value_(value) {}
    Value value_;
};

// The arguments of one record; File::arguments() makes them.
class Arguments {
public:
    std::size_t count() const { return count_; }
    // for (const Value& argument : arguments)
    List::Iterator begin() const;
    std::default_sentinel_t end() const { return {}; }
    // Walks from the argument `direct` on. Asking beyond count() gives an unset value whose error
    // names the argument that is missing.
    Value operator[](std::size_t index) const;

    RecordIndex record() const { return record_; }
    // The error "KEYWORD: expected N arguments, found M", if it is one.
    Status expect_count(std::size_t expected) const;

private:
    friend struct Table;
    // The longest records of AP203/214/242 geometry have 13 arguments.
    static constexpr std::size_t direct = 16;

    const Table* table_ = nullptr;
    RecordIndex record_;
    std::size_t count_ = 0;
    std::size_t start_ = 0;                       // offset of the opening bracket
    std::size_t end_ = 0;                         // and of the closing one
    std::array<std::uint32_t, direct> places_{};  // the first arguments, from start_
};

}  // namespace lyr::part21
