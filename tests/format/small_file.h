// A print to be damaged.

#pragma once

#include <doctest/doctest.h>

#include "files.h"
#include "worked_example.h"

namespace lyr::format::test {

// Small, but with every kind of block, three layers and a layer of two chunks.
inline FileBytes small_file() {
    const Quantum quantum{1000};
    Metadata metadata;
    metadata.source_name = "part.step";
    metadata.configuration = "layer.height = 0.2\n";
    metadata.thumbnails.push_back({2, 1, {std::byte{1}, std::byte{2}, std::byte{3}}});
    std::vector<EncodedLayer> layers;
    for (int i = 0; i < 3; ++i) {
        auto layer = worked_layer(quantum);
        REQUIRE(layer.ok());
        layers.push_back(*layer);
    }
    // The travel behind the retraction is a chunk boundary as good as any.
    EncodedLayer& two = layers[1];
    const std::size_t cut = 0x127 - 0x109;
    two.chunks = {{0, cut, 5}, {cut, two.bytes.size(), 18}};
    two.totals.chunks = 2;
    const std::string path = scratch("small");
    write_layers(path, quantum, metadata, layers);
    return load(path);
}

}  // namespace lyr::format::test
