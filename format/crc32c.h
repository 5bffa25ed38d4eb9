// CRC-32C (Castagnoli, reflected polynomial 0x82f63b78, start and final xor 0xffffffff): the check
// of every block of a .lyr file. It finds every error of up to 5 bits in a block and every burst of
// up to 32.
//
// Contract
//  1. crc32c("123456789") = 0xe3069283 (the standard's check value).
//  2. crc32c(b, crc32c(a)) = crc32c(a followed by b).

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace lyr::format {

std::uint32_t crc32c(std::span<const std::byte> bytes, std::uint32_t before = 0);

// The same, on any processor.
std::uint32_t crc32c_by_tables(std::span<const std::byte> bytes, std::uint32_t before = 0);

}  // namespace lyr::format
