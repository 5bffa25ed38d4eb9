// An index that says what it indexes: an EdgeId cannot be used where a FaceId is meant.

#pragma once

#include <compare>
#include <cstdint>

namespace lyr {

template <class Tag>
struct TypedIndex {
    static constexpr std::uint32_t none_value = 0xffffffffu;
    std::uint32_t value = none_value;

    constexpr TypedIndex() = default;
    constexpr explicit TypedIndex(std::size_t index) : value(static_cast<std::uint32_t>(index)) {}
    constexpr bool valid() const { return value != none_value; }
    constexpr auto operator<=>(const TypedIndex&) const = default;
};

}  // namespace lyr
