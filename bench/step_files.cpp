#include "bench/step_files.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace lyr::bench {

std::vector<std::string> step_files(const std::string& path) {
    if (!std::filesystem::is_directory(path)) return {path};
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(path)) {
        std::string extension = entry.path().extension();
        std::transform(extension.begin(), extension.end(), extension.begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        if (extension == ".step" || extension == ".stp") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace lyr::bench
