// Open addressing with linear probing; see keywords.h.

#include "parser/part21/keywords.h"

#include <cstring>

#include "parser/part21/scan.h"

namespace lyr::part21 {
namespace {

constexpr std::size_t first_slots = 1024;

template <class Word>
std::uint64_t load(const char* p) {
    Word word;
    std::memcpy(&word, p, sizeof word);
    return word;
}

// Multiplication mixes upwards only, so the high half is folded down, twice: the slot depends on every bit, the last
// letter's too. The constant is 2^64 divided by the golden ratio, odd, with no pattern in its bits.
std::uint64_t mix(std::uint64_t hash, std::uint64_t word) {
    constexpr std::uint64_t factor = 0x9E3779B97F4A7C15u;
    hash = (hash ^ word) * factor;
    hash = (hash ^ (hash >> 32)) * factor;
    return hash ^ (hash >> 32);
}

// Whole words only, the last of which may overlap the one before: no load's size depends on the text.
std::uint64_t hash_of(std::string_view text) {
    std::uint64_t hash = text.size();
    const char* const last = text.data() + text.size();
    if (text.size() >= 8) {
        for (const char* p = text.data(); last - p > 8; p += 8)
            hash = mix(hash, load<std::uint64_t>(p));
        return mix(hash, load<std::uint64_t>(last - 8));
    }
    if (text.size() >= 4) {
        const std::uint64_t front = load<std::uint32_t>(text.data());
        return mix(hash, front << 32 | load<std::uint32_t>(last - 4));
    }
    for (const char c : text) hash = hash << 8 | static_cast<unsigned char>(c);
    return mix(hash, 0);
}

}  // namespace

Keywords::Keywords() : slots_(first_slots) {}

std::size_t Keywords::slot_of(std::string_view spelling) const {
    std::size_t slot = hash_of(spelling) & (slots_.size() - 1);
    while (!slots_[slot].spelling.empty() && slots_[slot].spelling != spelling) {
        slot = (slot + 1) & (slots_.size() - 1);
    }
    return slot;
}

void Keywords::insert(std::string_view spelling, KeywordId keyword) {
    if (2 * (used_ + 1) > slots_.size()) grow();
    slots_[slot_of(spelling)] = {spelling, keyword};
    ++used_;
}

void Keywords::grow() {
    std::vector<Slot> old(slots_.size() * 2);
    old.swap(slots_);
    for (const Slot& slot : old) {
        if (!slot.spelling.empty()) slots_[slot_of(slot.spelling)] = slot;
    }
}

KeywordId Keywords::find(std::string_view upper_case) const {
    return upper_case.empty() ? KeywordId() : slots_[slot_of(upper_case)].keyword;
}

KeywordId Keywords::intern(std::string_view spelling) {
    const KeywordId known = find(spelling);
    if (known.valid()) return known;
    std::string text = upper(spelling);
    KeywordId keyword = find(text);
    if (!keyword.valid()) {
        keyword = KeywordId(texts_.size());
        texts_.push_back(std::move(text));
        insert(texts_.back(), keyword);
    }
    if (!find(spelling).valid()) insert(spelling, keyword);
    return keyword;
}

}  // namespace lyr::part21
