// A loop over blocks around one over the operations of a chunk. An operation says how many steps it
// has (motions of a run, pieces of a wipe, rows of a hatch), which are then taken one by one.
// Errors stick: behind the first one all reads as zeros, and nothing is given out. Numbers have 64
// bits and the format's limits; one that is too large is noted and makes its step an error.
#include "lyr.h"

enum { before_layers, layer_begins, in_layer, in_chunk, behind_layers };
enum { metadata_block = 1, layer_block, chunk_block, index_block, end_block };
enum { grid_code = 0x46, smooth_run = 0x48, parallel_run, repeated_run, skippable = 0xf0 };
enum { head_bytes = 4, prologue_bytes = 16, end_bytes = 36, longest_payload = 65528 };
static const uint32_t right_crc = 0x48674bc7;  // of any bytes with their CRC behind them
static const int64_t coordinate_limit = 0x7fffffff, row_limit = INT64_C(1) << 32;
static const int64_t farthest_beside = INT64_C(1) << 36, unit = INT64_C(1) << 30;
static const int64_t hatch_limit = INT64_C(3) << 30, offset_limit = INT64_C(3) << 54;

static bool fine(const lyr_reader* r) { return r->status == LYR_OK; }
static uint64_t left_of(const lyr_reader* r) { return (uint64_t)(r->end - r->at.cursor); }
static uint64_t chunks_begun(const lyr_reader* r) { return r->chunks - r->chunks_before; }
static uint64_t place(const lyr_reader* r) {
    return r->offset + head_bytes + (uint64_t)(r->at.cursor - r->buffer);
}

static bool fail(lyr_reader* r, lyr_status status) {
    if (fine(r) && status == LYR_CUT_SHORT) r->offset = r->behind;
    if (fine(r) && status != LYR_CUT_SHORT && r->where == in_chunk) r->offset = place(r);
    if (fine(r)) r->status = status;
    r->at.cursor = r->end;
    return false;
}
static bool check(lyr_reader* r, bool right) { return right || fail(r, LYR_NONSENSE); }

// Numbers.

static bool beyond(int64_t value, int64_t limit) { return value < -limit || value > limit; }

// For `from` within three times the limit.
static int64_t add(lyr_reader* r, int64_t from, int64_t step, int64_t limit) {
    const int64_t sum = beyond(step, 4 * limit) ? step : from + step;
    r->too_large |= beyond(sum, limit);
    return beyond(sum, limit) ? 0 : sum;
}

static int32_t coordinate(lyr_reader* r, int64_t from, int64_t step) {
    return (int32_t)add(r, from, step, coordinate_limit);
}

// value / 2^bits to the nearest whole number, halves up.
static int64_t rounded(int64_t value, int bits) {
    return (value + (INT64_C(1) << (bits - 1))) >> bits;
}

static uint64_t get_fixed(const uint8_t* at, unsigned bytes) {
    uint64_t value = 0;
    while (bytes-- > 0) value = value << 8 | at[bytes];
    return value;
}

static uint32_t crc32c(const uint8_t* bytes, uint32_t count, uint32_t before) {
    // Four bits a step: a table that is small enough for any board.
    static const uint32_t table[16] = {0x00000000, 0x105ec76f, 0x20bd8ede, 0x30e349b1,
                                       0x417b1dbc, 0x5125dad3, 0x61c69362, 0x7198540d,
                                       0x82f63b78, 0x92a8fc17, 0xa24bb5a6, 0xb21572c9,
                                       0xc38d26c4, 0xd3d3e1ab, 0xe330a81a, 0xf36e6f75};
    uint32_t crc = ~before;
    while (count-- > 0) {
        crc ^= *bytes++;
        crc = crc >> 4 ^ table[crc & 15];
        crc = crc >> 4 ^ table[crc & 15];
    }
    return ~crc;
}

// The payload at hand.

static uint8_t get_byte(lyr_reader* r) {
    return check(r, r->at.cursor != r->end) ? *r->at.cursor++ : 0;
}

