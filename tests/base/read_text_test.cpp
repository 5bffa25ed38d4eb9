#include "base/read_text.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "scratch.h"

using namespace lyr;
namespace fs = std::filesystem;

TEST_CASE("read text: all of a file up to the limit, and not a byte more") {
    const fs::path folder = lyr::tests::scratch_folder("read-text");
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

TEST_CASE("read text: the first bytes are looked at before the rest is read, once") {
    const fs::path folder = lyr::tests::scratch_folder("read-text");
    for (const std::size_t size : {0u, 3u, 300'000u}) {
        CAPTURE(size);
        std::ofstream(folder / "head", std::ios::binary) << std::string(size, 'x');
        int calls = 0;
        std::size_t seen = 0;
        HeadCheck check{100'000, [&](std::string_view head) -> std::optional<std::string> {
                            ++calls;
                            seen = head.size();
                            return std::nullopt;
                        }};
        CHECK(read_text(folder / "head", size, check));
        CHECK(calls == 1);
        CHECK(seen >= std::min(size, check.bytes));
        check.wrong = [](std::string_view) { return std::optional<std::string>("no"); };
        const auto refused = read_text(folder / "head", size, check);
        REQUIRE(!refused);
        CHECK(refused.error().message == "no");
    }
    const HeadCheck refuses{1, [](std::string_view) { return std::optional<std::string>("no"); }};
    CHECK(read_text("/dev/zero", most_readable_bytes("/dev/zero"), refuses).error().message ==
          "no");
    CHECK(most_readable_bytes("/dev/zero") == most_streamed_bytes);
    CHECK(most_readable_bytes(folder / "head") > most_streamed_bytes);
}

TEST_CASE("read text: what cannot be read is an error of input that names the path") {
    for (const std::string path : {"/nonexistent", "/tmp", "/dev/zero"}) {
        const auto read = read_text(path, 1000);
        REQUIRE(!read);
        CHECK(read.error().status == ExitStatus::input);
        CHECK(read.error().where.file == path);
    }
}
