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
        return Source{
            own + std::string(extension), own, std::string(file.text), {}, "built-in " + own, true};
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
    if (path == "-") return Source{standard_input_name, {}, std::move(*text), {}, "-", false};
    std::error_code failed;
    const fs::path place = fs::weakly_canonical(path, failed);
    return Source{path,
                  without_extension(fs::path(path).filename().string()),
                  std::move(*text),
                  fs::path(path).parent_path().string(),
                  failed ? path : place.string(),
                  false};
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
