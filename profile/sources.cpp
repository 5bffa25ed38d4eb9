#include "profile/sources.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "base/nearest_name.h"
#include "base/read_text.h"
#include "base/text.h"
#include "profile/built_in.h"

namespace lyr::profile {
namespace {

namespace fs = std::filesystem;

// A profile has a few kilobytes; more is some other file.
constexpr std::size_t largest_file = std::size_t{1} << 20;
constexpr std::string_view extension = ".toml";

std::string without_extension(const std::string& name) {
    return name.ends_with(extension) ? name.substr(0, name.size() - extension.size()) : name;
}

std::optional<Source> built_in(const std::string& name) {
    for (const BuiltIn& file : built_ins()) {
        if (file.name != without_extension(name)) continue;
        const std::string own(file.name);
        Source source{.shown = own + std::string(extension), .name = own, .built_in = true};
        source.text = file.text;
        source.identity = "built-in " + own;
        return source;
    }
    return std::nullopt;
}

std::string known_names(const std::string& name) {
    const std::vector<std::string> names = built_in_names();
    const std::string nearest = nearest_name(without_extension(name), names);
    if (!nearest.empty()) return "; did you mean the built-in `" + nearest + "`?";
    std::string text = "; built in are ";
    for (const std::string& known : names) text += (&known == &names[0] ? "" : ", ") + known;
    return text;
}

Result<Source> from_file(const std::string& path, const std::string& name) {
    auto text = read_text(path, largest_file);
    if (!text) {
        Diagnostic error = text.error();
        std::error_code failed;
        if (path != "-" && !fs::exists(path, failed)) error.message += known_names(name);
        return error;
    }
    Source source{.shown = path, .path = path, .text = std::move(*text), .identity = path};
    if (path == "-") {
        source.shown = standard_input_name;
        return source;
    }
    std::error_code failed;
    const fs::path place = fs::weakly_canonical(path, failed);
    if (!failed) source.identity = place.string();
    source.name = without_extension(fs::path(path).filename().string());
    source.folder = fs::path(path).parent_path().string();
    return source;
}

Result<Source> find(const std::string& name, const std::string& folder) {
    const std::string path = (fs::path(folder) / name).string();
    std::error_code failed;
    const bool is_file_name = name.ends_with(extension) && fs::exists(path, failed);
    if (name.find('/') == std::string::npos && !is_file_name) {
        if (auto source = built_in(name)) return std::move(*source);
    }
    return from_file(path, name);
}

}  // namespace

Result<Source> find_source(const std::string& name) {
    return find(name, {});
}

Result<Source> find_source(const std::string& name, const Source& from) {
    const auto error = [](const std::string& message) {
        return Diagnostic{Severity::error, ExitStatus::input, message, {}};
    };
    if (name == "-") return error("standard input cannot be inherited from");
    if (!from.built_in) return find(name, from.folder);
    if (auto source = built_in(name)) return std::move(*source);
    return error("no built-in profile " + in_quotes(name));
}

}  // namespace lyr::profile
