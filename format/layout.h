// The numbers of the .lyr file's layout, for reader and writer: docs/lyr-format.md explains them.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace lyr::format {

// Prologue: magic, major (u16), minor (u16), quantum in nm (u32), CRC-32C of these 12 bytes.
inline constexpr std::array<std::byte, 4> magic{std::byte{'L'}, std::byte{'Y'}, std::byte{'R'},
                                                std::byte{0x1a}};
inline constexpr std::uint32_t major_version = 1, minor_version = 0;
inline constexpr std::size_t prologue_bytes = 16;
inline constexpr std::uint32_t coarsest_quantum_nm = 1'000'000;

// Block: type (1 byte), length of the payload (3 bytes), payload, CRC-32C of all these.
inline constexpr std::size_t block_head_bytes = 4, block_crc_bytes = 4;
inline constexpr std::size_t block_frame_bytes = block_head_bytes + block_crc_bytes;
inline constexpr std::size_t longest_payload = 0xffffff;

// Blocks that a reader must have whole before it can use them fit its buffer, frame included.
inline constexpr std::size_t buffer_bytes = 65536;
inline constexpr std::size_t longest_buffered_payload = buffer_bytes - block_frame_bytes;

enum class BlockType : std::uint8_t {
    metadata = 0x01,
    layer = 0x02,
    chunk = 0x03,
    index = 0x04,
    end = 0x05,
    thumbnail = 0x81,
    configuration = 0x82,
};
inline constexpr std::uint8_t skippable_bit = 0x80;

// An index entry is the offset of a layer's block.
inline constexpr std::size_t index_entry_bytes = 8;
// Layers (u32), chunks, operations, bytes of the file, offset of the index block (u64 each).
inline constexpr std::size_t end_payload_bytes = 4 + 4 * 8;

// First byte of an operation. Runs carry their count - 1 in the low four bits.
namespace opcode {
inline constexpr std::uint8_t line = 0x00, arc = 0x10, line_z = 0x20, arc_z = 0x30;
inline constexpr std::uint8_t run_mask = 0xf0;
inline constexpr std::uint8_t longest_run = 16;
inline constexpr std::uint8_t travel = 0x40, travel_z = 0x41;
inline constexpr std::uint8_t circle_ccw = 0x42, circle_cw = 0x43;
inline constexpr std::uint8_t helix_ccw = 0x44, helix_cw = 0x45;
inline constexpr std::uint8_t grid = 0x46, hatch = 0x47;
inline constexpr std::uint8_t smooth = 0x48, parallel = 0x49, repeated = 0x4a;
inline constexpr std::uint8_t wipe = 0x4b;
inline constexpr std::uint8_t path = 0x50, width = 0x51, speed = 0x52, acceleration = 0x53;
inline constexpr std::uint8_t travel_speed = 0x54, travel_acceleration = 0x55, retract = 0x56;
inline constexpr std::uint8_t temperature = 0x57, fan = 0x58, dwell = 0x59, tool = 0x5a;
inline constexpr std::uint8_t pause = 0x5b, object = 0x5c;
// From here on: a varint length and as many bytes, which a reader may pass over.
inline constexpr std::uint8_t first_skippable = 0xf0;
}  // namespace opcode

// Which fields of the style a path states anew, in this order.
namespace style_bit {
inline constexpr std::uint8_t width = 1, height = 2, flow = 4, speed = 8, acceleration = 16;
inline constexpr std::uint8_t all = 31;
}  // namespace style_bit

namespace hatch_bit {
inline constexpr std::uint8_t one_way = 1, backward = 2;
inline constexpr std::uint8_t all = 3;
}  // namespace hatch_bit

// Units of numbers that are not coordinates, as steps per unit of the value.
namespace scale {
inline constexpr double width = 1e4;       // 100 nm: 0.02 % of a strand of 0.5 mm
inline constexpr double flow = 1e5;        //
inline constexpr double speed = 100;       // 0.01 mm/s
inline constexpr double acceleration = 1;  // mm/s^2
inline constexpr double filament = 1000;   // 1 um
inline constexpr double temperature = 10;  // 0.1 deg C
inline constexpr double duty = 1000;       //
inline constexpr double time = 1000;       // 1 ms
inline constexpr double volume = 1e6;      // 10^-6 mm^3
inline constexpr double distance = 16;     // of a quantum
inline constexpr double direction = 1 << 30;
inline constexpr double offset = 1 << 24;  // of a quantum, so that a thousand pitches do not drift
}  // namespace scale

// How far parallel runs may be apart, in the file's unit: 2^32 quanta.
inline constexpr std::int64_t farthest_beside = std::int64_t{1} << 36;

// No number of this kind is larger in the file.
inline constexpr std::uint64_t largest_setting = 0xffffffffu;

}  // namespace lyr::format
