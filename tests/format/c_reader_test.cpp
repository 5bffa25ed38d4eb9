// The C reader: what it gives out and refuses is what the C++ reader does.

#include <doctest/doctest.h>
#include <sys/mman.h>

#include <filesystem>
#include <random>

#include "c_reader.h"
#include "files.h"
#include "sample.h"
#include "small_file.h"

using namespace lyr;
using namespace lyr::format;
using test::FileBytes;

namespace {

std::string difference(const FileBytes& bytes, std::size_t most = SIZE_MAX) {
    const int descriptor = ::memfd_create("lyr", 0);
    REQUIRE(::write(descriptor, bytes.data(), bytes.size()) ==
            static_cast<ssize_t>(bytes.size()));
    REQUIRE(::lseek(descriptor, 0, SEEK_SET) == 0);
    const ReadOptions options{.keep_thumbnails = false, .keep_configuration = false};
    return test::difference(bytes, Reader::from_descriptor(descriptor, "memory", options), most);
}

// Of random calls to the encoder: every operation, several quanta and layers of several chunks.
FileBytes random_file(std::uint32_t seed) {
    const Quantum quantum{seed % 3 == 0 ? 250u : 1000u};
    std::vector<EncodedLayer> layers;
    for (std::uint32_t i = 0; i < 3; ++i) {
        auto layer = test::RandomLayer(seed + i, 0.2 * (i + 1), quantum, 600).finish();
        REQUIRE(layer.ok());
        layers.push_back(*layer);
    }
    const std::string path = test::scratch("c_reader");
    test::write_layers(path, quantum, {}, layers);
    return test::load(path);
}

}  // namespace

TEST_CASE("C reader 3: the same operations as in C++, for random prints") {
    for (std::uint32_t seed = 0; seed < 60; seed += 3) {
        INFO("seed " << seed);
        const FileBytes file = random_file(seed);
        CHECK(difference(file) == "");
        // From a source that gives little at a time.
        if (seed == 0) CHECK(difference(file, 7) == "");
    }
}

TEST_CASE("C reader 1 and 3: the same verdict whatever bit is flipped") {
    const FileBytes file = test::small_file();
    CHECK(difference(file) == "");
    FileBytes damaged = file;
    for (std::size_t at = 0; at < file.size(); ++at) {
        for (int bit = 0; bit < 8; ++bit) {
            damaged[at] ^= static_cast<std::byte>(1 << bit);
            INFO("byte " << at << " bit " << bit);
            REQUIRE(difference(damaged) == "");
            damaged[at] = file[at];
        }
    }
}

TEST_CASE("C reader 2 and 3: the same verdict wherever the file is cut, and the last whole layer") {
    const FileBytes file = test::small_file();
    for (std::size_t size = 0; size < file.size(); ++size) {
        INFO("cut at byte " << size);
        REQUIRE(difference({file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size)}) == "");
    }
    FileBytes longer = file;
    longer.push_back(std::byte{0});
    CHECK(difference(longer) == "");
}

TEST_CASE("C reader 3 and 4: the same verdict on any byte of any payload, with a right CRC") {
    const FileBytes file = test::small_file();
    const std::vector<test::Block> blocks = test::split(file);
    std::mt19937 random(5);
    for (std::size_t i = 1; i < blocks.size(); ++i) {
        for (std::size_t at = 0; at < blocks[i].payload.size(); ++at) {
            for (int turn = 0; turn < 12; ++turn) {
                auto changed = blocks;
                const auto flip = static_cast<unsigned>(turn < 8 ? 1u << turn : 1 + random() % 255);
                changed[i].payload[at] ^= static_cast<std::byte>(flip);
                INFO("block " << i << " byte " << at << " flip " << flip);
                REQUIRE(difference(test::join(file, changed)) == "");
            }
        }
    }
}

TEST_CASE("C reader 3: blocks that are missing, doubled, swapped or of another type") {
    const FileBytes file = test::small_file();
    const std::vector<test::Block> blocks = test::split(file);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        INFO("block " << i);
        auto changed = blocks;
        changed.erase(changed.begin() + static_cast<std::ptrdiff_t>(i));
        CHECK(difference(test::join(file, changed)) == "");
        changed = blocks;
        changed.insert(changed.begin() + static_cast<std::ptrdiff_t>(i), blocks[i]);
        CHECK(difference(test::join(file, changed)) == "");
        for (const int type : {0x00, 0x06, 0x47, 0x80, 0x81, 0x82, 0xff, 1, 2, 3, 4, 5}) {
            changed = blocks;
            changed[i].type = static_cast<std::uint8_t>(type);
            CHECK(difference(test::join(file, changed)) == "");
        }
        if (i == 0) continue;
        changed = blocks;
        std::swap(changed[i], changed[i - 1]);
        CHECK(difference(test::join(file, changed)) == "");
    }
}

TEST_CASE("C reader 3 and 4: the same verdict on random operations") {
    std::mt19937 random(7);
    const auto pick = [&](int count) {
        return std::uniform_int_distribution<int>(0, count - 1)(random);
    };
    const std::vector<int> codes{0x00, 0x1f, 0x20, 0x33, 0x40, 0x41, 0x42, 0x45, 0x46, 0x47,
                                 0x50, 0x51, 0x54, 0x57, 0x58, 0x5b, 0xf0, 0xf3};
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
        REQUIRE(difference(test::raw_file(raw, 3)) == "");
    }
}
