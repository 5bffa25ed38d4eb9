// Eight bytes a step by eight tables (Kounavis and Berry, "A systematic approach to building high
// performance software-based CRC generators"): table k holds what a byte contributes after k
// more bytes, and contributions add up by exclusive or. Processors that know this very polynomial
// (SSE 4.2) are asked instead, eight bytes at a time.

#include "format/crc32c.h"

#ifdef __x86_64__
#include <cpuid.h>
#endif

#include <array>
#include <cstring>

#include "format/bytes.h"

namespace lyr::format {
namespace {

constexpr std::uint32_t polynomial = 0x82f63b78u;

using Table = std::array<std::uint32_t, 256>;

std::array<Table, 8> make_tables() {
    std::array<Table, 8> tables{};
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
        std::uint32_t crc = byte;
        for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) ? polynomial : 0);
        tables[0][byte] = crc;
    }
    for (std::size_t k = 1; k < tables.size(); ++k) {
        for (std::size_t byte = 0; byte < 256; ++byte) {
            const std::uint32_t crc = tables[k - 1][byte];
            tables[k][byte] = (crc >> 8) ^ tables[0][crc & 0xff];
        }
    }
    return tables;
}

// Made when they are first asked for: 8 KB that a program need not carry.
const std::array<Table, 8>& all_tables() {
    static const std::array<Table, 8> tables = make_tables();
    return tables;
}

#ifdef __x86_64__
bool has_instruction() {
    // The compiler's own question, __builtin_cpu_supports, links 4 kB that know every processor.
    static const bool has = [] {
        unsigned a, b, c = 0, d;
        return __get_cpuid(1, &a, &b, &c, &d) != 0 && (c & bit_SSE4_2) != 0;
    }();
    return has;
}

__attribute__((target("sse4.2"))) std::uint32_t by_instruction(std::span<const std::byte> bytes,
                                                               std::uint32_t crc) {
    const std::byte* at = bytes.data();
    std::size_t left = bytes.size();
    std::uint64_t wide = crc;
    for (; left >= 8; left -= 8, at += 8) {
        std::uint64_t eight;
        std::memcpy(&eight, at, sizeof eight);
        wide = __builtin_ia32_crc32di(wide, eight);
    }
    crc = static_cast<std::uint32_t>(wide);
    for (; left > 0; --left, ++at)
        crc = __builtin_ia32_crc32qi(crc, static_cast<unsigned char>(*at));
    return crc;
}
#else
bool has_instruction() {
    return false;
}

std::uint32_t by_instruction(std::span<const std::byte>, std::uint32_t crc) {
    return crc;
}
#endif

}  // namespace

std::uint32_t crc32c_by_tables(std::span<const std::byte> bytes, std::uint32_t before) {
    const std::array<Table, 8>& tables = all_tables();
    std::uint32_t crc = ~before;
    const std::byte* at = bytes.data();
    std::size_t left = bytes.size();
    for (; left >= 8; left -= 8, at += 8) {
        const std::uint32_t low = get_u32(at) ^ crc, high = get_u32(at + 4);
        crc = tables[7][low & 0xff] ^ tables[6][(low >> 8) & 0xff] ^ tables[5][(low >> 16) & 0xff] ^
              tables[4][low >> 24] ^ tables[3][high & 0xff] ^ tables[2][(high >> 8) & 0xff] ^
              tables[1][(high >> 16) & 0xff] ^ tables[0][high >> 24];
    }
    for (; left > 0; --left, ++at) {
        crc = (crc >> 8) ^ tables[0][(crc ^ static_cast<std::uint32_t>(*at)) & 0xff];
    }
    return ~crc;
}

std::uint32_t crc32c(std::span<const std::byte> bytes, std::uint32_t before) {
    return has_instruction() ? ~by_instruction(bytes, ~before) : crc32c_by_tables(bytes, before);
}

}  // namespace lyr::format
