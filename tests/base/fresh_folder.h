// An empty folder of its own for each test.

#pragma once

#include <filesystem>
#include <string>

namespace lyr::tests {

inline std::filesystem::path fresh_folder(const std::string& name) {
    const auto folder = std::filesystem::path(LYR_BUILD) / "test-base" / name;
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    return folder;
}

}  // namespace lyr::tests