static uint64_t get_varint(lyr_reader* r) {
    uint64_t value = 0;
    for (int shift = 0; shift < 63; shift += 7) {
        const uint8_t next = get_byte(r);
        value |= (uint64_t)(next & 0x7f) << shift;
        if (next < 0x80) return value;
    }
    const uint8_t last = get_byte(r);  // room for one bit only
    if (last > 1) r->at.cursor = r->end;
    check(r, last <= 1);
    return value | (uint64_t)last << 63;
}

static int64_t unzigzag(uint64_t value) { return (int64_t)(value >> 1) ^ -(int64_t)(value & 1); }
static int64_t get_signed(lyr_reader* r) { return unzigzag(get_varint(r)); }

static uint32_t get_setting(lyr_reader* r) {
    const uint64_t value = get_varint(r);
    r->too_large |= value > UINT32_MAX;
    return (uint32_t)value;
}

static lyr_point get_point(lyr_reader* r, lyr_point from, bool climbs) {
    from.x = coordinate(r, from.x, get_signed(r));
    from.y = coordinate(r, from.y, get_signed(r));
    if (climbs) from.z = coordinate(r, from.z, get_signed(r));
    return from;
}

// Blocks.

static bool read_bytes(lyr_reader* r, uint8_t* to, uint32_t count) {
    for (uint32_t got; count > 0; to += got, count -= got, r->behind += got) {
        got = fine(r) ? (uint32_t)r->source.read(r->source.user, to, count) : 0;
        if (got == 0 || got > count) return fail(r, got == 0 ? LYR_CUT_SHORT : LYR_UNREADABLE);
        r->crc = crc32c(to, got, r->crc);
    }
    return true;
}

static bool read_head(lyr_reader* r) {
    if (r->has_head || !fine(r)) return fine(r);
    r->offset = r->behind;
    r->crc = 0;
    r->has_head = read_bytes(r, r->buffer, head_bytes);
    r->type = r->buffer[0];
    r->length = (uint32_t)get_fixed(r->buffer + 1, 3);
    return r->has_head;
}

// Reads and checks the block; one that is to be used must be whole in the buffer.
static bool read_payload(lyr_reader* r, bool whole) {
    uint8_t crc[4];
    r->has_head = r->too_large = false;
    r->index_crc = 0;
    if (whole && r->length > r->capacity) return fail(r, LYR_TOO_LONG);
    for (uint32_t left = r->length, count; left > 0;) {
        count = left < r->capacity ? left : r->capacity;
        left -= count;
        if (!read_bytes(r, r->buffer, count)) return false;
        if (r->type == index_block) r->index_crc = crc32c(r->buffer, count, r->index_crc);
        if (r->source.extra && (r->type >= 0x80 || r->type == metadata_block))
            r->source.extra(r->source.user, r->type, r->buffer, count, left);
    }
    if (!read_bytes(r, crc, sizeof crc)) return false;
    if (r->crc != right_crc) return fail(r, LYR_DAMAGED);
    r->at.cursor = r->buffer;
    r->end = r->buffer + (whole ? r->length : 0);
    return true;
}

static uint32_t get_settings(lyr_reader* r, lyr_setting* settings, uint32_t most, bool heaters) {
    const uint64_t count = get_varint(r);
    check(r, count <= most);
    for (uint32_t i = 0; i < count && fine(r); ++i) {
        settings[i].kind = heaters ? get_setting(r) : 0;
        settings[i].number = get_setting(r);
        settings[i].value = get_setting(r);
        check(r, settings[i].kind <= 2 && (heaters || settings[i].value <= 1000));
    }
    return (uint32_t)count;
}

