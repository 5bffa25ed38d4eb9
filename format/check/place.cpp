// Numbers of layers and chunks count from 1 in names, as people count.

#include "format/check/place.h"

#include <algorithm>

namespace lyr::format {
namespace {

// "layer 3 is", "layers 3 to 5 are"
std::string numbered(const std::string& noun, std::uint64_t first, std::uint64_t last,
                     const std::string& of = "") {
    if (first == last) return noun + ' ' + std::to_string(first) + of + " is";
    return noun + "s " + std::to_string(first) + " to " + std::to_string(last) + of + " are";
}

std::string of_layer(std::uint64_t layer) {
    return " of layer " + std::to_string(layer + 1);
}

}  // namespace

PrintPlace behind(const PrintPlace& place, std::uint64_t chunks_of_layer,
                  std::optional<std::uint32_t> layers) {
    if (place == index_place) return end_place;
    if (place.layer == index_place.layer) return nothing_place;
    const bool more_chunks = !place.front && place.part < chunks_of_layer;
    if (more_chunks) return {place.layer, place.part + 1};
    const std::uint64_t next = place.front ? 0 : place.layer + 1;
    return layers && next == *layers ? index_place : PrintPlace{next, 0};
}

std::string name_of(const PrintPlace& place) {
    if (place.front) return "the metadata";
    if (place == index_place) return "the index";
    if (place.layer == index_place.layer) return "the end block";
    if (place.part == 0) return "layer " + std::to_string(place.layer + 1);
    return "chunk " + std::to_string(place.part) + of_layer(place.layer);
}

std::string name_of_range(const PrintPlace& from, const PrintPlace& to,
                          std::optional<std::uint32_t> layers) {
    if (!(from < to)) return "";
    if (from.front) return "the metadata is";
    if (from == index_place) return "the index is";
    if (from.layer == to.layer) {
        if (from.part > 0) return numbered("chunk", from.part, to.part - 1, of_layer(to.layer));
        return "the beginning" + of_layer(to.layer) + " is";
    }
    // Layers that are missing as a whole, and the rest of the one that was begun.
    const bool to_layers = to.layer < index_place.layer;
    if (!to_layers && !layers)
        return from.part > 0 ? "the rest" + of_layer(from.layer) + " is" : "";
    const std::uint64_t last = to_layers ? to.layer + (to.part > 0) : *layers;
    if (from.part > 0 && last == from.layer + 1) return "the rest" + of_layer(from.layer) + " is";
    if (last <= from.layer) return "";
    const std::string whole = numbered("layer", from.layer + 1, last);
    return from.part > 0 ? "(in part) " + whole : whole;
}

}  // namespace lyr::format
