// Points told apart by their exact coordinates: numbers 0, 1, 2... in the order in which they are first met.

#pragma once

#include <bit>
#include <cstdint>
#include <unordered_map>

#include "kernel/geometry/vector.h"

namespace lyr {

// Three words as a key: Fibonacci hashing, by multiples of the golden ratio, spreads what differs in few bits.
struct TripleKey {
    std::uint64_t a, b, c;
    bool operator==(const TripleKey&) const = default;

    struct Hash {
        std::size_t operator()(const TripleKey& key) const {
            constexpr std::uint64_t golden = 0x9E3779B97F4A7C15;
            std::uint64_t h = key.a * golden;
            h = (std::rotl(h, 29) ^ key.b) * golden;
            h = (std::rotl(h, 29) ^ key.c) * golden;
            return static_cast<std::size_t>(h ^ (h >> 32));
        }
    };
};

class PointTable {
public:
    // The same number for the same coordinates (0 and -0 are the same).
    std::uint32_t number_of(const Point3& point) {
        const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value + 0.0); };
        const TripleKey key{bits(point.x()), bits(point.y()), bits(point.z())};
        return numbers_.emplace(key, static_cast<std::uint32_t>(numbers_.size())).first->second;
    }

private:
    std::unordered_map<TripleKey, std::uint32_t, TripleKey::Hash> numbers_;
};

}  // namespace lyr
