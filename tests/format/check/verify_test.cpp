// What verify() finds is what was damaged, and nothing else; and it finds something where the reader does.

#include "format/check/verify.h"

#include <doctest/doctest.h>

#include <random>

#include "tests_of_check.h"

using namespace lyr;
using namespace lyr::format;
using namespace lyr::format::test;

namespace {

// Contract 1.
std::string difference(const FileBytes& file) {
    const bool found = !verify(file).findings.empty();
    const Reading reading = read_bytes(file);
    if (found == reading.error.has_value()) return "";
    return found ? "only verify() refuses it: " + verify(file).findings[0].what
                 : "only the reader refuses it: " + reading.error->message;
}

std::vector<std::uint32_t> whole_layers(const Verification& v) {
    std::vector<std::uint32_t> numbers;
    for (const CheckedLayer& layer : v.layers) numbers.push_back(layer.index + 1);
    return numbers;
}

using Numbers = std::vector<std::uint32_t>;

}  // namespace

TEST_CASE("verify: a whole file has no findings, and its counts are right") {
    const Verification v = verify(small_file());
    CHECK(v.findings.empty());
    CHECK(v.chunks == 4);
    CHECK(v.operations == 69);
    CHECK(v.blocks == 12);
    CHECK(whole_layers(v) == Numbers{1, 2, 3});
    CHECK(v.whole_from_start == 3);
    CHECK(v.stated_layers == 3);
    CHECK_FALSE(v.cut_short);
    REQUIRE(v.metadata.has_value());
    CHECK(v.metadata->configuration == "layer.height = 0.2\n");
    CHECK(v.metadata->thumbnails.size() == 1);
    CHECK(to_text(v, "a.lyr").starts_with("a.lyr: .lyr 1."));
}

TEST_CASE("verify 1 and 2: whatever bit is flipped, its block is found, and no other") {
    const FileBytes file = small_file();
    const std::vector<Extent> blocks = extents(file);
    FileBytes damaged = file;
    for (std::size_t at = 0; at < file.size(); ++at) {
        const Extent block = around(blocks, at);
        for (int bit = 0; bit < 8; ++bit) {
            damaged[at] ^= static_cast<std::byte>(1 << bit);
            const Verification v = verify(damaged);
            damaged[at] = file[at];
            INFO("byte " << at << " bit " << bit);
            REQUIRE(v.findings.size() == 1);
            CHECK(v.findings[0].begin == block.begin);
            CHECK(v.findings[0].end == block.end);
            // What may be skipped has no number: it is what its type says.
            const bool told = at != block.begin || !block.skippable;
            if (told) CHECK_MESSAGE(v.findings[0].what.starts_with(block.name), v.findings[0].what);
            Numbers whole{1, 2, 3};
            if (block.layer > 0) whole.erase(whole.begin() + block.layer - 1);
            CHECK(whole_layers(v) == whole);
            CHECK(v.whole_from_start == (block.layer > 0 ? block.layer - 1u : 3u));
        }
    }
}

TEST_CASE("verify 2: two blocks that are damaged are two findings, neighbours or not") {
    const FileBytes file = small_file();
    const std::vector<Extent> blocks = extents(file);
    for (std::size_t a = 0; a < blocks.size(); ++a) {
        for (std::size_t b = a + 1; b < blocks.size(); ++b) {
            FileBytes damaged = file;
            damaged[blocks[a].begin + 6] ^= std::byte{4};
            damaged[blocks[b].begin + 6] ^= std::byte{4};
            const Verification v = verify(damaged);
            INFO("blocks " << blocks[a].name << " and " << blocks[b].name);
            // Of neighbours only the second one's end shows where the first one ends.
            if (b == a + 1 && a > 0) {
                REQUIRE(!v.findings.empty());
                CHECK(v.findings.front().begin == blocks[a].begin);
                CHECK(v.findings.back().end == blocks[b].end);
                continue;
            }
            REQUIRE(v.findings.size() == 2);
            CHECK(v.findings[0].begin == blocks[a].begin);
            CHECK(v.findings[1].begin == blocks[b].begin);
            CHECK_MESSAGE(v.findings[0].what.starts_with(blocks[a].name), v.findings[0].what);
            // Without the layer's own block nobody knows how many chunks it has.
            const bool told = blocks[a].layer != blocks[b].layer || blocks[b].layer == 0;
            CHECK_MESSAGE(v.findings[1].what.starts_with(told ? blocks[b].name : "a chunk"),
                          v.findings[1].what);
        }
    }
}

TEST_CASE("verify 1 and 3: wherever it is cut, that is found, and the layers in front are whole") {
    const FileBytes file = small_file();
    const std::vector<Extent> blocks = extents(file);
    for (std::size_t size = 0; size < file.size(); ++size) {
        const FileBytes cut(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size));
        INFO("cut at byte " << size);
        const Verification v = verify(cut);
        REQUIRE(!v.findings.empty());
        CHECK(read_bytes(cut).error.has_value());
        std::uint32_t whole = 0;
        for (const Extent& block : blocks)
            if (block.ends_layer && block.end <= size) ++whole;
        CHECK(v.whole_from_start == whole);
        if (size < 16) continue;
        CHECK(v.cut_short);
        const Extent block = around(blocks, size);
        CHECK(v.findings.back().what ==
              "the file is cut short: " + (block.skippable ? "layer 1" : block.name) +
                  " is due here");
        CHECK(v.findings.back().end == size);
    }
}

