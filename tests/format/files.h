// Files of the format's tests: as bytes, as what a reader gives out of them, and taken apart into
// blocks by code that the room does not use.

#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "format/bytes.h"
#include "format/crc32c.h"
#include "format/layer_record.h"
#include "format/reader.h"
#include "format/writer.h"
#include "scratch.h"

namespace lyr::format::test {

using FileBytes = std::vector<std::byte>;

inline constexpr Quantum micrometres{1000};
inline constexpr PathStyle wall_style{.role = Role::outer_wall, .width_mm = 0.45, .height_mm = 0.2};

// A path for one test's file.
inline std::string scratch(const std::string& name) {
    return tests::scratch(name + ".lyr");
}

inline FileBytes load(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    FileBytes bytes;
    for (auto at = std::istreambuf_iterator<char>(file); at != std::istreambuf_iterator<char>();
         ++at)
        bytes.push_back(static_cast<std::byte>(*at));
    return bytes;
}

inline void save(const FileBytes& bytes, const std::string& path) {
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
}

struct Given {
    Operation operation;
    ReadPosition position;
};

// What a reader gives out, and the error that ended it.
struct Reading {
    std::vector<Given> given;
    std::optional<Diagnostic> error;
    bool opened = false;
};

inline Reading read_all(Result<Reader> reader) {
    Reading reading;
    reading.opened = reader.ok();
    if (!reader) {
        reading.error = reader.error();
        return reading;
    }
    while (const Operation* operation = reader->read())
        reading.given.push_back({*operation, reader->position()});
    reading.error = reader->error();
    return reading;
}

inline Reading read_file(const std::string& path) {
    return read_all(Reader::open(path));
}

// A file of these bytes that is on no disk.
inline Result<Reader> open_bytes(std::span<const std::byte> bytes, ReadOptions options = {}) {
    const int descriptor = ::memfd_create("lyr", MFD_CLOEXEC);
    REQUIRE(::write(descriptor, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()));
    REQUIRE(::lseek(descriptor, 0, SEEK_SET) == 0);
    return Reader::from_descriptor(descriptor, "a file in memory", options);
}

inline Reading read_bytes(std::span<const std::byte> bytes) {
    return read_all(open_bytes(bytes));
}

// A block, and a file as a list of them.
struct Block {
    std::uint8_t type = 0;
    FileBytes payload;
};

inline void put_little(FileBytes& out, std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i)
        out.push_back(static_cast<std::byte>((value >> (8 * i)) & 0xff));
}

inline std::uint64_t get_little(const FileBytes& bytes, std::size_t at, int count) {
    std::uint64_t value = 0;
    for (int i = 0; i < count; ++i)
        value |= std::to_integer<std::uint64_t>(bytes[at + static_cast<std::size_t>(i)]) << (8 * i);
    return value;
}

inline std::vector<Block> split(const FileBytes& file) {
    std::vector<Block> blocks;
    for (std::size_t at = 16; at < file.size();) {
        const auto length = static_cast<std::size_t>(get_little(file, at + 1, 3));
        const auto begin = file.begin() + static_cast<std::ptrdiff_t>(at + 4);
        blocks.push_back({std::to_integer<std::uint8_t>(file[at]),
                          {begin, begin + static_cast<std::ptrdiff_t>(length)}});
        at += length + 8;
    }
    return blocks;
}

inline void put_block(FileBytes& out, const Block& block) {
    const std::size_t begin = out.size();
    out.push_back(static_cast<std::byte>(block.type));
    put_little(out, block.payload.size(), 3);
    out.insert(out.end(), block.payload.begin(), block.payload.end());
    put_little(out, crc32c(std::span<const std::byte>(out).subspan(begin)), 4);
}

// With the offsets in index and end set right; the counts stay as they are.
inline FileBytes join(const FileBytes& prologue_of, const std::vector<Block>& blocks) {
    FileBytes out(prologue_of.begin(), prologue_of.begin() + 16);
    std::vector<std::size_t> layers;
    std::size_t index_at = 0;
    for (const Block& block : blocks) {
        Block fixed = block;
        if (block.type == 2) layers.push_back(out.size());
        if (block.type == 4) {
            index_at = out.size();
            fixed.payload.clear();
            for (const std::size_t layer : layers) put_little(fixed.payload, layer, 8);
        }
        if (block.type == 5 && block.payload.size() == 36) {
            fixed.payload.resize(20);
            put_little(fixed.payload, out.size() + 44, 8);
            put_little(fixed.payload, index_at, 8);
        }
        put_block(out, fixed);
    }
    return out;
}

// A file of layers that were encoded by the caller.
inline void write_layers(const std::string& path, Quantum quantum, const Metadata& metadata,
                         const std::vector<EncodedLayer>& layers) {
    auto writer = Writer::create(path, quantum, metadata);
    REQUIRE_MESSAGE(writer.ok(), to_string(writer.error()));
    for (const EncodedLayer& layer : layers) REQUIRE(writer->append(layer).ok());
    const auto totals = writer->finish();
    REQUIRE_MESSAGE(totals.ok(), to_string(totals.error()));
    CHECK(totals->bytes == std::filesystem::file_size(path));
}

// A file of one layer and chunk with operations that no encoder made.
inline FileBytes raw_file(const FileBytes& operations, std::uint32_t count) {
    FileBytes prologue{std::byte{'L'}, std::byte{'Y'}, std::byte{'R'}, std::byte{0x1a}};
    put_little(prologue, 1, 4);
    put_little(prologue, 1000, 4);
    put_little(prologue, crc32c(prologue), 4);
    LayerRecord record;
    record.layer.totals.chunks = 1;
    record.layer.totals.operations = count;
    Block layer{2, {}}, chunk{3, {}}, end{5, {}};
    encode_layer(record, layer.payload);
    put_varint(chunk.payload, 0);
    put_varint(chunk.payload, 0);
    put_varint(chunk.payload, count);
    chunk.payload.insert(chunk.payload.end(), operations.begin(), operations.end());
    put_little(end.payload, 1, 4);
    put_little(end.payload, 1, 8);
    put_little(end.payload, count, 8);
    end.payload.resize(36);  // join() has the rest
    return join(prologue, {{1, {}}, layer, chunk, {4, {}}, end});
}

}  // namespace lyr::format::test
