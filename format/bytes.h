// Numbers as bytes: little-endian of fixed width, and varints (seven bits a byte, low ones first,
// bit 7 set on all but the last byte), signed ones in zig-zag order 0, -1, 1, -2, 2, ...
//
// Contract
//  1. A Cursor never reads outside its bytes. What is not there, or does not fit 64 bits, makes it
//     bad for good and reads as 0.
//  2. A varint of at most 10 bytes is read; longer than necessary is allowed.
//  3. Bits are taken from the low end of each byte. Behind bits, end_bits() goes on to the next whole byte.

#pragma once

#include <array>
#include <bit>
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

// A number of order k in bits: m zeros and a one, then its m + k low bits above the 2^k (2^m - 1) numbers that have
// fewer (Exp-Golomb codes). None of the file's needs more zeros.
inline constexpr unsigned most_prefix_zeros = 40, highest_order = 15;

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

    // Three signed numbers in bits, the last one of an order of its own (up to highest_order). Mostly they lie within the
    // bits of one look ahead.
    struct Three {
        std::int64_t x = 0, y = 0, z = 0;
    };
    Three bit_numbers(unsigned order, unsigned last_order) {
        if (left() < 8) return long_bit_numbers(order, last_order);
        Ahead ahead{get_u64(at_) >> bit_, 0};
        const std::uint64_t x = ahead.number(order), y = ahead.number(order);
        const std::uint64_t z = ahead.number(last_order);
        if (ahead.taken > fewest_peeked) return long_bit_numbers(order, last_order);
        pass(ahead.taken);
        return {unzigzag(x), unzigzag(y), unzigzag(z)};
    }
    // To the next whole byte.
    void end_bits() {
        if (bit_ > 0) ++at_;
        bit_ = 0;
    }

    void skip(std::uint64_t count) {
        if (count > left())
            fail();
        else
            at_ += count;
    }

private:
    static constexpr unsigned fewest_peeked = 57;

    std::uint8_t fail() {
        bad_ = true;
        at_ = end_;
        bit_ = 0;
        return 0;
    }

    static std::uint64_t ones(unsigned count) { return (std::uint64_t{1} << count) - 1; }

    struct Ahead {
        std::uint64_t bits = 0;
        unsigned taken = 0;  // more than there are: the numbers are none

        std::uint64_t number(unsigned order) {
            constexpr std::uint64_t end = std::uint64_t{1} << (fewest_peeked - 1);
            const auto zeros = static_cast<unsigned>(std::countr_zero(bits | end));
            const unsigned width = zeros + order;
            taken += zeros + 1 + width;
            const std::uint64_t top = std::uint64_t{1} << (width & 63);
            bits >>= zeros + 1;
            const std::uint64_t low = bits & (top - 1);
            bits >>= width & 63;
            return low + top - (std::uint64_t{1} << order);
        }
    };

    Three long_bit_numbers(unsigned order, unsigned last_order) {
        const std::uint64_t x = bit_number(order), y = bit_number(order);
        const std::uint64_t z = bit_number(last_order);
        return {unzigzag(x), unzigzag(y), unzigzag(z)};
    }

    std::uint64_t bit_number(unsigned order) {
        const auto zeros = static_cast<unsigned>(std::countr_zero(peek()));
        if (zeros > most_prefix_zeros) return fail();
        if (!take(zeros + 1)) return 0;
        const std::uint64_t low = peek() & ones(zeros + order);
        return take(zeros + order) ? (ones(zeros) << order) + low : 0;
    }

    // The bits ahead, at least 57; zeros behind the end.
    std::uint64_t peek() const {
        if (left() >= 8) return get_u64(at_) >> bit_;
        std::uint64_t ahead = 0;
        for (std::size_t i = left(); i > 0; --i)
            ahead = ahead << 8 | static_cast<std::uint64_t>(at_[i - 1]);
        return ahead >> bit_;
    }

    bool take(unsigned bits) {
        const unsigned behind = bit_ + bits;
        if (left() * 8 < behind) {
            fail();
            return false;
        }
        pass(bits);
        return true;
    }

    void pass(unsigned bits) {
        at_ += (bit_ + bits) / 8;
        bit_ = (bit_ + bits) % 8;
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
    unsigned bit_ = 0;  // of *at_ that are taken
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

// The bits of `number` in that order.
inline unsigned bit_count(std::uint64_t number, unsigned order) {
    const auto zeros = static_cast<unsigned>(std::bit_width((number >> order) + 1)) - 1;
    return 2 * zeros + 1 + order;
}

// Puts bits behind the bytes; the last byte is filled up with zeros.
class BitWriter {
public:
    explicit BitWriter(Bytes& out) : out_(out) {}

    void put_signed(std::int64_t value, unsigned order) {
        const std::uint64_t number = zigzag(value);
        const auto zeros = static_cast<unsigned>(std::bit_width((number >> order) + 1)) - 1;
        put(std::uint64_t{1} << zeros, zeros + 1);
        put(number - (((std::uint64_t{1} << zeros) - 1) << order), zeros + order);
    }

private:
    void put(std::uint64_t bits, unsigned count) {
        for (; count > 0;) {
            if (free_ == 0) put_byte(out_, 0), free_ = 8;
            const unsigned taken = count < free_ ? count : free_;
            const std::uint64_t low = bits & ((std::uint64_t{1} << taken) - 1);
            out_.back() |= static_cast<std::byte>(low << (8 - free_));
            bits >>= taken;
            count -= taken;
            free_ -= taken;
        }
    }

    Bytes& out_;
    unsigned free_ = 0;  // of the last byte's bits
};

}  // namespace lyr::format