static void begin_layer(lyr_reader* r) {
    lyr_layer* l = &r->layer;
    uint32_t* const settings[] = {&l->thickness,      &l->travel_speed,  &l->travel_acceleration,
                                  &l->tool,           &l->object,        &l->retracted,
                                  &l->retract_length, &l->retract_speed, &l->unretract_speed};
    uint8_t entry[8];
    for (int i = 0; i < 8; ++i) entry[i] = (uint8_t)(r->offset >> (8 * i) & 0xff);
    r->offsets_crc = crc32c(entry, sizeof entry, r->offsets_crc);
    *l = (lyr_layer){.index = get_setting(r)};
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
    check(r, !r->too_large && l->extruded <= INT64_MAX && l->travelled <= INT64_MAX);
    check(r, l->index == r->layers++);
    if (fine(r) && l->chunks == 0) r->whole_layers = r->layers;
    r->style = (lyr_style){.flow = 100000};
    r->at = (struct lyr_place){.head = l->start};
    r->decoder = (struct lyr_decoder){0};
    r->chunks_before = r->chunks;
    r->operations_before = r->operations;
    r->where = layer_begins;
}

static void begin_chunk(lyr_reader* r) {
    const uint64_t layer = get_varint(r), chunk = get_varint(r);
    r->decoder.operations = get_varint(r);
    check(r, layer == r->layer.index && chunk == chunks_begun(r) && chunk < r->layer.chunks);
    r->operations += r->decoder.operations;
    ++r->chunks;
    r->where = in_chunk;
}

static void end_file(lyr_reader* r) {
    const uint64_t stated[] = {r->chunks, r->operations, r->behind, r->index_offset};
    bool right = r->length == end_bytes && get_fixed(r->buffer, 4) == r->layers;
    for (int i = r->sought ? 2 : 0; i < 4; ++i)
        right &= get_fixed(r->buffer + 4 + 8 * i, 8) == stated[i];
    if (!check(r, right)) return;
    r->offset = r->behind;
    check(r, !read_bytes(r, r->buffer, 1));
    if (r->status == LYR_CUT_SHORT) r->status = LYR_END;
}

static void read_block(lyr_reader* r) {
    static const uint8_t due[] = {[layer_block] = 1 << before_layers | 1 << in_layer,
                                  [chunk_block] = 1 << in_layer,
                                  [index_block] = 1 << before_layers | 1 << in_layer,
                                  [end_block] = 1 << behind_layers};
    const uint8_t type = r->type;
    const bool used = type <= end_block && due[type] >> r->where & 1;
    if (!read_payload(r, used && type != index_block)) return;
    if (!used && type < 0x80)
        fail(r, type > 0 && type <= end_block ? LYR_NONSENSE : LYR_UNSUPPORTED);
    if (used && type != chunk_block && r->where == in_layer)
        check(r, chunks_begun(r) == r->layer.chunks &&
                     r->operations - r->operations_before == r->layer.operations);
    if (!used || !fine(r)) return;
    if (type == layer_block) begin_layer(r);
    if (type == chunk_block) begin_chunk(r);
    if (type == end_block) end_file(r);
    if (type != index_block) return;
    check(r, r->sought || (r->index_crc == r->offsets_crc && r->length == 8 * (uint64_t)r->layers));
    r->index_offset = r->offset;
    r->where = behind_layers;
}

// Motions. What takes a step returns whether there is something to give out.

// |s| <= 1.25 chords: (4 s)^2 <= (5 x)^2 + (5 y)^2. Doubles, which are off by less than 2^24,
// decide all but what is so near that the low 64 bits of the squares do.
static bool is_arc(int64_t s, int64_t x, int64_t y) {
    static const double near = 1099511627776.0;  // 2^40
    const double a = 4 * (double)s, b = 5 * (double)x, c = 5 * (double)y;
    const uint64_t u = 4 * (uint64_t)s, v = 5 * (uint64_t)x, w = 5 * (uint64_t)y;
    const double over = a * a - b * b - c * c;
    const uint64_t low = u * u - v * v - w * w;
    return over < -near || (over <= near && (low == 0 || low >> 63));
}

