// Profiles in files of a folder of their own, and what comes of them.

#pragma once

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "profile/keys.h"
#include "profile/resolve.h"
#include "scratch.h"

namespace lyr::profile::tests {

class Folder {
public:
    explicit Folder(const std::string& name) : path_(lyr::tests::scratch_folder(name)) {}

    // The path of the file, which is written.
    std::string write(const std::string& name, const std::string& text) const {
        const std::filesystem::path path = path_ / name;
        std::filesystem::create_directories(path.parent_path());
        std::ofstream(path, std::ios::binary) << text;
        return path.string();
    }
    std::string operator/(const std::string& name) const { return (path_ / name).string(); }

private:
    std::filesystem::path path_;
};

inline std::size_t number_of(const std::string& path) {
    for (std::size_t i = 0; i < keys().size(); ++i)
        if (keys()[i].path == path) return i;
    FAIL("no key " << path);
    return 0;
}

inline Resolved resolved(const Request& request) {
    const auto result = resolve(request);
    REQUIRE_MESSAGE(result.ok(), to_string(result.ok() ? Diagnostic{} : result.error()));
    return *result;
}

inline Resolved with_settings(std::vector<Setting> settings) {
    return resolved({{}, std::move(settings)});
}

// One line, with the status and the part.
inline Diagnostic error_of(const Request& request, ExitStatus status, const std::string& part) {
    const auto result = resolve(request);
    CAPTURE(part);
    REQUIRE_FALSE(result.ok());
    const Diagnostic error = result.error();
    CAPTURE(error.message);
    CHECK(error.status == status);
    CHECK(error.message.find(part) != std::string::npos);
    CHECK(error.message.find('\n') == std::string::npos);
    return error;
}

}  // namespace lyr::profile::tests
