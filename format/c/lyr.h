// Reads a .lyr file in C99 with nothing but a compiler: no library, no heap. For microcontrollers. docs/lyr-format.md
// gives the format and the units of what is not in quanta, docs/c-reader.md an example. Packed runs need IEEE doubles,
// rounded by each operation: build with -ffp-contract=off where the processor fuses them.
//
// Contract
//  1. No operation is given out before the CRC of its chunk was found right, nor a layer's state before that of its
//     block. After an error the reader stays at it until lyr_seek_layer().
//  2. LYR_END comes only after the end block was found right: counts, index, and nothing behind it.
//  3. It accepts and refuses what format/reader.h does, at the same byte, but for the metadata's text and thumbnails.
//     65528 bytes of buffer do for every file, fewer (at least LYR_LEAST_BUFFER) for one of shorter blocks.
//  4. No input makes it read or write out of bounds, loop, or leave the ranges of its numbers.
//  5. Coordinates are within +-(2^31 - 1). Motions of no length, and what a later version added, are passed over.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { LYR_LEAST_BUFFER = 36, LYR_HISTORY = 1024 };

typedef enum lyr_status {
    LYR_OK,
    LYR_END,          // the print is complete
    LYR_UNREADABLE,   // the source failed to read or seek
    LYR_CUT_SHORT,    // the file ends too early
    LYR_NO_LYR,       // not a .lyr file at all
    LYR_DAMAGED,      // a CRC is wrong
    LYR_UNSUPPORTED,  // needs a newer reader
    LYR_TOO_LONG,     // a block does not fit the buffer, or the format
    LYR_NONSENSE,     // right CRC, but against the specification
} lyr_status;

typedef struct lyr_source {
    // Up to `count` (at least 1) bytes; how many, 0 at the file's end; negative: cannot read.
    int32_t (*read)(void* user, uint8_t* bytes, uint32_t count);
    bool (*seek)(void* user, uint64_t offset);  // to a byte of the file, for lyr_seek_layer() only
    void* user;
} lyr_source;

typedef struct lyr_point {
    int32_t x, y, z;
} lyr_point;

typedef struct lyr_style {
    uint32_t role, width, height, flow;  // 0.1 um, 0.1 um, 0.00001
    uint32_t speed, acceleration;        // 0.01 mm/s; mm/s^2, 0: the machine's own
} lyr_style;

typedef struct lyr_setting {
    uint32_t kind, number, value;  // heaters: 0 bed, 1 chamber, 2 tool; 0.1 deg C. Fans: 0; 0.001
} lyr_setting;

typedef struct lyr_layer {
    uint32_t index;  // from 0
    lyr_point start;
    uint32_t thickness, travel_speed, travel_acceleration;  // 0.1 um, 0.01 mm/s, mm/s^2
    uint32_t tool, object, retracted, retract_length;       // um
    uint32_t retract_speed, unretract_speed;                // 0.01 mm/s
    uint32_t heater_count, fan_count, chunks;
    lyr_setting heaters[16], fans[8];
    uint64_t time, operations;             // ms, 0: not estimated
    lyr_point low, high;                   // box of all motions
    uint64_t extruded, travelled, volume;  // quanta, quanta, 10^-6 mm^3
} lyr_layer;

// The codes of the file. A path and a hatch set reader.style and reader.grid.
typedef enum lyr_kind {
    LYR_LINE = 0x00,          // extrude from `from` to `to`
    LYR_ARC = 0x10,           // the same along an arc: sagitta, never 0
    LYR_TRAVEL = 0x40,        // without extruding
    LYR_CIRCLE = 0x42,        // a turn about center_x, center_y; `to` is off `from` in z at most
    LYR_HATCH = 0x47,         // a run begins; its lines and travels follow
    LYR_WIPE = 0x4b,          // a piece: sagitta (0: a line); value: depth, um; way
    LYR_PATH = 0x50,          // the style from here on; the next three change it
    LYR_WIDTH = 0x51,         // value: 0.1 um
    LYR_SPEED = 0x52,         // value: 0.01 mm/s
    LYR_ACCELERATION = 0x53,  // value: mm/s^2
    LYR_TRAVEL_SPEED = 0x54,  // value: 0.01 mm/s
    LYR_TRAVEL_ACCELERATION = 0x55,  // value: mm/s^2
    LYR_RETRACT = 0x56,              // value: depth, um
    LYR_TEMPERATURE = 0x57,          // heater's kind, number; value: 0.1 deg C; wait
    LYR_FAN = 0x58,                  // number; value: 0.001
    LYR_DWELL = 0x59,                // value: ms
    LYR_TOOL = 0x5a,                 // value
    LYR_PAUSE = 0x5b,                // value: reason, 0 or 1
    LYR_OBJECT = 0x5c,               // value
    LYR_LAYER = 0x100,               // go to `to`; number; reader.layer has the rest
} lyr_kind;

typedef struct lyr_operation {
    lyr_kind kind;
    bool hatch, counter_clockwise, wait;  // hatch: a line or travel of one
    uint32_t heater, number, value;
    lyr_point from, to;
    int32_t center_x, center_y;
    int64_t sagitta;
    double way;       // of a wipe as a whole, in quanta
    uint64_t offset;  // byte of the file where it begins
} lyr_operation;

// What stands behind `source` is the reader's own affair.
typedef struct lyr_reader {
    lyr_status status;
    uint64_t offset;                    // of an error: byte of the file
    uint32_t whole_layers;              // number of the last whole layer; 0: none is
    uint32_t major, minor, quantum_nm;  // after lyr_open()
    uint32_t length;                    // of the block read last: after lyr_open() the metadata's
    lyr_layer layer;                    // of the last LYR_LAYER
    lyr_style style;                    // as of the operation given out last
    int64_t grid[4];  // of hatches: a, b, offset, pitch in 2^-30, 2^-30, 2^-24 and 2^-24 quanta
    lyr_source source;
    uint8_t *buffer, due, type;
    bool in_chunk, too_large, sought;
    uint32_t capacity, crc, index_crc, offsets_crc, layers, depth, crc_table[256];
    uint64_t behind, index_offset, chunks, operations;
    double way;
    const uint8_t* end;
    struct lyr_place {
        const uint8_t* cursor;
        lyr_point head;
        uint64_t left;  // steps of the operation at hand: motions, pieces, rows
    } at;
    struct lyr_decoder {
        bool has_path, has_grid, forward, linked;
        uint8_t code, orders, bit, flags;
        uint64_t chunks, operations, left, motions, old, rows, alike, ends, end;
        int64_t back, distance, row, last, before[64][2];
    } decoder;
    struct lyr_motion {
        int32_t from_x, from_y, to_x, to_y;
        int64_t sagitta;
    } history[LYR_HISTORY];
} lyr_reader;

// Reads the metadata, whose text then is the first `length` bytes of the buffer. That is in use
// until the last call; the source is copied.
bool lyr_open(lyr_reader* reader, const lyr_source* source, void* buffer, uint32_t size);
// The next operation. False: the end (LYR_END) or an error.
bool lyr_next(lyr_reader* reader, lyr_operation* operation);
// Goes to the layer of this number whose LYR_LAYER was, or is according to the index, at `offset`. The end is
// then checked without counts and index. Only for a reader that was opened.
bool lyr_seek_layer(lyr_reader* reader, uint32_t index, uint64_t offset);

#ifdef __cplusplus
}
#endif
