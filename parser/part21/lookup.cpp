// See lookup.h.

#include "parser/part21/lookup.h"

#include <algorithm>
#include <bit>

namespace lyr::part21 {
namespace {

// Ids usually count up by 1 or 10. An array with up to 16 empty places for each instance costs
// less than a hash table costs time; `slack` lets small files have any numbering.
constexpr std::uint64_t spread = 16;
constexpr std::uint64_t slack = 4096;

// The finaliser of MurmurHash3: every bit of the id moves every bit of the result.
std::uint64_t mix(std::uint64_t id) {
    id = (id ^ (id >> 33)) * 0xFF51AFD7ED558CCDu;
    id = (id ^ (id >> 33)) * 0xC4CEB9FE1A85EC53u;
    return id ^ (id >> 33);
}

}  // namespace

std::size_t Lookup::slot_of(std::uint64_t id, std::span<const std::uint64_t> ids) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = mix(id) & mask;
    while (slots_[slot].valid() && ids[slots_[slot].value] != id) slot = (slot + 1) & mask;
    return slot;
}

std::optional<Lookup::Twice> Lookup::build(std::span<const std::uint64_t> ids) {
    if (ids.empty()) return std::nullopt;
    const auto [low, high] = std::minmax_element(ids.begin(), ids.end());
    lowest_ = *low;
    const std::uint64_t range = *high - *low;
    dense_ = range / spread <= ids.size() + slack / spread;
    slots_.assign(dense_ ? range + 1 : std::bit_ceil(2 * ids.size()), InstanceIndex());
    for (std::size_t i = 0; i < ids.size(); ++i) {
        InstanceIndex& slot = slots_[dense_ ? ids[i] - lowest_ : slot_of(ids[i], ids)];
        if (slot.valid()) return Twice{slot, InstanceIndex(i)};
        slot = InstanceIndex(i);
    }
    return std::nullopt;
}

InstanceIndex Lookup::find(std::uint64_t id, std::span<const std::uint64_t> ids) const {
    if (slots_.empty()) return {};
    if (!dense_) return slots_[slot_of(id, ids)];
    return id >= lowest_ && id - lowest_ < slots_.size() ? slots_[id - lowest_] : InstanceIndex();
}

}  // namespace lyr::part21
