// Prints of more than 4 GiB: places in them do not fit a 32-bit board's numbers.

#include <doctest/doctest.h>

#include <algorithm>

#include "format/check/file_view.h"
#include "format/small_file.h"

using namespace lyr;
using namespace lyr::format;
using namespace lyr::format::test;

namespace {

constexpr std::uint64_t hole_bytes = std::uint64_t{5} << 30;

void add_hole(FileBytes& numbers, std::size_t begin) {
    for (std::size_t i = begin; i < numbers.size(); i += 8) {
        FileBytes moved;
        put_little(moved, get_little(numbers, i, 8) + hole_bytes, 8);
        std::copy(moved.begin(), moved.end(), numbers.begin() + static_cast<std::ptrdiff_t>(i));
    }
}

// The small file with nothing, and nothing on the disk, between its first layer and the others.
class LargeFile {
public:
    LargeFile() {
        const FileBytes small = small_file();
        FileBytes head(small.begin(), small.begin() + 16);
        int layer = 0;
        for (Block block : split(small)) {
            layer += block.type == 2;
            if (block.type == 4) add_hole(block.payload, 8);
            if (block.type == 5) add_hole(block.payload, 20);  // its size, the place of its index
            put_block(layer < 2 ? head : layers, block);
        }
        layers_at = head.size() + hole_bytes;
        std::ofstream file(path, std::ios::binary | std::ios::trunc);
        const auto put = [&](const FileBytes& bytes) {
            file.write(reinterpret_cast<const char*>(bytes.data()),
                       static_cast<std::streamsize>(bytes.size()));
        };
        put(head);
        file.seekp(static_cast<std::streamoff>(layers_at));
        put(layers);
        REQUIRE(file.flush());
    }
    ~LargeFile() { std::filesystem::remove(path); }
    LargeFile(const LargeFile&) = delete;
    LargeFile& operator=(const LargeFile&) = delete;

    const std::string path = scratch("large");
    FileBytes layers;  // and what follows them
    std::uint64_t layers_at = 0;
};

}  // namespace

TEST_CASE("reader: a print of more than 4 GiB can be taken up at any layer") {
    const LargeFile file;
    const Reading small = read_bytes(small_file());
    auto reader = Reader::open(file.path);
    REQUIRE(reader.ok());
    for (const std::uint32_t layer : {2u, 1u, 2u}) {
        REQUIRE(reader->seek_layer(layer).ok());
        auto expected =
            std::find_if(small.given.begin(), small.given.end(), [&](const Given& given) {
                const auto* start = std::get_if<LayerStart>(&given.operation);
                return start && start->index == layer;
            });
        for (; const Operation* operation = reader->read(); ++expected) {
            REQUIRE(expected != small.given.end());
            REQUIRE(*operation == expected->operation);
            REQUIRE(reader->position().offset == expected->position.offset + hole_bytes);
        }
        CHECK(!reader->error());
        CHECK(expected == small.given.end());
    }
}

TEST_CASE("file view 1: of a file of more than 4 GiB each byte is in its place") {
    const LargeFile file;
    auto view = FileView::open(file.path);
    REQUIRE(view.ok());
    CHECK(view->size() == file.layers_at + file.layers.size());
    const auto bytes = view->at(file.layers_at, file.layers.size() + 1);
    CHECK(std::equal(bytes.begin(), bytes.end(), file.layers.begin(), file.layers.end()));
    CHECK(view->at(file.layers_at - 8, 8)[0] == std::byte{0});
    CHECK(!view->error());
}