// To o->to. Lines and arcs that do not climb may be referred to by packed runs.
static bool move(lyr_reader* r, lyr_operation* o, lyr_kind kind) {
    const lyr_point from = o->from = r->at.head, to = r->at.head = o->to;
    const int64_t x = (int64_t)to.x - from.x, y = (int64_t)to.y - from.y, s = o->sagitta;
    const bool moves = x != 0 || y != 0 || to.z != from.z, draws = kind <= LYR_ARC;
    o->kind = kind;
    check(r, !r->too_large && (r->decoder.has_path || !(draws || kind == LYR_CIRCLE)));
    check(r, s == 0 ? kind != LYR_ARC : is_arc(s, x, y));
    if (moves && draws && !o->hatch && !(r->decoder.code & 0x20))
        r->history[r->decoder.motions++ % LYR_HISTORY] =
            (lyr_motion){from.x, from.y, to.x, to.y, s};
    return moves && fine(r);
}

static bool take_motion(lyr_reader* r, lyr_operation* o) {
    const uint8_t code = r->decoder.code;
    const bool run = code < LYR_TRAVEL, circle = code >= LYR_CIRCLE && code < grid_code;
    const bool climbs = run ? code & 0x20 : code == LYR_TRAVEL + 1 || (circle && code >= 0x44);
    const lyr_point head = r->at.head;
    --r->at.left;
    o->to = get_point(r, head, climbs);
    if (code == LYR_WIPE || (run && code & 0x10)) o->sagitta = get_signed(r);
    if (run) return move(r, o, code & 0x10 ? LYR_ARC : LYR_LINE);
    if (!circle) return move(r, o, code == LYR_WIPE ? LYR_WIPE : LYR_TRAVEL);
    check(r, o->to.x != head.x || o->to.y != head.y);
    o->center_x = o->to.x;
    o->center_y = o->to.y;
    o->counter_clockwise = code % 2 == 0;
    o->to = (lyr_point){head.x, head.y, o->to.z};
    move(r, o, LYR_CIRCLE);
    return true;
}

void lyr_wipe_again(lyr_reader* r) { r->at = r->wipe; }

// Checked and counted as a whole first.
static bool take_wipe(lyr_reader* r, lyr_operation* o, bool begins) {
    if (begins) {
        r->at.depth = get_setting(r);
        r->at.left = get_varint(r);
        r->at.moves = 0;
        check(r, !r->too_large && r->at.left <= left_of(r) / 3);
        r->wipe = r->at;
        while (r->at.left > 0 && fine(r)) r->wipe.moves += take_motion(r, o);
        if (fine(r)) lyr_wipe_again(r);
        return false;
    }
    o->value = r->at.depth;
    o->number = r->at.moves;
    return take_motion(r, o) && r->at.moves-- > 0;
}

// Packed runs. The specification gives the order of operations: each must be rounded by itself.

// By the root of mantissa x 2^54, two bits a step: a bit more than a double has, which rounds it.
static double square_root(double value) {
    double scale = 1 / 67108864.0;  // 2^-26
    if (!(value > 0)) return 0;
    for (; value >= 18014398509481984.0; scale *= 2) value /= 4;  // 2^54
    for (; value < 4503599627370496.0; scale /= 2) value *= 4;    // 2^52
    uint64_t root = 0, rest = 0;
    for (int i = 52; i > -56; i -= 2) {
        rest = rest << 2 | (i >= 0 ? (uint64_t)value >> i & 3 : 0);
        const uint64_t next = root << 2 | 1, fits = rest >= next;
        rest -= fits ? next : 0;
        root = root << 1 | fits;
    }
    return (double)((root + 1) >> 1) * scale;
}

static int64_t nearest(double value) {
    static const double limit = 1099511627776.0, whole = 6755399441055744.0;  // 2^40, 1.5 x 2^52
    return value > -limit && value < limit ? (int64_t)((value + whole) - whole) : 0;
}

static uint64_t get_bits(lyr_reader* r, unsigned count) {
    uint64_t value = 0;
    for (unsigned i = 0; i < count && check(r, r->at.cursor != r->end); ++i) {
        value |= (uint64_t)(*r->at.cursor >> r->decoder.bit & 1) << i;
        r->decoder.bit = (uint8_t)((r->decoder.bit + 1) % 8);
        r->at.cursor += r->decoder.bit == 0;
    }
    return value;
}

