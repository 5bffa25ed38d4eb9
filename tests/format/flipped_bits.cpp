// Flips random bits of a large print, one at a time, and lets both readers read it: the flipped bit must be
// found before an operation of its block is given out, and nothing else may be given out in its place.
//
//     flipped_bits <print> [flips, 1000000]
//
// A reader that starts at the file's first byte gives out the same until it comes to the block of the flipped
// bit, whatever follows. So each turn begins at the layer in front of it: in C by going on from a copy of the
// reader as it was there, in C++ by going to that layer. Bits of the index and of the end block, and a
// thousand others, are read from the first byte on.

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

#include "c_reader.h"
#include "format/bytes.h"
#include "format/layout.h"

namespace {

using namespace lyr::format;
using lyr::format::test::CReader;
using lyr::format::test::Memory;

constexpr int read_as_a_whole = 1000;

struct Extent {
    std::size_t begin = 0, end = 0;
    int start =
        -1;  // the layer (from 0) that a reader may start at to come to this block; -1: the file's begin
    bool in_index = false;
};

// The print in memory that read(2) sees, too.
class Print {
public:
    explicit Print(const std::vector<char>& bytes)
        : size(bytes.size()), descriptor_(::memfd_create("lyr", MFD_CLOEXEC)) {
        if (::write(descriptor_, bytes.data(), size) != static_cast<ssize_t>(size)) std::abort();
        void* map = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_, 0);
        if (map == MAP_FAILED) std::abort();
        data = static_cast<std::byte*>(map);
    }
    std::span<const std::byte> bytes() const { return {data, size}; }
    lyr::Result<Reader> open() const {
        ::lseek(descriptor_, 0, SEEK_SET);
        return Reader::from_descriptor(::dup(descriptor_), "print");
    }

    std::byte* data;
    std::size_t size;

private:
    int descriptor_;
};

// What the undamaged print gives out, and where each layer begins in it.
struct Reference {
    std::vector<Operation> operations;
    std::vector<ReadPosition> positions;
    std::vector<lyr_operation> c_operations;
    std::vector<std::size_t> layers;    // number of its first operation
    std::vector<lyr_reader> c_readers;  // as they were behind it
    std::vector<Extent> blocks;
};

std::vector<Extent> blocks_of(std::span<const std::byte> bytes) {
    std::vector<Extent> blocks{{0, prologue_bytes}};
    int layer = -1;
    while (blocks.back().end < bytes.size()) {
        const std::size_t begin = blocks.back().end;
        const std::uint32_t head = get_u32(bytes.data() + begin);
        const auto type = static_cast<BlockType>(head & 0xff);
        const int before = layer;
        if (type == BlockType::layer) ++layer;
        const bool in_index = type == BlockType::index || type == BlockType::end;
        const int start = type == BlockType::layer ? before : in_index ? -1 : layer;
        blocks.push_back({begin, begin + block_frame_bytes + (head >> 8), start, in_index});
    }
    return blocks;
}

bool same(const lyr_operation& a, const lyr_operation& b) {
    return a.kind == b.kind && a.offset == b.offset && a.to.x == b.to.x && a.to.y == b.to.y &&
           a.to.z == b.to.z && a.from.x == b.from.x && a.from.y == b.from.y &&
           a.sagitta == b.sagitta && a.value == b.value && a.number == b.number;
}

Reference read_whole(const Print& print) {
    Reference out;
    auto reader = print.open();
    Memory memory{print.bytes()};
    CReader c(memory);
    if (!reader.ok() || !c.open()) std::exit(2);
    while (const Operation* operation = reader->read()) {
        if (!lyr_next(&c.reader, &c.operation)) std::exit(2);
        if (c.operation.kind == LYR_LAYER) {
            out.layers.push_back(out.operations.size());
            out.c_readers.push_back(c.reader);
        }
        out.operations.push_back(*operation);
        out.positions.push_back(reader->position());
        out.c_operations.push_back(c.operation);
    }
    if (reader->error() || lyr_next(&c.reader, &c.operation) || c.reader.status != LYR_END)
        std::exit(2);
    out.blocks = blocks_of(print.bytes());
    return out;
}

class Turn {
public:
    Turn(const Print& print, const Reference& reference, const Extent& block, bool whole)
        : print_(print), reference_(reference), block_(block), start_(whole ? -1 : block.start) {}

    bool found_in_c(CReader& c, Memory& memory) const {
        std::size_t next = 0;
        if (start_ < 0) {
            memory.at = 0;
            if (!c.open()) return true;
        } else {
            // As it was behind the layer's own block.
            c.reader = reference_.c_readers[static_cast<std::size_t>(start_)];
            next = reference_.layers[static_cast<std::size_t>(start_)] + 1;
            memory.at = static_cast<std::size_t>(c.reader.behind);
            c.reader.source.user = &memory;
            c.reader.buffer = reinterpret_cast<std::uint8_t*>(c.buffer.data());
        }
        for (; lyr_next(&c.reader, &c.operation); ++next)
            if (!is_due(next) || !same(c.operation, reference_.c_operations[next])) return false;
        return !is_due(next) && c.reader.status != LYR_END;
    }

    bool found_in_cpp() const {
        auto reader = print_.open();
        if (!reader.ok()) return true;
        std::size_t next = 0;
        if (start_ >= 0) {
            if (!reader->seek_layer(static_cast<std::uint32_t>(start_))) return false;
            next = reference_.layers[static_cast<std::size_t>(start_)];
        }
        for (; const Operation* operation = reader->read(); ++next)
            if (!is_due(next) || !(*operation == reference_.operations[next])) return false;
        return !is_due(next) && reader->error().has_value();
    }

private:
    // It stands in front of the damaged block.
    bool is_due(std::size_t operation) const {
        return operation < reference_.positions.size() &&
               reference_.positions[operation].end <= block_.begin;
    }

    const Print& print_;
    const Reference& reference_;
    const Extent& block_;
    int start_;
};

}  // namespace

int main(int count, char** arguments) {
    if (count < 2) return std::fputs("flipped_bits <print> [flips]\n", stderr), 2;
    std::ifstream file(arguments[1], std::ios::binary);
    const Print print(std::vector<char>(std::istreambuf_iterator<char>(file), {}));
    const int flips = count > 2 ? std::atoi(arguments[2]) : 1'000'000;
    const Reference reference = read_whole(print);
    Memory memory{print.bytes()};
    CReader c(memory);
    std::mt19937_64 random(20'261'127);
    const auto begin = std::chrono::steady_clock::now();
    int missed = 0;
    for (int i = 0; i < flips; ++i) {
        const std::size_t at = random() % print.size;
        const auto bit = static_cast<std::byte>(1 << random() % 8);
        const auto behind =
            std::upper_bound(reference.blocks.begin(), reference.blocks.end(), at,
                             [](std::size_t a, const Extent& b) { return a < b.end; });
        const Turn turn(print, reference, *behind, i < read_as_a_whole);
        print.data[at] ^= bit;
        const bool in_c = turn.found_in_c(c, memory), in_cpp = turn.found_in_cpp();
        print.data[at] ^= bit;
        if (in_c && in_cpp) continue;
        ++missed;
        std::printf("byte %zu, mask %d: missed%s%s\n", at, static_cast<int>(bit),
                    in_c ? "" : " in C", in_cpp ? "" : " in C++");
    }
    const std::chrono::duration<double> time_s = std::chrono::steady_clock::now() - begin;
    std::printf("%d random bits of %zu bytes, %zu operations: %d missed (%.0f s)\n", flips,
                print.size, reference.operations.size(), missed, time_s.count());
    return missed > 0;
}
