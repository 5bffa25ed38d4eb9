// Conversions of values, and what they say when the value is another one.

#include "parser/part21/value.h"

#include <algorithm>

#include "parser/part21/number.h"
#include "parser/part21/scan.h"
#include "parser/part21/table.h"
#include "parser/part21/text.h"
#include "parser/part21/walk.h"

namespace lyr::part21 {
namespace {

std::string_view token(const char* p, const char* end) {
    return {p, static_cast<std::size_t>(skip_value(p, end) - p)};
}

}  // namespace

std::string Name::upper() const {
    return part21::upper(as_written);
}

bool operator==(Name name, std::string_view upper_case) {
    return equals_upper(name.as_written, upper_case);
}

Value::Value(const Table* table, std::size_t offset, RecordIndex record, std::size_t argument)
    : table_(table),
      offset_(offset),
      record_(record),
      argument_(static_cast<std::uint16_t>(std::min<std::size_t>(argument, UINT16_MAX))),
      kind_(kind_at(table->at(offset), table->end())) {}

Value Value::missing(const Table* table, std::size_t closing, RecordIndex record,
                     std::size_t argument) {
    Value value;
    value.table_ = table;
    value.offset_ = closing;
    value.record_ = record;
    value.argument_ = static_cast<std::uint16_t>(std::min<std::size_t>(argument, UINT16_MAX));
    return value;
}

std::string Value::excerpt() const {
    if (!table_ || *table_->at(offset_) == ')') return "nothing";
    const char* p = table_->at(offset_);
    return shortened(p, skip_value(p, table_->end()));
}

Diagnostic Value::error(std::string_view message, ExitStatus status) const {
    Diagnostic diagnostic{Severity::error, status, std::string(message), {}};
    if (!table_) return diagnostic;
    const std::string_view keyword = table_->keywords.text(table_->record_keywords[record_.value]);
    diagnostic.message =
        std::string(keyword) + " argument " + std::to_string(argument_) + ": " + diagnostic.message;
    diagnostic.where = table_->location(offset_, record_);
    return diagnostic;
}

Diagnostic Value::expected(std::string_view what) const {
    return error("expected " + std::string(what) + ", found " + excerpt());
}

Result<double> Value::as_real() const {
    if (kind_ != Kind::real && kind_ != Kind::integer) return expected("a real number");
    const auto number = real_of(token(table_->at(offset_), table_->end()));
    if (!number) return expected("a number below 1.8e308");
    return *number;
}

Result<std::int64_t> Value::as_integer() const {
    if (kind_ != Kind::integer) return expected("an integer");
    const auto number = integer_of(token(table_->at(offset_), table_->end()));
    if (!number) return expected("an integer of at most 64 bits");
    return *number;
}

Result<std::uint64_t> Value::as_id() const {
    if (kind_ == Kind::value_reference || kind_ == Kind::constant) {
        return error("values of other files and constants (" + excerpt() + ") are not supported",
                     ExitStatus::unsupported);
    }
    if (kind_ != Kind::reference) return expected("a reference #id");
    const auto id = read_id(table_->at(offset_) + 1, table_->end()).id;
    if (!id) return expected("an #id of at most 64 bits");
    return *id;
}

Result<InstanceIndex> Value::as_reference() const {
    if (kind_ == Kind::reference) {
        const auto read = read_id(table_->at(offset_) + 1, table_->end()).id;
        const InstanceIndex instance = read ? table_->find(*read) : InstanceIndex();
        if (instance.valid()) return instance;
    }
    const Result<std::uint64_t> id = as_id();
    if (!id) return id.error();
    if (const auto* external = table_->external(*id)) {
        const std::string_view resource = external->resource;
        return error(excerpt() + " is in another file, " +
                         shortened(resource.data(), resource.data() + resource.size()) +
                         ", and references to other files are not supported",
                     ExitStatus::unsupported);
    }
    return error(excerpt() + " is not defined in the file");
}

Result<std::string> Value::as_string() const {
    if (kind_ != Kind::string) return expected("a string");
    const std::string_view quoted = token(table_->at(offset_), table_->end());
    Text text = decode_text(quoted.substr(1, quoted.size() - 2));
    if (text.malformed) return expected("a string with well-formed \\ escapes");
    return std::move(text.utf8);
}

Result<Binary> Value::as_binary() const {
    if (kind_ != Kind::binary) return expected("a binary value");
    const std::string_view quoted = token(table_->at(offset_), table_->end());
    return Binary{quoted[1] - '0', quoted.substr(2, quoted.size() - 3)};
}

Result<Name> Value::as_enumeration() const {
    if (kind_ != Kind::enumeration) return expected("an enumeration .ITEM.");
    const std::string_view dotted = token(table_->at(offset_), table_->end());
    return Name{dotted.substr(1, dotted.size() - 2)};
}

Result<Logical> Value::as_logical() const {
    const Result<Name> name = as_enumeration();
    if (name && *name == "T") return Logical::yes;
    if (name && *name == "F") return Logical::no;
    if (name && *name == "U") return Logical::unknown;
    return expected(".T., .F. or .U.");
}

Result<bool> Value::as_boolean() const {
    const Result<Name> name = as_enumeration();
    if (name && *name == "T") return true;
    if (name && *name == "F") return false;
    return expected(".T. or .F.");
}

Result<List> Value::as_list() const {
    if (kind_ != Kind::list) return expected("a list");
    return List(*this);
}

Result<Typed> Value::as_typed() const {
    if (kind_ != Kind::typed) return expected("a typed value KEYWORD(...)");
    const char* p = table_->at(offset_);
    const char* after = skip_keyword(p, table_->end());
    const char* inner = first_value(skip_blank(after, table_->end()), table_->end());
    return Typed{{{p, static_cast<std::size_t>(after - p)}},
                 Value(table_, table_->offset_of(inner), record_, argument_)};
}

Value Value::untyped() const {
    Value value = *this;
    while (value.is_typed()) value = value.as_typed()->value;
    return value;
}

namespace {

template <class T>
Status append(const Value& value, std::vector<T>& out, Result<T> (Value::*convert)() const) {
    const Result<List> list = value.as_list();
    if (!list) return list.error();
    for (const Value& member : *list) {
        const Result<T> converted = (member.*convert)();
        if (!converted) return converted.error();
        out.push_back(*converted);
    }
    return Done{};
}

}  // namespace

Status Value::append_reals(std::vector<double>& out) const {
    return append(*this, out, &Value::as_real);
}

Status Value::append_integers(std::vector<std::int64_t>& out) const {
    return append(*this, out, &Value::as_integer);
}

Status Value::append_references(std::vector<InstanceIndex>& out) const {
    return append(*this, out, &Value::as_reference);
}

Result<std::size_t> Value::read_reals(std::span<double> out) const {
    const Result<List> list = as_list();
    if (!list) return list.error();
    std::size_t count = 0;
    for (const Value& member : *list) {
        if (count == out.size()) {
            return expected("a list of at most " + std::to_string(out.size()) + " numbers");
        }
        const Result<double> number = member.as_real();
        if (!number) return number.error();
        out[count++] = *number;
    }
    return count;
}

List::Iterator::Iterator(const Value& owner, const char* place, std::size_t argument,
                         std::uint8_t step)
    : step_(step), at_end_(place == nullptr) {
    if (place) {
        value_ = Value(owner.table_, owner.table_->offset_of(place), owner.record_, argument);
    }
}

List::Iterator List::begin() const {
    if (!value_.table_) return {};
    const Table& table = *value_.table_;
    const char* first = first_value(table.at(value_.offset_), table.end());
    return Iterator(value_, first, value_.argument_, 0);
}

List::Iterator& List::Iterator::operator++() {
    const Table& table = *value_.table_;
    const char* next = next_value(table.at(value_.offset_), table.end());
    const std::size_t argument = std::size_t{value_.argument_} + step_;
    *this = Iterator(value_, next, argument, step_);
    return *this;
}

std::size_t List::count() const {
    std::size_t count = 0;
    for (Iterator i = begin(); i != end(); ++i) ++count;
    return count;
}

}  // namespace lyr::part21