static int64_t get_difference(lyr_reader* r, unsigned order) {
    unsigned zeros = 0;
    while (zeros <= 40 && get_bits(r, 1) == 0) ++zeros;
    if (zeros > 40) r->at.cursor = r->end;
    return unzigzag(get_bits(r, zeros + order) + (((UINT64_C(1) << zeros) - 1) << order));
}

// The length of a motion's chord. Each is asked for twice in turn, and roots take long.
static double length_of(struct lyr_decoder* d, uint64_t number, double square) {
    if (number + 1 != d->measured) d->length = square_root(square);
    d->measured = number + 1;
    return d->length;
}

// A motion's direction where it starts (side 1) or ends (-1), of length `size`.
struct direction {
    double x, y, size, curvature;
};
static struct direction direction_of(lyr_reader* r, uint64_t number, double side) {
    const lyr_motion* m = &r->history[number % LYR_HISTORY];
    const double x = (double)m->to_x - m->from_x, y = (double)m->to_y - m->from_y;
    const double s = (double)m->sagitta, square = x * x + y * y, rise = 4 * s * s;
    const double length = length_of(&r->decoder, number, square), sum = square + rise;
    const double along = square - rise, across = side * (4 * s * length);
    return (struct direction){x * along + y * across, y * along - x * across, length * sum,
                              8 * s / sum};
}

// Adds the place and the sagitta to expect beside motion `number`.
static void go_beside(lyr_reader* r, uint64_t number, int64_t sum[3]) {
    const lyr_motion *old = &r->history[number % LYR_HISTORY],
                     *next = &r->history[(number + 1) % LYR_HISTORY];
    const double distance = (double)r->decoder.distance / 16;
    const bool joined = next->from_x == old->to_x && next->from_y == old->to_y;
    const struct direction e = direction_of(r, number, -1);
    struct direction n = joined ? direction_of(r, number + 1, 1) : e;
    double cosine = e.x * n.x + e.y * n.y, one = e.size * n.size;
    if (cosine < -0.5 * one) {
        n = e;
        cosine = one = e.size * e.size;
    }
    const double reach = distance / (one + cosine);
    sum[0] += nearest(old->to_x - reach * (e.y * n.size + n.y * e.size));
    sum[1] += nearest(old->to_y + reach * (e.x * n.size + n.x * e.size));
    sum[2] += nearest((double)old->sagitta * (1 - distance * e.curvature));
}

// The sagitta that goes on smoothly from the motion before, along the chord (x, y).
static int64_t smooth_sagitta(lyr_reader* r, const lyr_motion* m, double x, double y) {
    struct lyr_decoder* d = &r->decoder;
    const double x0 = (double)m->to_x - m->from_x, y0 = (double)m->to_y - m->from_y;
    const double c0 = length_of(d, d->motions - 1, x0 * x0 + y0 * y0);
    const double c = length_of(d, d->motions, x * x + y * y);
    const double along = x0 * x + y0 * y, across = x0 * y - y0 * x;
    const double turn = c0 * c + along, rise = 2 * (double)m->sagitta;
    const double e = c * (across * c0 - rise * turn) / (2 * (c0 * turn + across * rise));
    return 4 * e > c || -4 * e > c ? 0 : nearest(e);
}

static bool take_packed(lyr_reader* r, lyr_operation* o) {
    struct lyr_decoder* d = &r->decoder;
    const lyr_motion* last = &r->history[(d->motions - 1) % LYR_HISTORY];
    const lyr_motion* old = &r->history[d->old++ % LYR_HISTORY];
    const int32_t x = r->at.head.x, y = r->at.head.y;
    int64_t sum[3];
    for (int i = 0; i < 3; ++i) sum[i] = get_difference(r, i < 2 ? d->orders & 15 : d->orders >> 4);
    if (--r->at.left == 0) get_bits(r, (8u - d->bit) % 8);
    if (d->code == smooth_run && d->motions > 0 && last->to_x == x && last->to_y == y)
        sum[2] += smooth_sagitta(r, last, (double)sum[0], (double)sum[1]);
    if (d->code == parallel_run) {
        go_beside(r, d->old - 1, sum);
    } else {
        const bool repeats = d->code == repeated_run;
        sum[0] += x + (repeats ? (int64_t)old->to_x - old->from_x : 0);
        sum[1] += y + (repeats ? (int64_t)old->to_y - old->from_y : 0);
        sum[2] += repeats ? old->sagitta : 0;
    }
    o->to = (lyr_point){coordinate(r, 0, sum[0]), coordinate(r, 0, sum[1]), r->at.head.z};
    o->sagitta = sum[2];
    return check(r, move(r, o, o->sagitta == 0 ? LYR_LINE : LYR_ARC));
}

