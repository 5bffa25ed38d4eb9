#include "base/replace_file.h"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "scratch.h"

using namespace lyr;
using lyr::tests::scratch_folder;
namespace fs = std::filesystem;

namespace {

std::string text_of(const fs::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
}

// Standard output leads to a file, and back again at end().
class StandardOutputTo {
public:
    explicit StandardOutputTo(const fs::path& path) {
        std::fflush(stdout);
        const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        ::dup2(file, STDOUT_FILENO);
        ::close(file);
    }
    void end() const {
        ::dup2(saved_, STDOUT_FILENO);
        ::close(saved_);
    }

private:
    int saved_ = ::dup(STDOUT_FILENO);
};

std::size_t entries(const fs::path& folder) {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

}  // namespace

TEST_CASE("replace file 1: the old file stands until the new one is whole") {
    const fs::path folder = scratch_folder("commit"), path = folder / "out";
    std::ofstream(path) << "old";
    auto file = ReplaceFile::open(path);
    REQUIRE(file);
    file->write("new");
    CHECK(text_of(path) == "old");
    CHECK(file->commit());
    CHECK(text_of(path) == "new");
    CHECK(entries(folder) == 1);
}

TEST_CASE("replace file 1: flushed is not committed") {
    const fs::path folder = scratch_folder("flush"), path = folder / "out";
    std::ofstream(path) << "old";
    auto file = ReplaceFile::open(path);
    REQUIRE(file);
    file->write("new ");
    CHECK(file->flush());
    CHECK(text_of(path) == "old");
    file->write("text");
    CHECK_FALSE(file->failed());
    CHECK(file->commit());
    CHECK(text_of(path) == "new text");
}

TEST_CASE("replace file 5: a file that is replaced hands its permissions on") {
    const fs::path folder = scratch_folder("permissions"), path = folder / "out";
    for (const auto permissions : {fs::perms{0600}, fs::perms{0755}, fs::perms{0666}}) {
        std::ofstream(path) << "old";
        fs::permissions(path, permissions);
        auto file = ReplaceFile::open(path);
        REQUIRE(file);
        CHECK(file->commit());
        CHECK(fs::status(path).permissions() == permissions);
    }
}

TEST_CASE("replace file: a leftover under the temporary name is not written into") {
    const fs::path folder = scratch_folder("leftover"), path = folder / "out";
    std::ofstream(folder / "other") << "other";
    fs::create_symlink("other", path.string() + '.' + std::to_string(::getpid()) + ".part");
    auto file = ReplaceFile::open(path);
    REQUIRE(file);
    file->write("new");
    CHECK(file->commit());
    CHECK(text_of(folder / "other") == "other");
    CHECK(text_of(path) == "new");
    CHECK(entries(folder) == 2);
}

TEST_CASE("replace file 2: what is not committed is removed, an exception included") {
    const fs::path folder = scratch_folder("abandon"), path = folder / "out";
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

TEST_CASE("replace file 3: an open descriptor is written where it stands, by any of its names") {
    const fs::path folder = scratch_folder("descriptor");
    fs::create_symlink("/dev/stdout", folder / "link");
    const fs::path before = fs::read_symlink("/dev/stdout");
    for (const std::string& name :
         {std::string("-"), std::string("/dev/stdout"), std::string("/dev/fd/1"),
          "/proc/" + std::to_string(::getpid()) + "/fd/1", (folder / "link").string()}) {
        CAPTURE(name);
        const fs::path caught = folder / "caught";
        const StandardOutputTo redirected(caught);
        REQUIRE(::write(STDOUT_FILENO, "before ", 7) == 7);
        bool written = false;
        {
            auto file = ReplaceFile::open(name);
            if (file) {
                file->write("text");
                written = file->commit().ok();
            }
        }
        const bool after = ::write(STDOUT_FILENO, " after", 6) == 6;
        redirected.end();
        CHECK(written);
        CHECK(after);
        CHECK(text_of(caught) == "before text after");
        CHECK(entries(folder) == 2);
    }
    REQUIRE(fs::is_symlink("/dev/stdout"));
    CHECK(fs::read_symlink("/dev/stdout") == before);
    CHECK(fs::is_symlink(folder / "link"));
}

TEST_CASE("replace file 3: a descriptor that cannot be written is said to be bad") {
    const int reading = ::open("/dev/null", O_RDONLY);
    REQUIRE(reading >= 0);
    const auto file = ReplaceFile::open("/dev/fd/" + std::to_string(reading));
    ::close(reading);
    REQUIRE(!file);
    CHECK(file.error().status == ExitStatus::output);
    CHECK(file.error().message.find(std::strerror(EBADF)) != std::string::npos);
}

TEST_CASE("replace file 4: a link stays and its target is replaced") {
    const fs::path folder = scratch_folder("link"), target = folder / "target",
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

TEST_CASE("replace file 4: a link to a file that is not there yet stays, and the file is made") {
    const fs::path folder = scratch_folder("dangling");
    fs::create_directories(folder / "far" / "away");
    fs::create_symlink("../target", folder / "far" / "second");
    fs::create_symlink("far/second", folder / "first");
    auto file = ReplaceFile::open(folder / "first");
    REQUIRE(file);
    file->write("new");
    CHECK(file->commit());
    CHECK(fs::is_symlink(folder / "first"));
    CHECK(fs::is_symlink(folder / "far" / "second"));
    CHECK_FALSE(fs::is_symlink(folder / "target"));
    CHECK(text_of(folder / "target") == "new");
    CHECK(entries(folder) == 3);
}

TEST_CASE("replace file 4: a link that cannot be followed is an error and stays") {
    const fs::path folder = scratch_folder("circle");
    fs::create_symlink("b", folder / "a");
    fs::create_symlink("a", folder / "b");
    fs::create_symlink("missing/out", folder / "nowhere");
    for (const char* name : {"a", "b", "nowhere"}) {
        const auto file = ReplaceFile::open(folder / name);
        REQUIRE(!file);
        CHECK(file.error().status == ExitStatus::output);
        CHECK(fs::is_symlink(folder / name));
    }
    CHECK(entries(folder) == 3);
}

TEST_CASE("replace file 6: the first failure is reported, however much is written after it") {
    for (const std::size_t bytes : {std::size_t{1}, std::size_t{1} << 16, std::size_t{1} << 22}) {
        CAPTURE(bytes);
        auto full = ReplaceFile::open("/dev/full");
        REQUIRE(full);
        for (int i = 0; i < 3; ++i) full->write(std::string(bytes, 'x'));
        errno = 0;  // whatever else the program did meanwhile
        const Status done = full->commit();
        REQUIRE(!done);
        CHECK(done.error().message.find(std::strerror(ENOSPC)) != std::string::npos);
    }
}

TEST_CASE("replace file 2: the end of the process takes what is not committed with it") {
    const fs::path folder = scratch_folder("end");
    std::ofstream(folder / "replaced") << "old";
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        auto whole = ReplaceFile::open(folder / "whole");
        auto half = ReplaceFile::open(folder / "half");
        auto replaced = ReplaceFile::open(folder / "replaced");
        auto moved = std::move(half);
        const bool committed = whole && moved && replaced && whole->commit().ok();
        end_process(committed ? ExitStatus::stopped : ExitStatus::internal);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    CHECK(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 8);
    CHECK(fs::exists(folder / "whole"));
    CHECK(text_of(folder / "replaced") == "old");
    CHECK(entries(folder) == 2);
}

TEST_CASE("replace file: errors are of output and name the path") {
    const fs::path folder = scratch_folder("errors");
    for (const fs::path& path : {folder, folder / "missing" / "out"}) {
        const auto file = ReplaceFile::open(path);
        REQUIRE(!file);
        CHECK(file.error().status == ExitStatus::output);
        CHECK(file.error().where.file == path);
    }
}
