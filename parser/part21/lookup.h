// From #id to instance: an array where the ids lie close together, else a hash table.

#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "parser/part21/value.h"

namespace lyr::part21 {

class Lookup {
public:
    // Indexes ids[i] -> instance i. If an id occurs twice: the pair (earlier, later) of the first
    // later.
    struct Twice {
        InstanceIndex earlier, later;
    };
    std::optional<Twice> build(std::span<const std::uint64_t> ids);

    InstanceIndex find(std::uint64_t id, std::span<const std::uint64_t> ids) const;

private:
    std::size_t slot_of(std::uint64_t id, std::span<const std::uint64_t> ids) const;

    bool dense_ = true;
    std::uint64_t lowest_ = 0;
    std::vector<InstanceIndex> slots_;
};

}  // namespace lyr::part21
