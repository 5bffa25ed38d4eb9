// Places of a print: the metadata, each layer's block and its chunks, the index, the end block; and what
// lies between two of them.

#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>

namespace lyr::format {

// part 0: the layer's own block; 1, 2, ...: its chunks. What stands in front of the layers is `front`.
struct PrintPlace {
    std::uint64_t layer = 0, part = 0;
    bool front = false;
    friend bool operator==(const PrintPlace&, const PrintPlace&) = default;
    friend bool operator<(const PrintPlace& a, const PrintPlace& b) {
        if (a.front != b.front) return a.front;
        return a.layer != b.layer ? a.layer < b.layer : a.part < b.part;
    }
};

// Layers have 32 bits.
inline constexpr PrintPlace metadata_place{0, 0, true}, index_place{std::uint64_t{1} << 33, 0},
    end_place{std::uint64_t{1} << 33, 1}, nothing_place{std::uint64_t{1} << 33, 2};
inline constexpr std::uint64_t unknown_chunks = UINT64_MAX;

// What follows in a print whose layer has so many chunks. Without the number of layers the index is
// never due, with it behind the last one.
PrintPlace behind(const PrintPlace& place, std::uint64_t chunks_of_layer,
                  std::optional<std::uint32_t> layers);

// "layer 3", "chunk 2 of layer 3", "the index".
std::string name_of(const PrintPlace& place);

// What is from one place to in front of another: "chunks 2 to 4 of layer 7 are"; empty: nothing known.
std::string name_of_range(const PrintPlace& from, const PrintPlace& to,
                          std::optional<std::uint32_t> layers);

}  // namespace lyr::format