static bool begin_packed(lyr_reader* r) {
    struct lyr_decoder* d = &r->decoder;
    const int64_t kept = d->motions < LYR_HISTORY ? (int64_t)d->motions : LYR_HISTORY;
    const int64_t least = d->code == parallel_run ? 2 : 1;
    if (d->code != smooth_run) d->back = add(r, d->back, get_signed(r), LYR_HISTORY);
    check(r, d->code == smooth_run || (d->back >= least && d->back <= kept));
    if (d->code == parallel_run) d->distance = add(r, d->distance, get_signed(r), farthest_beside);
    check(r, !r->too_large);
    d->old = d->motions - (uint64_t)d->back;
    r->at.left = get_varint(r);
    d->orders = get_byte(r);
    d->bit = 0;
    d->operations -= r->at.left - 1;
    // Each motion takes three bits at least.
    check(r, d->has_path && r->at.left > 0 && r->at.left <= left_of(r) * 8 / 3);
    return false;
}

// Hatches.

static bool begin_hatch(lyr_reader* r, lyr_operation* o) {
    struct lyr_decoder* d = &r->decoder;
    const uint8_t flags = get_byte(r);
    d->row = add(r, 0, get_signed(r), row_limit);
    r->at.left = get_varint(r);
    d->one_way = flags & 1;
    d->forward = !(flags & 2);
    d->group_rows = d->intervals = d->alike = 0;
    d->ends_left = 0;
    d->last = 0;
    o->kind = LYR_HATCH;
    check(r, flags <= 3 && d->has_path && d->has_grid);
    return check(r, !r->too_large && r->at.left <= (uint64_t)row_limit);
}

// Rows come in groups of as many intervals each.
static void begin_row(lyr_reader* r) {
    struct lyr_decoder* d = &r->decoder;
    if (d->group_rows == 0) {
        const uint64_t code = get_varint(r), rows = d->group_rows = get_varint(r), n = code >> 1;
        // Each interval has two values of a byte at least.
        const uint64_t most = left_of(r) / 2;
        check(r, rows - 1 < r->at.left && (n == 0 || (n <= most && rows <= most / n)));
        d->alike = n == d->intervals ? d->alike : 0;
        d->intervals = n;
        d->linked = code & 1;
    }
    // Doubles tell what is so far off that it would overflow.
    const double far = (double)d->row * (double)r->grid[3], most = 3 * (double)offset_limit;
    const bool near = far > -most && far < most;
    if (d->intervals == 0 || !fine(r)) return;
    d->row_offset = near ? r->grid[2] + d->row * r->grid[3] : INT64_MAX;
    d->row_offset = rounded(add(r, 0, d->row_offset, offset_limit), 24);
    check(r, !r->too_large);
    d->ends_left = 2 * d->intervals;
}

static bool take_end(lyr_reader* r, lyr_operation* o) {
    struct lyr_decoder* d = &r->decoder;
    const int64_t a = r->grid[0], b = r->grid[1], w = d->row_offset;
    const bool links = d->linked && d->ends_left == 2 * d->intervals;
    const uint64_t j = d->forward ? 2 * d->intervals - d->ends_left : d->ends_left - 1;
    const uint64_t known = d->intervals <= 32 ? d->alike : 0;
    int64_t* const before = d->ends[d->intervals <= 32 ? j : 0];  // in the last two rows
    const int64_t expected = known == 0   ? d->last
                             : known == 1 ? before[0]
                                          : 2 * before[0] - before[1];
    const int64_t u = d->last = add(r, expected, get_signed(r), hatch_limit);
    before[1] = before[0];
    before[0] = u;
    o->hatch = true;
    o->to.x = coordinate(r, 0, rounded(u * a - w * b, 30));
    o->to.y = coordinate(r, 0, rounded(u * b + w * a, 30));
    o->to.z = r->at.head.z;
    return move(r, o, d->ends_left-- % 2 == 0 && !links ? LYR_TRAVEL : LYR_LINE);
}

