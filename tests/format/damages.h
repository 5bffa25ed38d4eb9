// What the tests of both readers do to a file: each damage of a kind, one at a time.

#pragma once

#include <doctest/doctest.h>

#include <random>
#include <utility>
#include <vector>

#include "files.h"

namespace lyr::format::test {

// check(damaged file, the byte of the flipped bit).
template <class Check>
void with_each_bit_flipped(const FileBytes& file, Check check) {
    FileBytes damaged = file;
    for (std::size_t at = 0; at < file.size(); ++at) {
        for (int bit = 0; bit < 8; ++bit) {
            damaged[at] ^= static_cast<std::byte>(1 << bit);
            INFO("byte " << at << " bit " << bit);
            check(std::as_const(damaged), at);
            damaged[at] = file[at];
        }
    }
}

// check(file that is cut short).
template <class Check>
void with_each_cut(const FileBytes& file, Check check) {
    for (std::size_t size = 0; size < file.size(); ++size) {
        INFO("cut at byte " << size);
        check(FileBytes(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size)));
    }
}

// check(file without a block, the block), and with that block twice.
template <class Check>
void with_each_block_missing_or_doubled(const FileBytes& file, Check check) {
    const std::vector<Block> blocks = split(file);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        INFO("block " << i << " of type " << int{blocks[i].type});
        const auto place = static_cast<std::ptrdiff_t>(i);
        auto changed = blocks;
        changed.erase(changed.begin() + place);
        check(join(file, changed), blocks[i]);
        changed = blocks;
        changed.insert(changed.begin() + place, blocks[i]);
        check(join(file, changed), blocks[i]);
    }
}

// check(file with two neighbours swapped, the number of the second).
template <class Check>
void with_each_two_blocks_swapped(const FileBytes& file, Check check) {
    const std::vector<Block> blocks = split(file);
    for (std::size_t i = 1; i < blocks.size(); ++i) {
        INFO("blocks " << i - 1 << " and " << i);
        auto changed = blocks;
        std::swap(changed[i], changed[i - 1]);
        check(join(file, changed), i);
    }
}

// check(file of random bytes as operations behind a path and a grid): codes and small numbers more often.
template <class Check>
void with_random_operations(Check check) {
    std::mt19937 random(7);
    const auto pick = [&](int count) {
        return std::uniform_int_distribution<int>(0, count - 1)(random);
    };
    const std::vector<int> codes{0x00, 0x1f, 0x20, 0x33, 0x40, 0x41, 0x42, 0x45, 0x46, 0x47, 0x48,
                                 0x49, 0x4a, 0x4b, 0x50, 0x51, 0x54, 0x57, 0x58, 0x5b, 0xf3};
    for (int i = 0; i < 20000; ++i) {
        FileBytes raw;
        for (const int byte : {0x50, 1, 0, 0x46, 0x80, 0x80, 0x80, 0x80, 8, 0, 0, 2})
            raw.push_back(static_cast<std::byte>(byte));
        const int size = pick(60);
        for (int k = 0; k < size; ++k)
            raw.push_back(static_cast<std::byte>(
                pick(3) == 0 ? codes[static_cast<std::size_t>(pick(static_cast<int>(codes.size())))]
                : pick(4)    ? pick(16)
                             : pick(256)));
        INFO("turn " << i);
        check(raw_file(raw, 3));
    }
}

}  // namespace lyr::format::test
