// A loop over blocks around one over the operations of a chunk; runs, hatches and wipes are unrolled
// step by step from a few counters. The first error counts, and nothing that was read after it is
// given out. Numbers are 64 bits wide and bounded by the format's limits, so that nothing overflows.

#include "lyr.h"

enum { before_layers, in_layer, in_chunk, behind_layers, at_end };
enum { smooth_run = 0x48, parallel_run, repeated_run };
enum { no_hatch, hatch_row, hatch_start, hatch_end };
enum { metadata_block = 1, layer_block, chunk_block, index_block, end_block };
enum { longest_payload = 65528, frame_bytes = 8, end_bytes = 36, most_predicted = 32 };

static const int64_t coordinate_limit = 0x7fffffff, unit = INT64_C(1) << 30;
static const int64_t hatch_limit = INT64_C(3) << 30, offset_limit = INT64_C(3) << 54;
static const int64_t first_row_limit = INT64_C(1) << 32, row_limit = INT64_C(1) << 34;
static const int64_t farthest_beside = INT64_C(1) << 36;  // 1/16 quantum

// In the block at hand, or within it where the caller says so.
static bool fail(lyr_reader* r, lyr_status status, const char* text) {
    if (r->error.status != LYR_OK) return false;
    const uint32_t chunk = r->layer_chunks + (r->where == in_layer);
    r->error = (lyr_error){status, text, r->offset, 0, 0, r->error.whole_layers};
    if (r->where == in_layer || r->where == in_chunk) r->error.layer = r->layer.index + 1;
    if (r->error.layer != 0 && chunk <= r->layer.chunks) r->error.chunk = chunk;
    return false;
}

static bool wrong(lyr_reader* r, const char* text) { return fail(r, LYR_NONSENSE, text); }

// Numbers.

static bool beyond(int64_t value, int64_t limit) { return value < -limit || value > limit; }
static uint64_t size_of(int64_t value) { return value < 0 ? 0 - (uint64_t)value : (uint64_t)value; }

// value / 2^bits to the nearest whole number, halves up.
static int64_t rounded(int64_t value, int bits) {
    value += INT64_C(1) << (bits - 1);
    return value >= 0 ? value >> bits : -1 - ((-1 - value) >> bits);
}

static uint32_t get_u32(const uint8_t* at) {
    return at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}
static uint64_t get_u64(const uint8_t* at) { return get_u32(at) | (uint64_t)get_u32(at + 4) << 32; }

uint32_t lyr_crc32c(const uint8_t* bytes, size_t count, uint32_t before) {
    // Four bits a step: a table that is small enough for any board.
    static const uint32_t table[16] = {0x00000000, 0x105ec76f, 0x20bd8ede, 0x30e349b1,
                                       0x417b1dbc, 0x5125dad3, 0x61c69362, 0x7198540d,
                                       0x82f63b78, 0x92a8fc17, 0xa24bb5a6, 0xb21572c9,
                                       0xc38d26c4, 0xd3d3e1ab, 0xe330a81a, 0xf36e6f75};
    uint32_t crc = ~before;
    for (const uint8_t* end = bytes + count; bytes != end; ++bytes) {
        crc ^= *bytes;
        crc = crc >> 4 ^ table[crc & 15];
        crc = crc >> 4 ^ table[crc & 15];
    }
    return ~crc;
}

// The payload at hand. What is not there reads as 0 and is an error.

static uint64_t left_of(const lyr_reader* r) { return (uint64_t)(r->payload_end - r->cursor); }

static uint64_t cut_off(lyr_reader* r) {
    r->cursor = r->payload_end;
    return wrong(r, "a number is cut short or too long");
}

static uint8_t get_byte(lyr_reader* r) {
    return r->cursor == r->payload_end ? (uint8_t)cut_off(r) : *r->cursor++;
}

static uint64_t get_varint(lyr_reader* r) {
    uint64_t value = 0;
    for (int shift = 0; shift < 64 && r->cursor != r->payload_end; shift += 7) {
        const uint8_t next = *r->cursor++;
        if (shift == 63 && next > 1) break;
        value |= (uint64_t)(next & 0x7f) << shift;
        if (next < 0x80) return value;
    }
    return cut_off(r);
}

static int64_t unzigzag(uint64_t value) {
    return value & 1 ? -1 - (int64_t)(value >> 1) : (int64_t)(value >> 1);
}
static int64_t get_signed(lyr_reader* r) { return unzigzag(get_varint(r)); }

static uint32_t get_setting(lyr_reader* r) {
    const uint64_t value = get_varint(r);
    if (value > UINT32_MAX) wrong(r, "a number is out of range");
    return (uint32_t)value;
}

static int32_t coordinate(lyr_reader* r, int64_t value) {
    if (!beyond(value, coordinate_limit)) return (int32_t)value;
    return wrong(r, "a position is out of range");
}

static lyr_point get_point(lyr_reader* r, lyr_point from, bool with_z) {
    int32_t* const axes[3] = {&from.x, &from.y, &from.z};
    for (int i = 0; i < (with_z ? 3 : 2); ++i) {
        const int64_t way = get_signed(r);
        *axes[i] = coordinate(r, beyond(way, 2 * coordinate_limit) ? way : *axes[i] + way);
    }
    return from;
}