static bool take_hatch(lyr_reader* r, lyr_operation* o) {
    struct lyr_decoder* d = &r->decoder;
    if (d->ends_left == 0) begin_row(r);
    if (!fine(r)) return false;
    const bool given = d->ends_left > 0 && take_end(r, o);
    if (d->ends_left > 0) return given;
    const uint64_t rows = d->intervals > 0 ? 1 : d->group_rows;
    r->at.left -= rows;
    d->group_rows -= rows;
    d->row += (int64_t)rows;
    d->alike += rows;
    d->forward ^= !d->one_way && rows % 2 == 1;
    return given;
}

// Operations.

static bool set_grid(lyr_reader* r) {
    int64_t* const g = r->grid;
    for (int i = 0; i < 4; ++i) g[i] = get_signed(r);
    check(r, !beyond(g[0], unit) && !beyond(g[1], unit) && !beyond(g[2], offset_limit) &&
                 !beyond(g[3], offset_limit) &&
                 !beyond(g[0] * g[0] + g[1] * g[1] - unit * unit, 2 * unit));
    r->decoder.has_grid = true;
    return false;
}

static bool take_setting(lyr_reader* r, lyr_operation* o) {
    lyr_style* s = &r->style;
    uint32_t* const fields[] = {&s->width, &s->height, &s->flow, &s->speed, &s->acceleration};
    const uint8_t code = r->decoder.code;
    o->kind = (lyr_kind)code;
    if (code == LYR_PATH) {
        const uint8_t role = get_byte(r), stated = get_byte(r);
        s->role = role < 19 ? role : 0;
        check(r, stated <= 31);
        for (int i = 0; i < 5; ++i)
            if (stated >> i & 1) *fields[i] = get_setting(r);
        return r->decoder.has_path = check(r, !r->too_large);
    }
    check(r, code > LYR_PATH && code <= LYR_OBJECT);
    check(r, code >= LYR_TRAVEL_SPEED || r->decoder.has_path);
    if (code == LYR_TEMPERATURE) o->heater = get_byte(r);
    if (code == LYR_TEMPERATURE || code == LYR_FAN) o->number = get_setting(r);
    o->value = code == LYR_PAUSE ? get_byte(r) == 1 : get_setting(r);
    if (code == LYR_TEMPERATURE) o->wait = get_byte(r) != 0;
    if (fine(r) && code < LYR_TRAVEL_SPEED)
        *fields[code == LYR_WIDTH ? 0 : code - LYR_SPEED + 3] = o->value;
    return check(r, !r->too_large && o->heater <= 2 && (code != LYR_FAN || o->value <= 1000));
}

// A step of the operation at hand, or the beginning of the next one.
static bool take_step(lyr_reader* r, lyr_operation* o) {
    const bool begins = r->at.left == 0;
    const uint8_t code = r->decoder.code = begins ? get_byte(r) : r->decoder.code;
    r->decoder.operations -= begins;
    if (code == grid_code) return set_grid(r);
    if (code == LYR_HATCH) return begins ? begin_hatch(r, o) : take_hatch(r, o);
    if (code == LYR_WIPE) return take_wipe(r, o, begins);
    if (code >= smooth_run && code <= repeated_run)
        return begins ? begin_packed(r) : take_packed(r, o);
    if (code >= skippable) {
        const uint64_t bytes = get_varint(r), left = left_of(r);
        r->at.cursor += bytes < left ? bytes : left;
        check(r, bytes <= left);
        return false;
    }
    if (code > LYR_HATCH) return take_setting(r, o);
    if (begins) r->at.left = code < LYR_TRAVEL ? (code & 15) + 1 : 1;
    if (begins) r->decoder.operations -= r->at.left - 1;
    return take_motion(r, o);
}

