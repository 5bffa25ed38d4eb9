#include "base/file_place.h"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include "scratch.h"

using namespace lyr;
using lyr::tests::scratch_folder;
namespace fs = std::filesystem;

TEST_CASE("same file: one file by all its names, there or not") {
    const fs::path folder = scratch_folder("names");
    fs::create_directories(folder / "sub");
    fs::create_directory_symlink("sub", folder / "other");
    fs::create_symlink("sub/file", folder / "link");
    fs::create_symlink("link", folder / "second");
    const std::vector<fs::path> names{folder / "sub" / "file",
                                      folder / "other" / "file",
                                      folder / "sub" / ".." / "sub" / "." / "file",
                                      folder / "link",
                                      folder / "second",
                                      fs::relative(folder) / "sub" / "file"};
    for (const bool there : {false, true}) {
        if (there) std::ofstream(folder / "sub" / "file") << "text";
        for (const fs::path& a : names) {
            CAPTURE(a);
            for (const fs::path& b : names) CHECK(same_file(a, b));
            for (const fs::path& b : {folder / "file", folder / "sub" / "File", folder / "sub"}) {
                CHECK_FALSE(same_file(a, b));
                CHECK_FALSE(same_file(b, a));
            }
        }
    }
    fs::create_hard_link(folder / "sub" / "file", folder / "hard");
    CHECK(same_file(folder / "hard", folder / "link"));
}

TEST_CASE("same file: nothing meets in /dev/null, and circles of links are no file") {
    const fs::path folder = scratch_folder("none");
    fs::create_symlink("/dev/null", folder / "null");
    CHECK_FALSE(same_file("/dev/null", "/dev/null"));
    CHECK_FALSE(same_file("/dev/null", folder / "null"));
    fs::create_symlink("b", folder / "a");
    fs::create_symlink("a", folder / "b");
    CHECK_FALSE(same_file(folder / "a", folder / "b"));
    CHECK_FALSE(place_of(folder / "a"));
}

TEST_CASE("place: names of open descriptors are known, through links too") {
    const fs::path folder = scratch_folder("descriptors");
    fs::create_symlink("/dev/stdout", folder / "link");
    for (const fs::path& name : {fs::path("/dev/stdout"), fs::path("/dev/fd/1"),
                                 fs::path("/proc/self/fd/1"), folder / "link"}) {
        const auto place = place_of(name);
        REQUIRE(place);
        CHECK(place->descriptor == STDOUT_FILENO);
    }
    CHECK(place_of("/dev/stderr")->descriptor == STDERR_FILENO);
    CHECK(place_of("/proc/self/status")->descriptor == -1);
    CHECK(place_of(folder / "1")->descriptor == -1);
    std::ofstream(folder / "open") << "text";
    const int open = ::open((folder / "open").c_str(), O_RDONLY);
    CHECK(same_file("/dev/fd/" + std::to_string(open), folder / "open"));
    ::close(open);
}

TEST_CASE("place: a folder that is missing leaves the name as it is") {
    const fs::path folder = scratch_folder("missing");
    CHECK(place_of(folder / "no" / "file")->path == (folder / "no" / "file").string());
    CHECK(place_of("file")->path == fs::current_path() / "file");
}

TEST_CASE("place: kinds of files") {
    const fs::path folder = scratch_folder("kinds");
    std::ofstream(folder / "file") << "text";
    REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
    CHECK(is_regular_file(folder / "file"));
    for (const fs::path& other : {folder / "pipe", folder, fs::path("/dev/null"), folder / "none"})
        CHECK_FALSE(is_regular_file(other));
    CHECK(is_two_way("/dev/tty") == fs::exists("/dev/tty"));
    for (const fs::path& other : {folder / "pipe", folder / "file", folder / "none"})
        CHECK_FALSE(is_two_way(other));
}