// Blocks.

// At least `count` bytes from r->at on.
static bool fill(lyr_reader* r, size_t count) {
    if (r->filled - r->at >= count) return true;
    if (count > r->capacity) return fail(r, LYR_TOO_LONG, "the buffer is too small for a block");
    if (r->at == r->filled || r->at + count > r->capacity) {
        for (size_t i = r->at; i < r->filled; ++i) r->buffer[i - r->at] = r->buffer[i];
        r->buffer_offset += r->at;
        r->filled -= r->at;
        r->at = 0;
    }
    while (r->filled - r->at < count) {
        const size_t room = r->capacity - r->filled;
        const uint32_t most = room < INT32_MAX ? (uint32_t)room : INT32_MAX;
        const int32_t got = r->source.read(r->source.user, r->buffer + r->filled, most);
        if (got < 0 || (uint32_t)got > most) return fail(r, LYR_UNREADABLE, "cannot read");
        r->filled += (size_t)got;
        if (got > 0) continue;
        fail(r, LYR_CUT_SHORT, "the file is cut short");
        r->error.offset = r->buffer_offset + r->filled;
        return false;
    }
    return true;
}

static bool next_block(lyr_reader* r) {
    r->offset = r->buffer_offset + r->at;
    if (!fill(r, 4)) return false;
    r->type = r->buffer[r->at];
    r->length = get_u32(r->buffer + r->at) >> 8;
    return true;
}

static void give_extra(lyr_reader* r, const uint8_t* bytes, size_t count, size_t left) {
    if (r->source.extra && r->type >= 0x80)
        r->source.extra(r->source.user, r->type, bytes, count, left);
}

// A block of any length, piece by piece.
static bool stream(lyr_reader* r) {
    uint32_t crc = lyr_crc32c(r->buffer + r->at, 4, 0);
    r->at += 4;
    r->index_crc = 0;
    for (size_t left = r->length; left > 0;) {
        if (!fill(r, 1)) return false;
        const uint8_t* piece = r->buffer + r->at;
        const size_t ready = r->filled - r->at, count = ready < left ? ready : left;
        crc = lyr_crc32c(piece, count, crc);
        if (r->type == index_block) r->index_crc = lyr_crc32c(piece, count, r->index_crc);
        give_extra(r, piece, count, left);
        r->at += count;
        left -= count;
    }
    if (!fill(r, 4)) return false;
    r->at += 4;
    if (crc != get_u32(r->buffer + r->at - 4))
        return fail(r, LYR_DAMAGED, "the block is damaged (its CRC is wrong)");
    give_extra(r, NULL, 0, 0);
    return true;
}

static bool take_payload(lyr_reader* r) {
    if (r->length > longest_payload)
        return fail(r, LYR_TOO_LONG, "a block has more bytes than are allowed");
    if (!fill(r, r->length + frame_bytes)) return false;
    r->payload = r->cursor = r->buffer + r->at + 4;
    r->payload_end = r->payload + r->length;
    return stream(r);
}

static bool pass_over(lyr_reader* r) {
    if (!stream(r)) return false;
    if (r->type & 0x80) return true;
    if (r->type >= metadata_block && r->type <= end_block)
        return wrong(r, "a block is out of place");
    return fail(r, LYR_UNSUPPORTED, "the file needs a reader that knows this block");
}

// In front of the layers.

// 0: it says nothing of them, or nothing that makes sense.
static bool check_layers(lyr_reader* r, const char* at, const char* end) {
    uint64_t value = 0;
    const bool any = at != end;
    for (; at != end && *at >= '0' && *at <= '9' && value <= UINT32_MAX; ++at)
        value = 10 * value + (uint64_t)(*at - '0');
    r->stated_layers = (uint32_t)value;
    return (any && at == end && value <= UINT32_MAX) ||
           wrong(r, "a line of the metadata has no number");
}

static bool read_metadata(lyr_reader* r) {
    if (!next_block(r)) return false;
    if (r->type != metadata_block) return wrong(r, "the first block is not the metadata");
    if (!take_payload(r)) return false;
    const char *at = (const char*)r->payload, *const end = at + r->length;
    while (at != end) {
        const char *key = at, *equal = NULL, *word = "layers";
        for (; at != end && *at != '\n'; ++at)
            if (*at == '=' && !equal) equal = at;
        if (!equal) return wrong(r, "a line of the metadata is not key=value");
        const char* same = key;
        while (same != equal && *same == *word) ++same, ++word;
        if (same == equal && *word == 0 && !check_layers(r, equal + 1, at)) return false;
        if (r->source.metadata)
            r->source.metadata(r->source.user, key, (size_t)(equal - key), equal + 1,
                               (size_t)(at - equal) - 1);
        if (at != end) ++at;
    }
    return true;
}

