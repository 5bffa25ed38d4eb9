#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>
#include <stdlib.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "scratch.h"

namespace lyr::tests {
namespace {

namespace fs = std::filesystem;

fs::path made_folder() {
    std::string folder = fs::temp_directory_path() / "lyr-test-XXXXXX";
    if (!::mkdtemp(folder.data()))
        throw fs::filesystem_error("a folder for the tests' files", folder,
                                   std::error_code(errno, std::generic_category()));
    return folder;
}

// Made when it is first asked for, which may be before main().
const fs::path& own_folder() {
    static const fs::path folder = made_folder();
    return folder;
}

}  // namespace

std::string scratch(const std::string& name) {
    return own_folder() / name;
}

std::string scratch_folder(const std::string& name) {
    std::string folder = scratch(name);
    fs::remove_all(folder);
    fs::create_directories(folder);
    return folder;
}

}  // namespace lyr::tests

int main(int argc, char** argv) {
    const std::filesystem::path folder = lyr::tests::scratch("");
    const int status = doctest::Context(argc, argv).run();
    if (status == 0)
        std::filesystem::remove_all(folder);
    else
        std::fprintf(stderr, "what the tests have written: %s\n", folder.c_str());
    return status;
}
