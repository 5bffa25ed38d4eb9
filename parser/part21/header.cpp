// FILE_DESCRIPTION, FILE_NAME and FILE_SCHEMA. Nothing here refuses a file: an entry that is not as
// it should be is a warning.

#include <array>

#include "parser/part21/table.h"

namespace lyr::part21 {
namespace {

void warn(Table& table, Diagnostic reason) {
    reason.severity = Severity::warning;
    table.warnings.push_back(std::move(reason));
}

// "" for $ and for what is no string. Escapes that cannot be read are reported.
std::string string_of(Table& table, const Value& value) {
    if (value.is_unset()) return "";
    Result<std::string> text = value.as_string();
    if (text) return std::move(*text);
    warn(table, text.error());
    return "";
}

// A list of strings; one that stands without brackets is taken as a list of itself.
std::vector<std::string> strings_of(Table& table, const Value& value) {
    std::vector<std::string> strings;
    const Result<List> list = value.as_list();
    if (!list) {
        if (!value.is_unset()) strings.push_back(string_of(table, value));
        return strings;
    }
    for (const Value& member : *list) strings.push_back(string_of(table, member));
    return strings;
}

void decode_name(Table& table, const Arguments& arguments) {
    Header& header = table.header;
    header.name = string_of(table, arguments[0]);
    header.time_stamp = string_of(table, arguments[1]);
    header.authors = strings_of(table, arguments[2]);
    header.organizations = strings_of(table, arguments[3]);
    header.preprocessor_version = string_of(table, arguments[4]);
    header.originating_system = string_of(table, arguments[5]);
    header.authorization = string_of(table, arguments[6]);
}

struct Entry {
    std::string_view keyword;
    std::size_t arguments;
    bool met = false;
};

void decode_entry(Table& table, Entry& entry, RecordIndex record) {
    const Result<Arguments> arguments = table.arguments(record);
    if (!arguments) return warn(table, arguments.error());
    if (const Status status = arguments->expect_count(entry.arguments); !status) {
        warn(table, status.error());
    }
    entry.met = true;
    if (entry.keyword == "FILE_NAME") {
        decode_name(table, *arguments);
    } else if (entry.keyword == "FILE_SCHEMA") {
        table.header.schemas = strings_of(table, (*arguments)[0]);
    } else {
        table.header.description = strings_of(table, (*arguments)[0]);
        table.header.implementation_level = string_of(table, (*arguments)[1]);
    }
}

}  // namespace

void decode_header(Table& table, std::size_t count) {
    std::array<Entry, 3> entries{{{"FILE_DESCRIPTION", 2}, {"FILE_NAME", 7}, {"FILE_SCHEMA", 1}}};
    table.header = {};
    for (std::size_t i = 0; i < count; ++i) {
        const std::string_view keyword = table.keywords.text(table.record_keywords[i]);
        for (Entry& entry : entries) {
            if (entry.keyword == keyword) decode_entry(table, entry, RecordIndex(i));
        }
    }
    for (const Entry& entry : entries) {
        if (entry.met) continue;
        table.warnings.push_back({Severity::warning,
                                  ExitStatus::input,
                                  "the header has no readable " + std::string(entry.keyword),
                                  {.file = table.name}});
    }
}

}  // namespace lyr::part21
