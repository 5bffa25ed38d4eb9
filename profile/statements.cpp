// toml++ parses and keeps its tables sorted by name; what they hold is put back in the order of the text.

#include "profile/statements.h"

#include <toml++/toml.h>

#include <algorithm>
#include <tuple>

namespace lyr::profile {
namespace {

Scalar scalar_of(const toml::node& node) {
    if (const auto* number = node.as_floating_point()) return number->get();
    if (const auto* number = node.as_integer()) return static_cast<double>(number->get());
    if (const auto* flag = node.as_boolean()) return flag->get();
    if (const auto* text = node.as_string()) return text->get();
    return std::monostate();
}

Given given_by(const toml::node& node) {
    const auto* array = node.as_array();
    if (!array) return scalar_of(node);
    List list;
    for (const toml::node& entry : *array) list.push_back(scalar_of(entry));
    return list;
}

std::string part_of_path(const toml::key& key) {
    const std::string name(key.str());
    return name.find('.') == std::string::npos ? name : '"' + name + '"';
}

void collect(const toml::table& table, const std::string& prefix, std::vector<Statement>& out) {
    for (const auto& [key, node] : table) {
        const std::string path = prefix + part_of_path(key);
        const auto* section = node.as_table();
        if (section && !section->empty()) {
            collect(*section, path + '.', out);
            continue;
        }
        const toml::source_position place = key.source().begin;
        out.push_back({path, section ? Given() : given_by(node),
                       static_cast<std::uint32_t>(place.line),
                       static_cast<std::uint32_t>(place.column), section != nullptr});
    }
}

}  // namespace

Result<std::vector<Statement>> statements_of(std::string_view text, const std::string& file) {
    const toml::parse_result parsed = toml::parse(text, file);
    if (!parsed) {
        const toml::source_position place = parsed.error().source().begin;
        return Diagnostic{Severity::error,
                          ExitStatus::input,
                          std::string(parsed.error().description()),
                          {.file = file,
                           .line = static_cast<std::uint32_t>(place.line),
                           .column = static_cast<std::uint32_t>(place.column)}};
    }
    std::vector<Statement> statements;
    collect(parsed.table(), "", statements);
    std::sort(statements.begin(), statements.end(), [](const Statement& a, const Statement& b) {
        return std::tie(a.line, a.column) < std::tie(b.line, b.column);
    });
    return statements;
}

}  // namespace lyr::profile