static bool read_prologue(lyr_reader* r) {
    const bool whole = fill(r, 16);
    for (size_t i = 0; i < 4 && i < r->filled; ++i)
        if (r->buffer[i] == "LYR\x1a"[i])
            continue;
        else {
            r->error.status = LYR_OK;
            return fail(r, LYR_NO_LYR, "this is not a .lyr file");
        }
    if (!whole) return false;
    if (lyr_crc32c(r->buffer, 12, 0) != get_u32(r->buffer + 12))
        return fail(r, LYR_DAMAGED, "the prologue is damaged (its CRC is wrong)");
    r->major = get_u32(r->buffer + 4) & 0xffff;
    r->minor = get_u32(r->buffer + 4) >> 16;
    r->quantum_nm = get_u32(r->buffer + 8);
    r->offset = 4;
    if (r->major != 1) return fail(r, LYR_UNSUPPORTED, "this reader knows major version 1 only");
    r->offset = 8;
    if (r->quantum_nm - 1 > 999999) return wrong(r, "the quantum must be 1 to 1000000 nm");
    r->at = 16;
    return read_metadata(r);
}

bool lyr_open(lyr_reader* r, const lyr_source* source, void* buffer, size_t size) {
    *r = (lyr_reader){.source = *source, .buffer = buffer, .capacity = size};
    if (!read_prologue(r)) return false;
    while (next_block(r)) {
        if (r->type == layer_block || r->type == index_block) return true;
        if (!pass_over(r)) break;
    }
    return false;
}

// Layers.

static uint32_t get_settings(lyr_reader* r, lyr_setting* settings, uint32_t most, bool heaters) {
    const uint64_t count = get_varint(r);
    if (count > most) wrong(r, "a layer states too many heaters or fans");
    for (uint64_t i = 0; i < count && r->error.status == LYR_OK; ++i) {
        const uint32_t kind = heaters ? get_setting(r) : 0;
        settings[i].kind = (uint8_t)kind;
        settings[i].number = get_setting(r);
        settings[i].value = get_setting(r);
        if (heaters ? kind > 2 : settings[i].value > 1000) wrong(r, "a number is out of range");
    }
    return (uint32_t)count;
}

static bool decode_layer(lyr_reader* r, lyr_layer* l) {
    uint32_t* const settings[] = {&l->thickness,      &l->travel_speed,  &l->travel_acceleration,
                                  &l->tool,           &l->object,        &l->retracted,
                                  &l->retract_length, &l->retract_speed, &l->unretract_speed};
    l->index = get_setting(r);
    l->start = get_point(r, l->start, true);
    for (size_t i = 0; i < sizeof settings / sizeof *settings; ++i) *settings[i] = get_setting(r);
    l->heater_count = get_settings(r, l->heaters, 16, true);
    l->fan_count = get_settings(r, l->fans, 8, false);
    l->time = get_varint(r);
    l->chunks = get_setting(r);
    l->operations = get_varint(r);
    l->low = get_point(r, l->start, true);
    l->high = get_point(r, l->low, true);
    l->extruded = get_varint(r);
    l->travelled = get_varint(r);
    l->volume = get_varint(r);
    return (l->extruded | l->travelled) >> 63 ? wrong(r, "a number is out of range")
                                              : r->error.status == LYR_OK;
}

static bool layer_is_whole(lyr_reader* r) {
    if (r->where == before_layers) return true;
    if (r->layer_chunks != r->layer.chunks)
        return wrong(r, "the layer has fewer chunks than it says");
    return r->layer_operations == r->layer.operations ||
           wrong(r, "the layer has another number of operations than it says");
}

static bool read_layer(lyr_reader* r) {
    lyr_layer layer = {0};
    uint8_t entry[8];
    if (!take_payload(r) || !layer_is_whole(r) || !decode_layer(r, &layer)) return false;
    if (layer.index != r->layers) return wrong(r, "another layer is due");
    for (int i = 0; i < 8; ++i) entry[i] = (uint8_t)(r->offset >> (8 * i) & 0xff);
    r->offsets_crc = lyr_crc32c(entry, 8, r->offsets_crc);
    r->layer = layer;
    r->style = (lyr_style){.flow = 100000};
    r->decoder = (lyr_decoder){.head = layer.start, .before = 1, .two_before = 2};
    r->layer_chunks = 0;
    r->layer_operations = 0;
    ++r->layers;
    if (layer.chunks == 0) r->error.whole_layers = r->layers;
    r->where = in_layer;
    return r->layer_begins = true;
}

static bool read_chunk(lyr_reader* r) {
    if (!take_payload(r)) return false;
    const uint64_t layer = get_varint(r), chunk = get_varint(r);
    r->operations_left = get_varint(r);
    if (layer != r->layer.index || chunk != r->layer_chunks || chunk >= r->layer.chunks)
        return wrong(r, "a chunk is out of place");
    if (r->error.status != LYR_OK) return false;
    ++r->layer_chunks;
    ++r->chunks;
    r->layer_operations += r->operations_left;
    r->operations += r->operations_left;
    r->where = in_chunk;
    return true;
}

static bool read_index(lyr_reader* r) {
    if (!stream(r) || !layer_is_whole(r)) return false;
    if (!r->sought && (r->index_crc != r->offsets_crc || r->length != (uint64_t)r->layers * 8))
        return wrong(r, "the index does not lead to the layers");
    r->index_offset = r->offset;
    r->where = behind_layers;
    return true;
}

