#include "base/replace_file.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

using namespace lyr;
namespace fs = std::filesystem;

namespace {

// An empty folder of its own for each test.
fs::path fresh_folder(const std::string& name) {
    const fs::path folder = fs::path(LYR_BUILD) / "test-replace-file" / name;
    fs::remove_all(folder);
    fs::create_directories(folder);
    return folder;
}

std::string text_of(const fs::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::size_t entries(const fs::path& folder) {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

}  // namespace

TEST_CASE("replace file 1: the old file stands until the new one is whole") {
    const fs::path folder = fresh_folder("commit"), path = folder / "out";
    std::ofstream(path) << "old";
    auto file = ReplaceFile::open(path);
    REQUIRE(file);
    file->write("new");
    CHECK(text_of(path) == "old");
    CHECK(file->commit());
    CHECK(text_of(path) == "new");
    CHECK(entries(folder) == 1);
}

TEST_CASE("replace file 2: what is not committed is removed, an exception included") {
    const fs::path folder = fresh_folder("abandon"), path = folder / "out";
    { REQUIRE(ReplaceFile::open(path)); }
    CHECK(entries(folder) == 0);
    const auto throwing = [&] {
        auto file = ReplaceFile::open(path);
        file->write("half");
        throw std::runtime_error("stop");
    };
    CHECK_THROWS(throwing());
    CHECK(entries(folder) == 0);
}

TEST_CASE("replace file 3: a device is written directly") {
    auto file = ReplaceFile::open("/dev/null");
    REQUIRE(file);
    file->write("gone");
    CHECK(file->commit());
    CHECK(fs::is_character_file("/dev/null"));
}

TEST_CASE("replace file 3: /dev/stdout stays a link when standard output is a regular file") {
    const fs::path folder = fresh_folder("stdout");
    const int saved = ::dup(STDOUT_FILENO);
    REQUIRE(std::freopen((folder / "caught").c_str(), "w", stdout));
    const fs::path before = fs::read_symlink("/dev/stdout");
    bool written = false;
    {
        auto file = ReplaceFile::open("/dev/stdout");
        if (file) {
            file->write("text");
            written = file->commit().ok();
        }
    }
    ::dup2(saved, STDOUT_FILENO);
    ::close(saved);
    CHECK(written);
    REQUIRE(fs::is_symlink("/dev/stdout"));
    CHECK(fs::read_symlink("/dev/stdout") == before);
    CHECK(text_of(folder / "caught") == "text");
    CHECK(entries(folder) == 1);
}

TEST_CASE("replace file 4: a link stays and its target is replaced") {
    const fs::path folder = fresh_folder("link"), target = folder / "target",
                   link = folder / "link";
    std::ofstream(target) << "old";
    fs::create_symlink("target", link);
    auto file = ReplaceFile::open(link);
    REQUIRE(file);
    file->write("new");
    CHECK(file->commit());
    CHECK(fs::is_symlink(link));
    CHECK(text_of(target) == "new");
    CHECK(entries(folder) == 2);
}

TEST_CASE("replace file: errors are of output and name the path") {
    const fs::path folder = fresh_folder("errors");
    for (const fs::path& path : {folder, folder / "missing" / "out"}) {
        const auto file = ReplaceFile::open(path);
        REQUIRE(!file);
        CHECK(file.error().status == ExitStatus::output);
        CHECK(file.error().where.file == path);
    }
    if (fs::exists("/dev/full")) {
        auto full = ReplaceFile::open("/dev/full");
        REQUIRE(full);
        full->write("too much");
        const Status done = full->commit();
        REQUIRE(!done);
        CHECK(done.error().status == ExitStatus::output);
        CHECK(done.error().message.find("space") != std::string::npos);
    }
}
