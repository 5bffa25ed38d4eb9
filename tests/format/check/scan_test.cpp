// Blocks are found again behind damage of any kind.

#include "format/check/scan.h"

#include <doctest/doctest.h>

#include <random>

#include "tests_of_check.h"

using namespace lyr;
using namespace lyr::format;
using namespace lyr::format::test;

namespace {

std::vector<Piece> scan(const FileBytes& file) {
    FileView view(file);
    Scanner scanner(view);
    std::vector<Piece> pieces;
    while (const auto piece = scanner.next()) pieces.push_back(*piece);
    return pieces;
}

// Contract 1; how many are right.
std::size_t right_pieces(const FileBytes& file) {
    const std::vector<Piece> pieces = scan(file);
    std::uint64_t at = 16;
    std::size_t right = 0;
    for (const Piece& piece : pieces) {
        CHECK(piece.begin == at);
        CHECK(piece.end > at);
        at = piece.end;
        right += piece.right;
    }
    CHECK(at == std::max<std::uint64_t>(file.size(), 16));
    return right;
}

}  // namespace

TEST_CASE("scan 1 and 2: all other blocks are found, whatever becomes of one") {
    const FileBytes file = small_file();
    const std::vector<Block> blocks = split(file);
    CHECK(right_pieces(file) == blocks.size());
    std::mt19937 random(3);
    std::size_t begin = 16;
    for (const Block& block : blocks) {
        const std::size_t size = block.payload.size() + 8;
        for (int turn = 0; turn < 20; ++turn) {
            FileBytes damaged = file;
            const auto at = [&](std::size_t offset) {
                return damaged.begin() + static_cast<std::ptrdiff_t>(begin + offset);
            };
            const std::size_t from = random() % size, to = from + 1 + random() % (size - from);
            if (turn % 3 == 0)
                damaged.erase(at(from), at(to));
            else if (turn % 3 == 1)
                damaged.insert(at(from), random() % 300 + 1, std::byte{0x77});
            else
                for (auto byte = at(from); byte != at(to); ++byte)
                    *byte ^= static_cast<std::byte>(1 + random() % 255);
            if (turn % 3 == 1 && from == 0) continue;
            INFO("block at " << begin << " turn " << turn << " from " << from << " to " << to);
            const bool all_gone = turn % 3 == 0 && from == 0 && to == size;
            CHECK(right_pieces(damaged) == blocks.size() - 1);
            CHECK(scan(damaged).size() == blocks.size() - all_gone);
        }
        begin += size;
    }
}

TEST_CASE("scan 3: a file full of heads of long blocks is done in a moment") {
    FileBytes file = small_file();
    file.resize(16);
    // Thumbnails of 12 MB that begin at each fourth byte.
    while (file.size() < 16'000'000) put_little(file, 0xb71b0081, 4);
    CHECK(right_pieces(file) == 0);
}
