#include "base/read_text.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

using namespace lyr;
namespace fs = std::filesystem;

TEST_CASE("read text: all of a file up to the limit, and not a byte more") {
    const fs::path folder = fs::path(LYR_BUILD) / "test-read-text";
    fs::create_directories(folder);
    for (const std::size_t size : {0u, 1u, 65'535u, 65'536u, 65'537u, 300'000u}) {
        CAPTURE(size);
        std::string text(size, 'x');
        for (std::size_t i = 0; i < size; ++i) text[i] = static_cast<char>(i * i % 251);
        std::ofstream(folder / "file", std::ios::binary) << text;
        const auto read = read_text(folder / "file", size);
        REQUIRE(read);
        CHECK(*read == text);
        if (size == 0) continue;
        const auto refused = read_text(folder / "file", size - 1);
        REQUIRE(!refused);
        CHECK(refused.error().status == ExitStatus::input);
    }
}

TEST_CASE("read text: what cannot be read is an error of input that names the path") {
    for (const std::string path : {"/nonexistent", "/tmp", "/dev/zero"}) {
        const auto read = read_text(path, 1000);
        REQUIRE(!read);
        CHECK(read.error().status == ExitStatus::input);
        CHECK(read.error().where.file == path);
    }
}