TEST_CASE("verify 1: it refuses what the reader refuses, on any byte with a right CRC") {
    const FileBytes file = small_file();
    const std::vector<Block> blocks = split(file);
    std::mt19937 random(5);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        for (std::size_t at = 0; at < blocks[i].payload.size(); ++at) {
            for (int turn = 0; turn < 3; ++turn) {
                auto changed = blocks;
                changed[i].payload[at] ^= static_cast<std::byte>(1 + random() % 255);
                INFO("block " << i << " byte " << at);
                REQUIRE(difference(join(file, changed)) == "");
            }
        }
    }
}

TEST_CASE("verify 1: blocks that are missing, doubled, swapped or of another type") {
    const FileBytes file = small_file();
    const std::vector<Block> blocks = split(file);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        INFO("block " << i);
        auto changed = blocks;
        changed.erase(changed.begin() + static_cast<std::ptrdiff_t>(i));
        CHECK(difference(join(file, changed)) == "");
        changed = blocks;
        changed.insert(changed.begin() + static_cast<std::ptrdiff_t>(i), blocks[i]);
        CHECK(difference(join(file, changed)) == "");
        for (const int type : {0x00, 0x06, 0x47, 0x80, 0x81, 0x82, 0xff, 1, 2, 3, 4, 5}) {
            changed = blocks;
            changed[i].type = static_cast<std::uint8_t>(type);
            INFO("type " << type);
            CHECK(difference(join(file, changed)) == "");
        }
        if (i == 0) continue;
        changed = blocks;
        std::swap(changed[i], changed[i - 1]);
        CHECK(difference(join(file, changed)) == "");
    }
}

TEST_CASE("verify 2: what is missing without a trace is named") {
    const FileBytes file = small_file();
    const std::vector<Block> blocks = split(file);
    const auto found_without = [&](std::size_t first, std::size_t count) {
        auto changed = blocks;
        changed.erase(changed.begin() + static_cast<std::ptrdiff_t>(first),
                      changed.begin() + static_cast<std::ptrdiff_t>(first + count));
        const Verification v = verify(join(file, changed));
        REQUIRE(v.findings.size() == 1);
        return v.findings[0].what;
    };
    // Metadata, configuration, thumbnail; layer 1 and its chunk; layer 2 and two chunks; layer 3.
    CHECK(found_without(3, 2) == "layer 1 is missing");
    CHECK(found_without(5, 1) == "the beginning of layer 2 is missing");
    CHECK(found_without(6, 1) == "chunk 1 of layer 2 is missing");
    CHECK(found_without(6, 2) == "the rest of layer 2 is missing");
    CHECK(found_without(3, 5) == "layers 1 to 2 are missing");
    CHECK(found_without(10, 1) == "the index is missing");
}

TEST_CASE("verify: what is no .lyr file, or of another version, is said once") {
    const auto only = [](const FileBytes& bytes) {
        const Verification v = verify(bytes);
        REQUIRE(v.findings.size() == 1);
        return v.findings[0];
    };
    CHECK(only({}).what == "the file is empty");
    CHECK(only(FileBytes(5000, std::byte{2})).what.starts_with("this is not a .lyr file"));
    FileBytes newer = small_file();
    newer[4] = std::byte{2};
    const std::uint32_t crc = crc32c(std::span<const std::byte>(newer).first(12));
    for (std::size_t i = 0; i < 4; ++i)
        newer[12 + i] = static_cast<std::byte>(crc >> (8 * i) & 0xff);
    CHECK(only(newer).status == ExitStatus::unsupported);
}

TEST_CASE("verify: random bytes behind the prologue neither crash nor hang, nor are they whole") {
    std::mt19937 random(11);
    FileBytes file = small_file();
    file.resize(40000);
    for (int turn = 0; turn < 20; ++turn) {
        for (std::size_t i = 16; i < file.size(); ++i)
            file[i] = static_cast<std::byte>(random() % (turn % 2 ? 256 : 6));
        const Verification v = verify(file);
        CHECK(!v.findings.empty());
        CHECK(v.layers.empty());
    }
}

TEST_CASE(
    "verify: a file on disk is found to be what its bytes in memory are, and what is gone is "
    "said") {
    const FileBytes file = small_file();
    const std::string path = scratch("viewed");
    std::mt19937 random(8);
    for (int turn = 0; turn < 40; ++turn) {
        FileBytes damaged = file;
        // Bytes that nobody knows, so that the file is larger than the window.
        if (turn % 2) damaged.insert(damaged.end() - 44, 2 * FileView::window_bytes, std::byte{0});
        damaged[random() % damaged.size()] ^= std::byte{4};
        save(damaged, path);
        auto view = FileView::open(path);
        REQUIRE(view.ok());
        CHECK(to_text(verify(*view), "") == to_text(verify(damaged), ""));
        CHECK_FALSE(view->error());
    }
    auto view = FileView::open(path);
    REQUIRE(view.ok());
    std::filesystem::resize_file(path, 100);
    CHECK_FALSE(verify(*view).findings.empty());
    REQUIRE(view->error());
    CHECK(view->error()->message.find("shorter") != std::string::npos);
    CHECK_FALSE(FileView::open(path + ".missing").ok());
    CHECK_FALSE(FileView::open(LYR_BUILD).ok());
}