bool lyr_next(lyr_reader* r, lyr_operation* o) {
    uint64_t begin = place(r);
    while (fine(r)) {
        *o = (lyr_operation){.offset = begin};
        if (r->where == layer_begins) {
            *o = (lyr_operation){.kind = LYR_LAYER, .number = r->layer.index, .offset = r->offset};
            o->to = r->layer.start;
            r->where = in_layer;
            return true;
        }
        if (r->where != in_chunk) {
            if (read_head(r)) read_block(r);
            begin = place(r);
        } else if (r->at.left > 0 || left_of(r) > 0) {
            if (take_step(r, o) && fine(r)) return true;
        } else if (check(r, r->decoder.operations == 0)) {
            r->where = in_layer;
            if (chunks_begun(r) == r->layer.chunks) r->whole_layers = r->layers;
        }
    }
    return false;
}

bool lyr_open(lyr_reader* r, const lyr_source* source, void* buffer, uint32_t size) {
    static const uint8_t magic[] = {'L', 'Y', 'R', 0x1a};
    const uint8_t* at = buffer;
    *r = (lyr_reader){.source = *source, .buffer = buffer};
    r->capacity = size < longest_payload ? size : longest_payload;
    if (size < LYR_LEAST_BUFFER) return fail(r, LYR_TOO_LONG);
    const bool whole = read_bytes(r, r->buffer, prologue_bytes);
    for (size_t i = 0; i < sizeof magic && i < r->behind; ++i)
        if (at[i] != magic[i]) {
            r->status = LYR_NO_LYR;
            r->offset = 0;
            return false;
        }
    if (!whole || r->crc != right_crc) return fail(r, LYR_DAMAGED);
    r->major = (uint32_t)get_fixed(at + 4, 2);
    r->minor = (uint32_t)get_fixed(at + 6, 2);
    r->quantum_nm = (uint32_t)get_fixed(at + 8, 4);
    r->offset = r->major == 1 ? 8 : 4;
    if (r->major != 1) return fail(r, LYR_UNSUPPORTED);
    if (!check(r, r->quantum_nm - 1 <= 999999) || !read_head(r) ||
        !check(r, r->type == metadata_block) || !read_payload(r, true))
        return false;
    while (read_head(r) && r->type != layer_block && r->type != index_block) read_block(r);
    return fine(r);
}

static bool go_to(lyr_reader* r, uint64_t offset, uint8_t type) {
    r->behind = offset;
    r->has_head = false;
    if (!r->source.seek || !r->source.seek(r->source.user, offset)) return fail(r, LYR_UNREADABLE);
    return read_head(r) &&
           (r->type == type || fail(r, type == end_block ? LYR_CUT_SHORT : LYR_NONSENSE));
}

bool lyr_seek_layer(lyr_reader* r, uint32_t index) {
    const uint64_t size = r->source.size, last = head_bytes + end_bytes + 4;
    r->status = LYR_OK;
    r->whole_layers = 0;
    r->where = before_layers;
    r->sought = true;
    r->layers = index;
    if (!go_to(r, size < last ? 0 : size - last, end_block) || !read_payload(r, true)) return false;
    const uint64_t layers = get_fixed(r->buffer, 4);
    if (!go_to(r, get_fixed(r->buffer + 28, 8), index_block) || !read_payload(r, false))
        return false;
    if (!check(r, r->length == layers * 8)) return false;
    if (index >= layers) return fail(r, LYR_NO_SUCH_LAYER);
    const uint64_t entry = r->offset + head_bytes + (uint64_t)index * 8;
    if (!r->source.seek(r->source.user, entry) || !read_bytes(r, r->buffer, 8))
        return fail(r, LYR_UNREADABLE);
    if (go_to(r, get_fixed(r->buffer, 8), layer_block)) read_block(r);
    return fine(r);
}
