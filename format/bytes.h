// Numbers as bytes: little-endian of fixed width, and varints (seven bits a byte, low ones first,
// bit 7 set on all but the last byte), signed ones in zig-zag order 0, -1, 1, -2, 2, ...
//
// Contract
//  1. A Cursor never reads outside its bytes. What is not there, or does not fit 64 bits, makes it
//     bad for good and reads as 0.
//  2. A varint of at most 10 bytes is read; longer than necessary is allowed.

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lyr::format {

inline std::uint32_t get_u32(const std::byte* at) {
    return static_cast<std::uint32_t>(at[0]) | static_cast<std::uint32_t>(at[1]) << 8 |
           static_cast<std::uint32_t>(at[2]) << 16 | static_cast<std::uint32_t>(at[3]) << 24;
}

inline std::uint64_t get_u64(const std::byte* at) {
    return get_u32(at) | static_cast<std::uint64_t>(get_u32(at + 4)) << 32;
}

inline constexpr std::size_t longest_varint = 10;

inline std::uint64_t zigzag(std::int64_t value) {
    return (static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63);
}

inline std::int64_t unzigzag(std::uint64_t value) {
    return static_cast<std::int64_t>((value >> 1) ^ (0 - (value & 1)));
}

class Cursor {
public:
    Cursor() = default;
    explicit Cursor(std::span<const std::byte> bytes)
        : begin_(bytes.data()), at_(bytes.data()), end_(bytes.data() + bytes.size()) {}

    bool bad() const { return bad_; }
    bool at_end() const { return at_ == end_; }
    std::size_t left() const { return static_cast<std::size_t>(end_ - at_); }
    std::size_t offset() const { return static_cast<std::size_t>(at_ - begin_); }

    std::uint8_t byte() {
        if (at_ == end_) return fail();
        return static_cast<std::uint8_t>(*at_++);
    }

    // Nearly all numbers have one byte or two.
    std::uint64_t varint() {
        if (end_ - at_ < 2) return long_varint();
        const auto first = static_cast<std::uint64_t>(at_[0]);
        const auto second = static_cast<std::uint64_t>(at_[1]);
        if (first < 0x80) {
            ++at_;
            return first;
        }
        if (second >= 0x80) return long_varint();
        at_ += 2;
        return (first & 0x7f) | second << 7;
    }

    std::int64_t signed_varint() { return unzigzag(varint()); }

    void skip(std::uint64_t count) {
        if (count > left())
            fail();
        else
            at_ += count;
    }

private:
    std::uint8_t fail() {
        bad_ = true;
        at_ = end_;
        return 0;
    }

    std::uint64_t long_varint() {
        std::uint64_t value = 0;
        for (unsigned shift = 0; shift < 64 && at_ != end_; shift += 7) {
            const auto next = static_cast<std::uint8_t>(*at_++);
            // The tenth byte has room for one bit only.
            if (shift == 63 && next > 1) break;
            value |= static_cast<std::uint64_t>(next & 0x7f) << shift;
            if (next < 0x80) return value;
        }
        return fail();
    }

    const std::byte* begin_ = nullptr;
    const std::byte* at_ = nullptr;
    const std::byte* end_ = nullptr;
    bool bad_ = false;
};

using Bytes = std::vector<std::byte>;

inline void put_byte(Bytes& out, std::uint64_t value) {
    out.push_back(static_cast<std::byte>(value & 0xff));
}

inline void put_u32(Bytes& out, std::uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8) put_byte(out, value >> shift);
}

inline void put_u64(Bytes& out, std::uint64_t value) {
    for (int shift = 0; shift < 64; shift += 8) put_byte(out, value >> shift);
}

inline void put_varint(Bytes& out, std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) put_byte(out, value | 0x80);
    put_byte(out, value);
}

inline void put_signed(Bytes& out, std::int64_t value) {
    put_varint(out, zigzag(value));
}

}  // namespace lyr::format