static bool read_end(lyr_reader* r) {
    if (!take_payload(r)) return false;
    if (r->length != end_bytes) return wrong(r, "the end block has no totals");
    const uint8_t* at = r->payload;
    const bool counted = get_u64(at + 4) == r->chunks && get_u64(at + 12) == r->operations;
    if (get_u32(at) != r->layers || (!counted && !r->sought) ||
        (r->stated_layers != 0 && r->stated_layers != r->layers))
        return wrong(r, "the file does not add up to what it says");
    if (get_u64(at + 20) != r->buffer_offset + r->at || get_u64(at + 28) != r->index_offset)
        return wrong(r, "the end block is out of place");
    r->offset = r->buffer_offset + r->at;
    if (fill(r, 1)) return wrong(r, "something follows the end of the print");
    if (r->error.status == LYR_CUT_SHORT) r->error.status = LYR_OK;
    r->where = at_end;
    return fail(r, LYR_END, "the print is complete");
}

static bool read_block(lyr_reader* r) {
    if (!next_block(r)) return false;
    const bool behind = r->where == behind_layers;
    if (r->type == layer_block && !behind) return read_layer(r);
    if (r->type == chunk_block && r->where == in_layer) return read_chunk(r);
    if (r->type == index_block && !behind) return read_index(r);
    return r->type == end_block && behind ? read_end(r) : pass_over(r);
}

// Motions. What decodes returns whether there is something to give out.

