// The specification's worked example is what the writer makes, byte for byte.

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "files.h"
#include "worked_example.h"

using namespace lyr;
using namespace lyr::format;

namespace {

struct Row {
    std::size_t offset = 0;
    test::FileBytes bytes;
};

// "| 0010 | `01 a8 00 00` | meaning |"
std::vector<Row> rows_of_document() {
    std::ifstream file(std::string(LYR_FIXTURES) + "/../docs/lyr-format.md");
    std::vector<Row> rows;
    bool inside = false;
    for (std::string line; std::getline(file, line);) {
        if (line.find("worked example: begin") != std::string::npos) inside = true;
        if (line.find("worked example: end") != std::string::npos) inside = false;
        const bool row_of_bytes = line.size() > 10 && line.substr(6, 4) == " | `";
        if (!inside || !row_of_bytes) continue;
        Row row;
        std::istringstream(line.substr(2, 4)) >> std::hex >> row.offset;
        const std::size_t open = line.find('`'), close = line.find('`', open + 1);
        REQUIRE(close != std::string::npos);
        std::istringstream digits(line.substr(open + 1, close - open - 1));
        for (unsigned byte = 0; digits >> std::hex >> byte;)
            row.bytes.push_back(static_cast<std::byte>(byte));
        rows.push_back(row);
    }
    return rows;
}

}  // namespace

TEST_CASE("the worked example of docs/lyr-format.md is the writer's file, byte for byte") {
    const std::string path = test::scratch("worked_example");
    const Status written = test::write_worked_example(path);
    REQUIRE(written.ok());
    test::FileBytes documented;
    for (const Row& row : rows_of_document()) {
        CHECK(row.offset == documented.size());
        documented.insert(documented.end(), row.bytes.begin(), row.bytes.end());
    }
    CHECK(documented == test::load(path));
    const test::Reading reading = test::read_file(path);
    CHECK(!reading.error);
    CHECK(reading.given.size() == 29);
}

TEST_CASE("the example of docs/c-reader.md is the program that the tests build, and it works") {
    const auto text = [](const std::string& path) {
        std::stringstream out;
        out << std::ifstream(std::string(LYR_FIXTURES) + path).rdbuf();
        return out.str();
    };
    const std::string program = text("/../tests/format/print_layers.c");
    CHECK(!program.empty());
    CHECK(text("/../docs/c-reader.md").find("```c\n" + program + "```\n") != std::string::npos);
    const std::string path = test::scratch("example");
    REQUIRE(test::write_worked_example(path).ok());
    const auto run = [&] {
        const std::string out = path + ".txt";
        const int status = std::system(
            (LYR_EMULATOR " " LYR_BUILD "/print_layers " + path + " >" + out + " 2>&1").c_str());
        std::stringstream printed;
        printed << std::ifstream(out).rdbuf();
        return std::pair(status, printed.str());
    };
    CHECK(run() == std::pair(0, std::string("layer 1: up to z = 0.200 mm\n")));
    const std::uintmax_t cut = std::filesystem::file_size(path) - 15;
    std::filesystem::resize_file(path, cut);
    const auto [status, printed] = run();
    CHECK(status != 0);
    CHECK(printed.find("cut short at byte " + std::to_string(cut) +
                       "; the last whole layer is 1") != std::string::npos);
}
