// The configuration as TOML.

#include <algorithm>
#include <filesystem>

#include "base/text.h"
#include "profile/checks.h"
#include "profile/keys.h"

namespace lyr::profile {
namespace {

// Origins stand below each other where values are as short as they mostly are.
constexpr std::size_t comment_column = 32;

}  // namespace

std::string origin_text(const Resolved& resolved, std::size_t key, Folders folders) {
    const Origin& origin = resolved.origins[key];
    const auto& derived = keys()[key].derived;
    const std::string name = folders == Folders::left_out
                                 ? std::filesystem::path(origin.name).filename().string()
                                 : origin.name;
    const std::string place = escaped(name) + ':' + std::to_string(origin.line);
    switch (origin.kind) {
        case Origin::Kind::unsaid:
            return derived ? "default, " + derived->text : "default";
        case Origin::Kind::file:
            return place;
        case Origin::Kind::built_in:
            return place + " (built-in)";
        case Origin::Kind::option:
            return origin.name;
    }
    return {};
}

std::string to_toml(const Resolved& resolved, Folders folders) {
    std::string text, open;
    for (std::size_t i = 0; i < keys().size(); ++i) {
        const Key& key = keys()[i];
        const std::size_t dot = key.path.find('.');
        const std::string section = key.path.substr(0, dot);
        if (section != open) text += (open.empty() ? "[" : "\n[") + section + "]\n";
        open = section;
        std::string line = key.path.substr(dot + 1) + " = " + key.show(resolved.profile);
        line.resize(std::max(line.size() + 2, comment_column), ' ');
        text += line + "# " + origin_text(resolved, i, folders) + '\n';
    }
    return text;
}

}  // namespace lyr::profile
