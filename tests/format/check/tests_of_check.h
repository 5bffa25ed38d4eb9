// The blocks of the small file, with the names that people read.

#pragma once

#include <string>
#include <vector>

#include "format/small_file.h"

namespace lyr::format::test {

struct Extent {
    std::size_t begin = 0, end = 0;
    std::string name;
    int layer = 0;  // from 1; 0: of none
    bool ends_layer = false, skippable = false;
};

inline std::vector<Extent> extents(const FileBytes& file) {
    const char* names[] = {
        "the metadata", "the configuration",  "a thumbnail",        "layer 1", "chunk 1 of layer 1",
        "layer 2",      "chunk 1 of layer 2", "chunk 2 of layer 2", "layer 3", "chunk 1 of layer 3",
        "the index",    "the end block"};
    const int layers[] = {0, 0, 0, 1, 1, 2, 2, 2, 3, 3, 0, 0};
    std::vector<Extent> all{{0, 16, "the prologue", 0, false, false}};
    std::size_t i = 0;
    for (const Block& block : split(file)) {
        const std::size_t begin = all.back().end, end = begin + block.payload.size() + 8;
        all.push_back(
            {begin, end, names[i], layers[i], i == 4 || i == 7 || i == 9, block.type >= 0x80});
        ++i;
    }
    return all;
}

inline Extent around(const std::vector<Extent>& all, std::size_t at) {
    for (const Extent& extent : all)
        if (at < extent.end) return extent;
    return {};
}

}  // namespace lyr::format::test