static bool same(lyr_point a, lyr_point b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

static bool may_extrude(lyr_reader* r) {
    return r->decoder.has_path || wrong(r, "extrusion before a path begins");
}

static bool move(lyr_reader* r, lyr_operation* o, lyr_kind kind) {
    o->kind = kind;
    o->from = r->decoder.head;
    r->decoder.head = o->to;
    return kind == LYR_ARC || kind == LYR_CIRCLE || !same(o->from, o->to);
}

// Lines and arcs that packed runs may refer to.
static bool remember(lyr_reader* r, const lyr_operation* o) {
    r->history[r->decoder.motions++ % LYR_HISTORY] =
        (lyr_motion){o->from.x, o->from.y, o->to.x, o->to.y, o->sagitta};
    return true;
}

// |s| <= 1.25 chords: (4 s)^2 <= (5 dx)^2 + (5 dy)^2. The squares have up to 74 bits; without the low
// 16 of them they decide all but what is so near that the low 64 do.
static bool is_arc(int64_t sagitta, lyr_point from, lyr_point to) {
    const uint64_t x = 5 * size_of((int64_t)to.x - from.x), y = 5 * size_of((int64_t)to.y - from.y);
    const uint64_t s = 4 * size_of(sagitta), over = s * s - x * x - y * y;
    const int64_t coarse =
        (int64_t)((s >> 8) * (s >> 8)) - (int64_t)((x >> 8) * (x >> 8) + (y >> 8) * (y >> 8));
    if (beyond(sagitta, 2 * hatch_limit)) return false;
    return beyond(coarse, INT64_C(1) << 40) ? coarse < 0 : over == 0 || over >> 63;
}

static bool decode_run(lyr_reader* r, lyr_operation* o) {
    lyr_decoder* d = &r->decoder;
    const bool arcs = d->run_code & 0x10, climbs = d->run_code & 0x20;
    --d->run_left;
    o->to = get_point(r, d->head, climbs);
    if (arcs) o->sagitta = get_signed(r);
    if (!may_extrude(r)) return false;
    if (arcs && (o->sagitta == 0 || !is_arc(o->sagitta, d->head, o->to)))
        return wrong(r, "an arc has no or too large a sagitta");
    return move(r, o, arcs ? LYR_ARC : LYR_LINE) && (climbs || remember(r, o));
}

static bool decode_circle(lyr_reader* r, lyr_operation* o, uint8_t code) {
    const lyr_point from = r->decoder.head, center = get_point(r, from, code >= 0x44);
    if (center.x == from.x && center.y == from.y) return wrong(r, "a circle has no radius");
    o->to = (lyr_point){from.x, from.y, center.z};
    o->center_x = center.x;
    o->center_y = center.y;
    o->counter_clockwise = code % 2 == 0;
    return may_extrude(r) && move(r, o, LYR_CIRCLE);
}

static bool decode_wipe_piece(lyr_reader* r, lyr_operation* o) {
    lyr_decoder* d = &r->decoder;
    --d->pieces_left;
    o->to = get_point(r, d->head, false);
    o->sagitta = get_signed(r);
    o->value = d->wipe_depth;
    o->number = d->wipe_left;
    return move(r, o, LYR_WIPE) && d->wipe_left-- > 0;
}

void lyr_wipe_again(lyr_reader* r) {
    lyr_decoder* d = &r->decoder;
    r->cursor = d->wipe_at;
    d->head = d->wipe_from;
    d->pieces_left = d->pieces;
    d->wipe_left = d->wipe_moves;
}

// Checked and counted as a whole first.
static bool decode_wipe(lyr_reader* r, lyr_operation* o) {
    lyr_decoder* d = &r->decoder;
    d->wipe_depth = get_setting(r);
    d->pieces = get_varint(r);
    if (d->pieces > left_of(r) / 3) wrong(r, "a wipe is cut short");
    d->wipe_at = r->cursor;
    d->wipe_from = d->head;
    d->wipe_moves = 0;
    lyr_point from = d->head;
    for (uint64_t i = 0; i < d->pieces && r->error.status == LYR_OK; ++i) {
        const lyr_point to = get_point(r, from, false);
        const int64_t sagitta = get_signed(r);
        if (!is_arc(sagitta, from, to)) wrong(r, "an arc has no or too large a sagitta");
        d->wipe_moves += !same(from, to);
        from = to;
    }
    if (r->error.status != LYR_OK) return false;
    lyr_wipe_again(r);
    return d->pieces > 0 && decode_wipe_piece(r, o);
}

// Packed runs. The specification gives the order of operations: each must be rounded by itself.

static double square_root(double value) {
    union {
        double value;
        uint64_t bits;
    } number = {value}, scale;
    if (!(value > 0)) return 0;
    // value = mantissa x 2^exponent; then the root of mantissa x 2^54, two bits a step, has a bit more
    // than a double, which rounds it.
    int64_t exponent = (int64_t)(number.bits >> 52) - 1075;
    uint64_t mantissa = (number.bits & (((uint64_t)1 << 52) - 1)) | (uint64_t)1 << 52;
    if (exponent % 2 != 0) mantissa <<= 1, --exponent;
    uint64_t root = 0, rest = 0;
    for (int i = 53; i >= 0; --i) {
        rest = rest << 2 | (i >= 27 ? mantissa >> (2 * i - 54) & 3 : 0);
        const uint64_t next = root << 2 | 1, fits = rest >= next;
        rest -= fits ? next : 0;
        root = root << 1 | fits;
    }
    scale.bits = (uint64_t)(exponent / 2 - 26 + 1023) << 52;
    return (double)((root + 1) >> 1) * scale.value;
}

static int64_t nearest(double value) {
    static const double limit = 1099511627776.0, whole = 6755399441055744.0;  // 2^40, 1.5 x 2^52
    return value > -limit && value < limit ? (int64_t)((value + whole) - whole) : 0;
}

static lyr_course course_of(const lyr_motion* m) {
    const double x = (double)m->to_x - m->from_x, y = (double)m->to_y - m->from_y;
    const double s = (double)m->sagitta, square = x * x + y * y, root = square_root(square);
    const double rise = 4 * s * s, across = 4 * s * root, along = square - rise;
    const double sum = square + rise;
    return (lyr_course){x * along + y * across,
                        y * along - x * across,
                        x * along - y * across,
                        y * along + x * across,
                        root * sum,
                        8 * s / sum};
}

static unsigned get_bit(lyr_reader* r) {
    lyr_decoder* d = &r->decoder;
    if (r->cursor == r->payload_end) return (unsigned)cut_off(r);
    const unsigned bit = *r->cursor >> d->bit & 1;
    d->bit = (uint8_t)((d->bit + 1) % 8);
    r->cursor += d->bit == 0;
    return bit;
}

static int64_t get_bits(lyr_reader* r, unsigned order) {
    uint64_t zeros = 0, low = 0;
    while (r->error.status == LYR_OK && get_bit(r) == 0)
        if (++zeros > 40) cut_off(r);
    for (unsigned i = 0; i < zeros + order && r->error.status == LYR_OK; ++i)
        low |= (uint64_t)get_bit(r) << i;
    return unzigzag(low + ((((uint64_t)1 << zeros) - 1) << order));
}

// The sagitta that goes on smoothly; the chord's length is kept for the next one.
static int64_t smooth_sagitta(lyr_decoder* d, const lyr_motion* last, double x, double y) {
    const double x0 = (double)last->to_x - last->from_x, y0 = (double)last->to_y - last->from_y;
    const double c0 = d->length, c = d->length = square_root(x * x + y * y);
    const double along = x0 * x + y0 * y, across = x0 * y - y0 * x;
    const double turn = c0 * c + along, rise = 2 * (double)last->sagitta;
    const double e = c * (across * c0 - rise * turn) / (2 * (c0 * turn + across * rise));
    return 4 * e > c || -4 * e > c ? 0 : nearest(e);
}

// What the next motion is expected to be, beside one that was.
static void expect_beside(lyr_reader* r, int64_t* x, int64_t* y, int64_t* sagitta) {
    lyr_decoder* d = &r->decoder;
    const lyr_motion *old = &r->history[d->beside++ % LYR_HISTORY],
                     *next = &r->history[d->beside % LYR_HISTORY];
    const lyr_course now = d->course;
    d->course = course_of(next);
    const bool joined = next->from_x == old->to_x && next->from_y == old->to_y;
    double n_x = now.end_x, n_y = now.end_y, size = now.size;
    if (joined) n_x = d->course.start_x, n_y = d->course.start_y, size = d->course.size;
    double cosine = now.end_x * n_x + now.end_y * n_y, one = now.size * size;
    if (cosine < -0.5 * one) {
        n_x = now.end_x, n_y = now.end_y, size = now.size;
        cosine = one = now.size * now.size;
    }
    const double distance = (double)d->distance / 16, reach = distance / (one + cosine);
    *x = nearest(old->to_x - reach * (now.end_y * size + n_y * now.size));
    *y = nearest(old->to_y + reach * (now.end_x * size + n_x * now.size));
    *sagitta = nearest((double)old->sagitta * (1 - distance * now.curvature));
}

static bool decode_packed(lyr_reader* r, lyr_operation* o) {
    lyr_decoder* d = &r->decoder;
    int64_t x = 0, y = 0, sagitta = 0;
    const int64_t dx = get_bits(r, d->orders & 15), dy = get_bits(r, d->orders & 15);
    const int64_t ds = get_bits(r, d->orders >> 4);
    if (--d->packed_left == 0 && d->bit != 0) d->bit = 0, ++r->cursor;
    if (r->error.status != LYR_OK) return false;
    if (d->packed == parallel_run) {
        expect_beside(r, &x, &y, &sagitta);
    } else if (d->packed == repeated_run) {
        const lyr_motion* old = &r->history[d->beside++ % LYR_HISTORY];
        x = (int64_t)d->head.x + old->to_x - old->from_x;
        y = (int64_t)d->head.y + old->to_y - old->from_y;
        sagitta = old->sagitta;
    } else {
        x = d->head.x, y = d->head.y;
        const lyr_motion* last = &r->history[(d->motions - 1) % LYR_HISTORY];
        if (d->follows)
            sagitta = smooth_sagitta(d, last, (double)dx, (double)dy);
        else
            d->length = square_root((double)dx * (double)dx + (double)dy * (double)dy);
        d->follows = true;
    }
    o->to = (lyr_point){coordinate(r, x + dx), coordinate(r, y + dy), d->head.z};
    o->sagitta = sagitta + ds;
    if (same(o->to, d->head)) return wrong(r, "a motion of a packed run has no length");
    if (!is_arc(o->sagitta, d->head, o->to))
        return wrong(r, "an arc has no or too large a sagitta");
    return move(r, o, o->sagitta == 0 ? LYR_LINE : LYR_ARC) && remember(r, o);
}

// What a parallel or repeated run refers to.
static bool get_reference(lyr_reader* r) {
    lyr_decoder* d = &r->decoder;
    const bool beside = d->packed == parallel_run;
    const int64_t kept = (int64_t)(d->motions < LYR_HISTORY ? d->motions : LYR_HISTORY);
    const int64_t back = get_signed(r);
    if (!beyond(back, LYR_HISTORY)) d->back += back;
    if (beyond(back, LYR_HISTORY) || d->back < (beside ? 2 : 1) || d->back > kept)
        return wrong(r, "a run leans on motions out of reach");
    d->beside = d->motions - (uint64_t)d->back;
    if (!beside) return true;
    const int64_t distance = get_signed(r);
    if (!beyond(distance, 2 * farthest_beside)) d->distance += distance;
    if (beyond(distance, 2 * farthest_beside) || beyond(d->distance, farthest_beside))
        return wrong(r, "a run is too far from what it is parallel to");
    d->course = course_of(&r->history[d->beside % LYR_HISTORY]);
    return true;
}

static bool begin_packed(lyr_reader* r, lyr_operation* o, uint8_t code) {
    lyr_decoder* d = &r->decoder;
    d->packed = code;
    d->follows = false;
    if (code != smooth_run && !get_reference(r)) return false;
    if (code == smooth_run && d->motions > 0) {
        const lyr_motion* last = &r->history[(d->motions - 1) % LYR_HISTORY];
        const double x = (double)last->to_x - last->from_x, y = (double)last->to_y - last->from_y;
        d->follows = last->to_x == d->head.x && last->to_y == d->head.y;
        d->length = square_root(x * x + y * y);
    }
    d->packed_left = get_varint(r);
    d->orders = get_byte(r);
    if (!may_extrude(r)) return false;
    // Each motion takes three bits at least.
    if (d->packed_left == 0 || d->packed_left > left_of(r) * 8 / 3)
        return wrong(r, "a packed run has no motions, or is cut short");
    r->operations_left -= d->packed_left - 1;
    return decode_packed(r, o);
}

// Hatches.

static bool decode_grid(lyr_reader* r) {
    const int64_t a = get_signed(r), b = get_signed(r), offset = get_signed(r);
    r->grid = (lyr_grid){a, b, offset, get_signed(r)};
    r->decoder.has_grid = !beyond(a, unit) && !beyond(b, unit) && !beyond(offset, offset_limit) &&
                          !beyond(a * a + b * b - unit * unit, 2 * unit) &&
                          !beyond(r->grid.pitch, offset_limit);
    return r->decoder.has_grid ? false : wrong(r, "a grid is out of range");
}

static bool decode_hatch(lyr_reader* r, lyr_operation* o) {
    lyr_decoder* d = &r->decoder;
    const uint8_t flags = get_byte(r);
    d->row = get_signed(r);
    d->rows_left = get_varint(r);
    if (flags > 3) return wrong(r, "a hatch has a flag that is not known");
    if (!d->has_path) return wrong(r, "extrusion before a path begins");
    if (!d->has_grid) return wrong(r, "a hatch without a grid");
    if (beyond(d->row, first_row_limit) || d->rows_left > (uint64_t)first_row_limit)
        return wrong(r, "a hatch row is out of range");
    d->one_way = flags & 1;
    d->forward = !(flags & 2);
    d->group_rows_left = d->counts[0] = d->counts[1] = d->counts[2] = 0;
    d->last = 0;
    d->stage = hatch_row;
    o->kind = LYR_HATCH;
    return true;
}

static void pass_rows(lyr_decoder* d, uint64_t rows) {
    d->stage = hatch_row;
    d->rows_left -= rows;
    d->group_rows_left -= rows;
    d->row += (int64_t)rows;
    d->forward ^= !d->one_way && rows % 2 == 1;
}

// For the prediction, which looks back two rows.
static void count_row(lyr_decoder* d, uint64_t intervals) {
    const uint8_t oldest = d->two_before;
    d->two_before = d->before;
    d->before = d->now;
    d->now = oldest;
    d->counts[2] = d->counts[1];
    d->counts[1] = d->counts[0];
    d->counts[0] = intervals;
    const bool known = intervals <= most_predicted && d->counts[1] == intervals;
    d->order = !known ? 0 : d->counts[2] == intervals ? 2 : 1;
}

// False: the group has rows without intervals, which are passed over here, or an error.
static bool begin_group(lyr_reader* r) {
    lyr_decoder* d = &r->decoder;
    const uint64_t code = get_varint(r);
    d->group_rows_left = get_varint(r);
    d->group_linked = code & 1;
    d->intervals = code >> 1;
    if (d->group_rows_left == 0 || d->group_rows_left > d->rows_left)
        return wrong(r, "a hatch has another number of rows than it says");
    if (d->intervals == 0) {
        for (int i = d->group_rows_left > 1 ? 2 : 1; i > 0; --i) count_row(d, 0);
        pass_rows(d, d->group_rows_left);
        return false;
    }
    // Each interval has two values of a byte at least.
    const uint64_t most = left_of(r) / 2;
    return (d->intervals <= most && d->group_rows_left <= most / d->intervals) ||
           wrong(r, "a hatch row is cut short");
}

static bool begin_row(lyr_reader* r) {
    lyr_decoder* d = &r->decoder;
    if (d->rows_left == 0) d->stage = no_hatch;
    if (d->rows_left == 0 || (d->group_rows_left == 0 && !begin_group(r))) return false;
    const int64_t far = (int64_t)size_of(d->row), pitch = (int64_t)size_of(r->grid.pitch);
    if (far > row_limit || (far != 0 && pitch > 2 * offset_limit / far) ||
        beyond(r->grid.offset + d->row * r->grid.pitch, offset_limit))
        return wrong(r, "a hatch row is out of range");
    d->row_offset = rounded(r->grid.offset + d->row * r->grid.pitch, 24);
    count_row(d, d->intervals);
    d->linked = d->group_linked;
    d->ends_left = 2 * d->intervals;
    d->stage = hatch_start;
    return true;
}

static int64_t predicted(const lyr_decoder* d, uint64_t j) {
    if (d->order == 0) return d->last;
    const int64_t before = d->ends[d->before][j];
    return d->order == 1 ? before : 2 * before - d->ends[d->two_before][j];
}

static bool decode_hatch_step(lyr_reader* r, lyr_operation* o) {
    lyr_decoder* d = &r->decoder;
    if (d->stage == hatch_row && !begin_row(r)) return false;
    if (d->linked && !may_extrude(r)) return false;
    const uint64_t j = d->forward ? 2 * d->intervals - d->ends_left : d->ends_left - 1;
    const int64_t off = get_signed(r), w = d->row_offset, a = r->grid.a, b = r->grid.b;
    const int64_t u = beyond(off, 8 * hatch_limit) ? off : predicted(d, j) + off;
    if (beyond(u, hatch_limit)) return wrong(r, "a hatch line is out of range");
    if (j < 2 * most_predicted) d->ends[d->now][j] = u;
    d->last = u;
    o->hatch = true;
    o->to.x = coordinate(r, rounded(u * a - w * b, 30));
    o->to.y = coordinate(r, rounded(u * b + w * a, 30));
    o->to.z = d->head.z;
    const bool travels = d->stage == hatch_start && !d->linked;
    d->linked = false;
    d->stage = d->stage == hatch_start ? hatch_end : hatch_start;
    if (--d->ends_left == 0) pass_rows(d, 1);
    return move(r, o, travels ? LYR_TRAVEL : LYR_LINE);
}

// Operations.

static bool decode_path(lyr_reader* r) {
    uint32_t* const settings[] = {&r->style.width, &r->style.height, &r->style.flow,
                                  &r->style.speed, &r->style.acceleration};
    const uint8_t role = get_byte(r), fields = get_byte(r);
    if (fields > 31) return wrong(r, "a path has a field that is not known");
    r->style.role = role < 19 ? role : 0;
    for (int i = 0; i < 5; ++i)
        if (fields >> i & 1) *settings[i] = get_setting(r);
    return r->decoder.has_path = true;
}

static bool decode_setting(lyr_reader* r, lyr_operation* o, uint8_t code) {
    if (code < LYR_PATH || code > LYR_OBJECT) return wrong(r, "unknown operation");
    o->kind = (lyr_kind)code;
    if (code == LYR_PATH) return decode_path(r);
    if (code < LYR_TRAVEL_SPEED && !r->decoder.has_path)
        return wrong(r, "a style is changed before a path begins");
    if (code == LYR_TEMPERATURE) o->heater = get_byte(r);
    if (code == LYR_TEMPERATURE || code == LYR_FAN) o->number = get_setting(r);
    o->value = code == LYR_PAUSE ? get_byte(r) == 1 : get_setting(r);
    if (code == LYR_TEMPERATURE) o->wait = get_byte(r) != 0;
    if (code == LYR_WIDTH) r->style.width = o->value;
    if (code == LYR_SPEED) r->style.speed = o->value;
    if (code == LYR_ACCELERATION) r->style.acceleration = o->value;
    if (o->heater > 2) return wrong(r, "unknown heater");
    return code != LYR_FAN || o->value <= 1000 || wrong(r, "a fan's duty is above 1");
}

static bool decode(lyr_reader* r, lyr_operation* o) {
    const uint8_t code = get_byte(r);
    const uint8_t run = code < LYR_TRAVEL ? (code & 15) + 1 : 1;
    r->operations_left -= run;
    if (code < LYR_TRAVEL) {
        r->decoder.run_code = code & 0xf0;
        r->decoder.run_left = run;
        return decode_run(r, o);
    }
    if (code < LYR_CIRCLE) {
        o->to = get_point(r, r->decoder.head, code > LYR_TRAVEL);
        return move(r, o, LYR_TRAVEL);
    }
    if (code <= 0x45) return decode_circle(r, o, code);
    if (code == 0x46) return decode_grid(r);
    if (code == LYR_HATCH) return decode_hatch(r, o);
    if (code >= smooth_run && code <= repeated_run) return begin_packed(r, o, code);
    if (code == LYR_WIPE) return decode_wipe(r, o);
    if (code < 0xf0) return decode_setting(r, o, code);
    const uint64_t bytes = get_varint(r);
    if (bytes > left_of(r)) return cut_off(r);
    r->cursor += bytes;
    return false;
}

// The next operation of the chunk at hand; false: there is none, or it is wrong.
static bool next_of_chunk(lyr_reader* r, lyr_operation* o) {
    const uint64_t base = r->offset + 4, begin = base + (uint64_t)(r->cursor - r->payload);
    for (bool given = false; r->error.status == LYR_OK;) {
        *o = (lyr_operation){.offset = begin};
        if (r->decoder.run_left > 0) {
            given = decode_run(r, o);
        } else if (r->decoder.stage != no_hatch) {
            given = decode_hatch_step(r, o);
        } else if (r->decoder.pieces_left > 0) {
            given = decode_wipe_piece(r, o);
        } else if (r->decoder.packed_left > 0) {
            given = decode_packed(r, o);
        } else if (r->cursor != r->payload_end) {
            given = decode(r, o);
        } else {
            if (r->operations_left == 0) return false;
            wrong(r, "the chunk has another number of operations than it says");
        }
        if (given && r->error.status == LYR_OK) return true;
    }
    r->error.offset = base + (uint64_t)(r->cursor - r->payload);
    return false;
}

bool lyr_next(lyr_reader* r, lyr_operation* o) {
    while (r->error.status == LYR_OK) {
        if (r->layer_begins) {
            *o = (lyr_operation){.kind = LYR_LAYER, .offset = r->offset, .number = r->layer.index};
            o->to = r->layer.start;
            r->layer_begins = false;
            return true;
        }
        if (r->where != in_chunk) {
            read_block(r);
        } else if (next_of_chunk(r, o)) {
            return true;
        } else if (r->error.status == LYR_OK) {
            r->where = in_layer;
            if (r->layer_chunks == r->layer.chunks) r->error.whole_layers = r->layers;
        }
    }
    return false;
}

static bool seek(lyr_reader* r, uint64_t offset) {
    r->offset = r->buffer_offset = offset;
    r->at = r->filled = 0;
    return (r->source.seek && r->source.seek(r->source.user, offset)) ||
           fail(r, LYR_UNREADABLE, "cannot go to the place that the file names");
}

bool lyr_seek_layer(lyr_reader* r, uint32_t index) {
    const uint64_t size = r->source.size, last = end_bytes + frame_bytes;
    r->error = (lyr_error){LYR_OK};
    r->where = before_layers;
    r->layer_begins = false;
    r->sought = true;
    r->layers = index;
    if (size < last || !seek(r, size - last) || !next_block(r) || r->type != end_block ||
        r->length != end_bytes)
        return fail(r, LYR_CUT_SHORT, "the file is cut short: no end block");
    if (!take_payload(r)) return false;
    const uint32_t layers = get_u32(r->payload);
    if (!seek(r, get_u64(r->payload + 28)) || !next_block(r)) return false;
    if (r->type != index_block || r->length != (uint64_t)layers * 8)
        return wrong(r, "the file has no index");
    if (!stream(r)) return false;
    if (index >= layers) return fail(r, LYR_NO_SUCH_LAYER, "there is no such layer");
    if (!seek(r, r->offset + 4 + (uint64_t)index * 8) || !fill(r, 8)) return false;
    if (!seek(r, get_u64(r->buffer)) || !next_block(r)) return false;
    return r->type == layer_block ? read_layer(r) : wrong(r, "the index does not lead to a layer");
}
