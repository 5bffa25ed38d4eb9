// File: the doors to the table.

#include "parser/part21/part21.h"

#include "parser/part21/number.h"
#include "parser/part21/table.h"

namespace lyr::part21 {
namespace {

Result<std::unique_ptr<Table>> indexed(std::unique_ptr<Table> table) {
    if (const Status status = index_text(*table); !status) return status.error();
    return table;
}

// In the order of the file, with each instance once.
template <class Matches>
std::vector<InstanceIndex> instances_if(const Table& table, Matches matches) {
    std::vector<InstanceIndex> found;
    const std::vector<KeywordId>& keywords = table.record_keywords;
    for (std::size_t record = table.first_record[0]; record < keywords.size(); ++record) {
        if (!matches(keywords[record])) continue;
        const InstanceIndex instance = table.instance_of(RecordIndex(record));
        if (found.empty() || found.back() != instance) found.push_back(instance);
    }
    return found;
}

}  // namespace

File::File(std::unique_ptr<Table> table) : table_(std::move(table)) {}
File::File(File&&) noexcept = default;
File& File::operator=(File&&) noexcept = default;
File::~File() = default;

Result<File> File::open(const std::string& path) {
    auto table = std::make_unique<Table>();
    table->name = path;
    if (const Status status = table->source.map(path); !status) return status.error();
    auto result = indexed(std::move(table));
    if (!result) return result.error();
    return File(std::move(*result));
}

Result<File> File::parse(std::string name, std::string text) {
    auto table = std::make_unique<Table>();
    table->name = std::move(name);
    table->source.hold(std::move(text));
    auto result = indexed(std::move(table));
    if (!result) return result.error();
    return File(std::move(*result));
}

const std::string& File::name() const {
    return table_->name;
}
std::string_view File::text() const {
    return table_->source.text();
}
const Header& File::header() const {
    return table_->header;
}
const Diagnostics& File::diagnostics() const {
    return table_->warnings;
}

std::size_t File::instance_count() const {
    return table_->ids.size();
}
std::uint64_t File::id(InstanceIndex instance) const {
    return table_->ids[instance.value];
}
InstanceIndex File::find(std::uint64_t id) const {
    return table_->find(id);
}

KeywordId File::keyword_id(std::string_view upper_case) const {
    return table_->keywords.find(upper_case);
}
std::string_view File::keyword(KeywordId keyword) const {
    return table_->keywords.text(keyword);
}

bool File::is_complex(InstanceIndex instance) const {
    return record_count(instance) > 1;
}

std::size_t File::record_count(InstanceIndex instance) const {
    return table_->first_record[instance.value + 1] - table_->first_record[instance.value];
}

RecordIndex File::record(InstanceIndex instance, std::size_t number) const {
    return RecordIndex(table_->first_record[instance.value] + number);
}

RecordIndex File::record(InstanceIndex instance, KeywordId keyword) const {
    const std::uint32_t last = table_->first_record[instance.value + 1];
    for (std::uint32_t i = table_->first_record[instance.value]; i < last; ++i) {
        if (table_->record_keywords[i] == keyword) return RecordIndex(i);
    }
    return {};
}

RecordIndex File::record(InstanceIndex instance, std::string_view upper_case) const {
    return record(instance, keyword_id(upper_case));
}

KeywordId File::keyword_of(RecordIndex record) const {
    return table_->record_keywords[record.value];
}

InstanceIndex File::instance_of(RecordIndex record) const {
    return table_->instance_of(record);
}

std::string File::type_name(InstanceIndex instance) const {
    std::string names;
    for (std::size_t i = 0; i < record_count(instance); ++i) {
        if (i > 0) names += ' ';
        names += keyword(keyword_of(record(instance, i)));
    }
    return is_complex(instance) ? '(' + names + ')' : names;
}

KeywordId File::keyword_of(InstanceIndex instance) const {
    return is_complex(instance) ? KeywordId() : keyword_of(record(instance, std::size_t{0}));
}

bool File::is(InstanceIndex instance, KeywordId keyword) const {
    return keyword.valid() && record(instance, keyword).valid();
}

bool File::is(InstanceIndex instance, std::string_view upper_case) const {
    return is(instance, keyword_id(upper_case));
}

std::vector<InstanceIndex> File::instances_of(std::string_view upper_case) const {
    const KeywordId wanted = keyword_id(upper_case);
    if (!wanted.valid()) return {};
    return instances_if(*table_, [wanted](KeywordId keyword) { return keyword == wanted; });
}

std::vector<InstanceIndex> File::instances_where(
    const std::function<bool(std::string_view)>& matches) const {
    std::vector<char> wanted(table_->keywords.count());
    for (std::size_t k = 0; k < wanted.size(); ++k) wanted[k] = matches(keyword(KeywordId(k)));
    return instances_if(*table_, [&](KeywordId keyword) { return wanted[keyword.value] != 0; });
}

Result<Arguments> File::arguments(RecordIndex record) const {
    return table_->arguments(record);
}

Result<Arguments> File::arguments(InstanceIndex instance) const {
    if (is_complex(instance)) {
        return error(instance,
                     "expected a simple instance, found the complex " + type_name(instance));
    }
    return arguments(record(instance, std::size_t{0}));
}

std::optional<std::size_t> File::plain_reals(InstanceIndex instance, std::span<double> out) const {
    if (is_complex(instance)) return std::nullopt;
    const std::size_t place = table_->record_places[record(instance, std::size_t{0}).value];
    return lyr::part21::plain_reals(table_->at(place), table_->end(), out);
}

Location File::location(InstanceIndex instance) const {
    return table_->location(table_->places[instance.value], record(instance, std::size_t{0}));
}

Diagnostic File::error(InstanceIndex instance, std::string message, ExitStatus status) const {
    return {Severity::error, status, std::move(message), location(instance)};
}

std::optional<std::string_view> File::external_reference(std::uint64_t id) const {
    const Table::External* external = table_->external(id);
    return external ? std::optional(external->resource) : std::nullopt;
}

}  // namespace lyr::part21
