// A loop over blocks around one over the operations of a chunk. An operation says how many steps it
// has (motions of a run, pieces of a wipe, rows of a hatch), which are then taken one by one.
// Errors stick: behind the first one all reads as zeros, and nothing is given out. A number that is
// too large is noted, reads as 0, and makes its step an error.
#include "lyr.h"

enum { metadata_block = 1, layer_block, chunk_block, index_block, end_block };
enum { due_first = 1 << layer_block | 1 << index_block };  // a bit for each type
enum { helix_code = 0x44, grid_code = 0x46, smooth_run = 0x48, parallel_run, repeated_run };
enum { head_bytes = 4, crc_bytes = 4, end_bytes = 36, longest_payload = 65528, skippable = 0xf0 };
static const uint32_t right_crc = 0xb798b438;  // of any bytes with their CRC behind them
static const int64_t widest = INT64_C(1) << 57, row_limit = INT64_C(1) << 32;
static const int64_t farthest_beside = INT64_C(1) << 36, unit = INT64_C(1) << 30;
static const int64_t hatch_limit = INT64_C(3) << 30, offset_limit = INT64_C(3) << 54;

static bool fine(const lyr_reader* r) { return r->status == LYR_OK; }
static uint64_t left_of(const lyr_reader* r) { return (uint64_t)(r->end - r->at.cursor); }
static uint64_t place(const lyr_reader* r) { return r->behind - crc_bytes - left_of(r); }

static bool fail(lyr_reader* r, lyr_status status) {
    if (fine(r) && r->in_chunk) r->offset = place(r);
    if (fine(r) && status == LYR_CUT_SHORT) r->offset = r->behind;
    if (fine(r)) r->status = status;
    r->at.cursor = r->end;
    return false;
}
static bool check(lyr_reader* r, bool right) {
    return (right && !r->too_large) || fail(r, LYR_NONSENSE);
}
// Where there are fewer bytes, the error is at their end.
static bool pass(lyr_reader* r, uint64_t bytes) {
    const bool there = bytes <= left_of(r);
    r->at.cursor = there ? r->at.cursor + bytes : r->end;
    return there || fail(r, LYR_NONSENSE);
}

static int64_t within(lyr_reader* r, int64_t value, int64_t limit) {
    r->too_large |= value < -limit || value > limit;
    return r->too_large ? 0 : value;
}

static uint64_t get_fixed(const uint8_t* at, unsigned bytes) {
    uint64_t value = 0;
    while (bytes-- > 0) value = value << 8 | at[bytes];
    return value;
}

// Without the final turn of the bits.
static uint32_t crc32c(const lyr_reader* r, uint32_t crc, const uint8_t* bytes, uint32_t count) {
    while (count-- > 0) crc = crc >> 8 ^ r->crc_table[(crc ^ *bytes++) & 0xff];
    return crc;
}

static uint8_t get_byte(lyr_reader* r) {
    return left_of(r) > 0 || pass(r, 1) ? *r->at.cursor++ : 0;
}
static uint64_t get_varint(lyr_reader* r) {
    uint64_t value = 0, next = 0x80;
    for (int shift = 0; shift < 64 && next >= 0x80; shift += 7) {
        next = get_byte(r);
        if (shift == 63 && next > 1) return pass(r, UINT64_MAX);
        value |= (next & 0x7f) << shift;
    }
    return value;
}
static int64_t unzigzag(uint64_t value) { return (int64_t)(value >> 1) ^ -(int64_t)(value & 1); }
static int64_t get_signed(lyr_reader* r) { return within(r, unzigzag(get_varint(r)), widest); }
static uint32_t get_setting(lyr_reader* r) {
    const uint64_t value = get_varint(r);
    r->too_large |= value > UINT32_MAX;
    return (uint32_t)value;
}

static lyr_point point(lyr_reader* r, int64_t x, int64_t y, int64_t z) {
    x = within(r, x, INT32_MAX);
    y = within(r, y, INT32_MAX);
    return (lyr_point){(int32_t)x, (int32_t)y, (int32_t)within(r, z, INT32_MAX)};
}
static lyr_point get_point(lyr_reader* r, lyr_point from, bool climbs) {
    const int64_t x = get_signed(r), y = get_signed(r), z = climbs ? get_signed(r) : 0;
    return point(r, from.x + x, from.y + y, from.z + z);
}

// Blocks.

static bool read_bytes(lyr_reader* r, uint8_t* to, uint32_t count) {
    for (uint32_t got; count > 0; to += got, count -= got, r->behind += got) {
        got = fine(r) ? (uint32_t)r->source.read(r->source.user, to, count) : 0;
        if (got == 0 || got > count) return fail(r, got == 0 ? LYR_CUT_SHORT : LYR_UNREADABLE);
        r->crc = crc32c(r, r->crc, to, got);
    }
    return true;
}

// Reads and checks a block, and tells whether it is one that is due. That must be whole in the
// buffer, but for the index.
static bool read_block(lyr_reader* r) {
    uint8_t crc[crc_bytes];
    r->offset = r->behind;
    r->crc = r->index_crc = UINT32_MAX;
    if (!read_bytes(r, r->buffer, head_bytes)) return false;
    r->type = r->buffer[0];
    r->length = (uint32_t)get_fixed(r->buffer + 1, 3);
    const bool known = r->type > 0 && r->type <= end_block, due = known && r->due >> r->type & 1;
    const uint32_t whole = due && r->type != index_block ? r->length : 0;
    check(r, due || r->due != 1 << metadata_block);
    if (whole > r->capacity) return fail(r, LYR_TOO_LONG);
    for (uint32_t left = r->length, count; left > 0; left -= count) {
        count = left < r->capacity ? left : r->capacity;
        if (!read_bytes(r, r->buffer, count)) return false;
        if (r->type == index_block) r->index_crc = crc32c(r, r->index_crc, r->buffer, count);
    }
    r->at.cursor = r->buffer;
    r->end = r->buffer + whole;
    if (!read_bytes(r, crc, crc_bytes) || r->crc != right_crc) return fail(r, LYR_DAMAGED);
    return due || (r->type < 0x80 && fail(r, known ? LYR_NONSENSE : LYR_UNSUPPORTED));
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

static bool begin_layer(lyr_reader* r, lyr_operation* o) {
    lyr_layer* l = &r->layer;
    uint32_t* const settings[] = {&l->thickness,      &l->travel_speed,  &l->travel_acceleration,
                                  &l->tool,           &l->object,        &l->retracted,
                                  &l->retract_length, &l->retract_speed, &l->unretract_speed};
    uint32_t* const crc = &r->offsets_crc;
    *l = (lyr_layer){.index = get_setting(r)};
    l->start = get_point(r, l->start, true);
    for (size_t i = 0; i < sizeof settings / sizeof *settings; ++i) *settings[i] = get_setting(r);
    l->heater_count = get_settings(r, l->heaters, 16, true);
    l->fan_count = get_settings(r, l->fans, 8, false);
    l->time = get_varint(r);
    r->chunks += l->chunks = get_setting(r);
    r->operations += l->operations = get_varint(r);
    l->low = get_point(r, l->start, true);
    l->high = get_point(r, l->low, true);
    l->extruded = get_varint(r);
    l->travelled = get_varint(r);
    l->volume = get_varint(r);
    for (int i = 0; i < 64; i += 8) *crc = *crc >> 8 ^ r->crc_table[(*crc ^ r->offset >> i) & 0xff];
    r->style = (lyr_style){.flow = 100000};
    r->at = (struct lyr_place){.cursor = r->end, .head = l->start};
    r->decoder = (struct lyr_decoder){0};
    r->due = due_first | 1 << chunk_block;
    *o = (lyr_operation){LYR_LAYER, .number = l->index, .to = l->start, .offset = r->offset};
    return check(r, (l->extruded | l->travelled) <= INT64_MAX && l->index == r->layers++);
}

// Of the next block. Whether a layer begins, which is given out.
static bool take_block(lyr_reader* r, lyr_operation* o) {
    struct lyr_decoder* d = &r->decoder;
    const bool within_layer = r->due >> chunk_block & 1;
    if (within_layer && d->chunks == r->layer.chunks) r->whole_layers = r->layers;
    if (!read_block(r)) return false;
    if (r->type == chunk_block) {
        const uint64_t layer = get_varint(r), chunk = get_varint(r);
        d->operations += d->left = get_varint(r);
        check(r, layer == r->layer.index && chunk == d->chunks++ && chunk < r->layer.chunks);
        r->in_chunk = fine(r);
        return false;
    }
    if (within_layer)
        check(r, d->chunks == r->layer.chunks && d->operations == r->layer.operations);
    if (r->type == layer_block) return fine(r) && begin_layer(r, o);
    if (r->type == index_block) {
        r->index_offset = r->offset;
        r->due = 1 << end_block;
        check(r, r->sought || (r->index_crc == r->offsets_crc && r->length == 8ull * r->layers));
        return false;
    }
    const uint64_t stated[] = {r->chunks, r->operations, r->behind, r->index_offset};
    bool right = r->length == end_bytes && get_fixed(r->buffer, 4) == r->layers;
    for (int i = r->sought ? 2 : 0; i < 4; ++i)
        right &= get_fixed(r->buffer + 4 + 8 * i, 8) == stated[i];
    if (!check(r, right)) return false;
    r->offset = r->behind;
    check(r, !read_bytes(r, r->buffer, 1));
    if (r->status == LYR_CUT_SHORT) r->status = LYR_END;
    return false;
}

// Motions. What takes a step returns whether there is something to give out.

// |s| <= 1.25 chords. Doubles, off by less than 2^24, decide all but what is so near that the low
// 64 bits do.
static uint64_t square(int64_t value) { return (uint64_t)value * (uint64_t)value; }
static bool is_arc(int64_t s, int64_t x, int64_t y) {
    static const double near = 1099511627776.0;  // 2^40
    const double a = (double)s, b = (double)x, c = (double)y;
    const double over = 16 * a * a - 25 * (b * b + c * c);
    const uint64_t low = 16 * square(s) - 25 * (square(x) + square(y));
    return over < -near || (over <= near && (low == 0 || low >> 63));
}

// To o->to. Lines and arcs that do not climb may be referred to by packed runs.
static bool move(lyr_reader* r, lyr_operation* o, lyr_kind kind) {
    const lyr_point from = o->from = r->at.head, to = r->at.head = o->to;
    const int64_t x = (int64_t)to.x - from.x, y = (int64_t)to.y - from.y, s = o->sagitta;
    const bool moves = x != 0 || y != 0 || to.z != from.z || kind == LYR_CIRCLE;
    const bool draws = kind <= LYR_ARC;
    o->kind = kind;
    check(r, r->decoder.has_path || !(draws || kind == LYR_CIRCLE));
    check(r, s == 0 ? kind != LYR_ARC : is_arc(s, x, y));
    if (moves && draws && !o->hatch && !(r->decoder.code & 0x20))
        r->history[r->decoder.motions++ % LYR_HISTORY] =
            (struct lyr_motion){from.x, from.y, to.x, to.y, s};
    return moves && fine(r);
}

static bool take_motion(lyr_reader* r, lyr_operation* o) {
    const uint8_t code = r->decoder.code;
    const bool run = code < LYR_TRAVEL, wipes = code == LYR_WIPE;
    const bool climbs = run ? code & 0x20 : code == LYR_TRAVEL + 1 || (code & ~1) == helix_code;
    const lyr_point head = r->at.head, to = o->to = get_point(r, head, climbs);
    --r->at.left;
    if (wipes || (run && code & 0x10)) o->sagitta = get_signed(r);
    if (run) return move(r, o, code & 0x10);
    if (code < LYR_CIRCLE) return move(r, o, LYR_TRAVEL);
    if (wipes) {
        o->value = r->depth;
        o->way = r->way;
        return move(r, o, LYR_WIPE);
    }
    o->center_x = to.x;
    o->center_y = to.y;
    o->counter_clockwise = code % 2 == 0;
    o->to = (lyr_point){head.x, head.y, to.z};
    check(r, to.x != head.x || to.y != head.y);
    return move(r, o, LYR_CIRCLE);
}

// Of 0 or at least 1: Newton's way from a root that is off by 6 % at most, and the nearest of its
// neighbours, c 2^-26. Of squares that are so near, the low 64 bits tell how they differ.
static double square_root(double value) {
    union {
        double number;
        uint64_t bits;
    } v = {value}, scale;
    if (!(value >= 1)) return 0;
    const uint64_t half = ((v.bits >> 52) - 1023) / 2;
    v.bits += (52 - 2 * half) << 52;  // to 2^52 .. 2^54
    scale.bits = (1023 + half - 52) << 52;
    double root = v.number / 201326592.0 + 44739243.0;  // 3 x 2^26, 2^27 / 3
    for (int i = 0; i < 4; ++i) root = (root + v.number / root) / 2;
    const int64_t c = (int64_t)(root * 67108864.0);  // 2^26
    const int64_t rest = (int64_t)(((uint64_t)v.number << 52) - (uint64_t)c * (uint64_t)c);
    return (double)(c + (rest > c) - (rest <= -c)) * scale.number;
}

// An arc is as long as its chord once it was halved so often that it is flat.
static double length_of(const lyr_operation* o) {
    static const double flat = 1e-10;  // of a slope's square: what the length is off by
    const double x = (double)o->to.x - o->from.x, y = (double)o->to.y - o->from.y;
    double length = square_root(x * x + y * y), slope = 2 * (double)o->sagitta / length, longer;
    for (; slope * slope > flat; slope /= 1 + longer)
        length *= longer = square_root(1 + slope * slope);
    return length;
}

// Checked and measured as a whole first.
static bool begin_wipe(lyr_reader* r, lyr_operation* o) {
    r->depth = get_setting(r);
    r->at.left = get_varint(r);
    r->way = 0;
    check(r, r->at.left <= left_of(r) / 3);
    const struct lyr_place first = r->at;
    while (r->at.left > 0 && fine(r)) r->way += take_motion(r, o) ? length_of(o) : 0;
    if (fine(r)) r->at = first;
    return false;
}

// Packed runs. The specification gives the order of operations: each must be rounded by itself.

static int64_t nearest(double value) {
    static const double limit = 1099511627776.0, whole = 6755399441055744.0;  // 2^40, 1.5 x 2^52
    return value > -limit && value < limit ? (int64_t)((value + whole) - whole) : 0;
}

// The bits ahead, at least 57; zeros behind the end.
static uint64_t bits_ahead(const lyr_reader* r) {
    const uint8_t* at = r->at.cursor;
    const uint64_t left = left_of(r);
    return (left < 8 ? get_fixed(at, (unsigned)left) : get_fixed(at, 8)) >> r->decoder.bit;
}

static void pass_bits(lyr_reader* r, unsigned count) {
    const unsigned behind = r->decoder.bit + count;
    if (pass(r, (behind + 7) / 8)) r->at.cursor -= behind % 8 > 0;
    r->decoder.bit = behind % 8;
}

static int64_t get_difference(lyr_reader* r, unsigned order) {
    const uint64_t ahead = bits_ahead(r);
    unsigned zeros = 0;
    while (zeros <= 40 && !(ahead >> zeros & 1)) ++zeros;
    pass_bits(r, zeros > 40 ? UINT32_MAX / 2 : zeros + 1);
    const unsigned width = zeros + order;
    const uint64_t low = bits_ahead(r) & ((UINT64_C(1) << width) - 1);
    pass_bits(r, width);
    return unzigzag(low + (((UINT64_C(1) << zeros) - 1) << order));
}

// A motion's direction where it starts (side 1) or ends (-1), of length `size`.
struct direction {
    double x, y, size, curvature;
};
static struct direction direction_of(const struct lyr_motion* m, double side) {
    const double x = (double)m->to_x - m->from_x, y = (double)m->to_y - m->from_y;
    const double s = (double)m->sagitta, square = x * x + y * y, rise = 4 * s * s;
    const double length = square_root(square), sum = square + rise;
    const double along = square - rise, across = side * (4 * s * length);
    return (struct direction){x * along + y * across, y * along - x * across, length * sum,
                              8 * s / sum};
}

// The place and the sagitta to expect beside `old`.
static void go_beside(const struct lyr_motion* old, const struct lyr_motion* next, double off,
                      int64_t to[3]) {
    const bool joined = next->from_x == old->to_x && next->from_y == old->to_y;
    const struct direction e = direction_of(old, -1);
    struct direction n = joined ? direction_of(next, 1) : e;
    double cosine = e.x * n.x + e.y * n.y, one = e.size * n.size;
    if (cosine < -0.5 * one) {
        n = e;
        cosine = one = e.size * e.size;
    }
    const double reach = off / (one + cosine);
    to[0] = nearest(old->to_x - reach * (e.y * n.size + n.y * e.size));
    to[1] = nearest(old->to_y + reach * (e.x * n.size + n.x * e.size));
    to[2] = nearest((double)old->sagitta * (1 - off * e.curvature));
}

// The sagitta that goes on smoothly from the motion before, along the chord (x, y).
static int64_t smooth_sagitta(const struct lyr_motion* m, double x, double y) {
    const double x0 = (double)m->to_x - m->from_x, y0 = (double)m->to_y - m->from_y;
    const double c0 = square_root(x0 * x0 + y0 * y0), c = square_root(x * x + y * y);
    const double along = x0 * x + y0 * y, across = x0 * y - y0 * x;
    const double turn = c0 * c + along, rise = 2 * (double)m->sagitta;
    const double e = c * (across * c0 - rise * turn) / (2 * (c0 * turn + across * rise));
    return 4 * e > c || -4 * e > c ? 0 : nearest(e);
}

static bool take_packed(lyr_reader* r, lyr_operation* o) {
    struct lyr_decoder* d = &r->decoder;
    const struct lyr_motion* last = &r->history[(d->motions - 1) % LYR_HISTORY];
    const struct lyr_motion* old = &r->history[d->old++ % LYR_HISTORY];
    const lyr_point head = r->at.head;
    const int64_t x = get_difference(r, d->orders & 15), y = get_difference(r, d->orders & 15);
    const int64_t sagitta = get_difference(r, d->orders >> 4);
    int64_t to[3] = {head.x, head.y, 0};
    if (--r->at.left == 0) pass_bits(r, (8u - d->bit) % 8);
    if (d->code == smooth_run && d->motions > 0 && last->to_x == head.x && last->to_y == head.y)
        to[2] = smooth_sagitta(last, (double)x, (double)y);
    if (d->code == parallel_run)
        go_beside(old, &r->history[d->old % LYR_HISTORY], (double)d->distance / 16, to);
    if (d->code == repeated_run) {
        to[0] += (int64_t)old->to_x - old->from_x;
        to[1] += (int64_t)old->to_y - old->from_y;
        to[2] = old->sagitta;
    }
    o->to = point(r, to[0] + x, to[1] + y, head.z);
    o->sagitta = to[2] + sagitta;
    return check(r, move(r, o, o->sagitta == 0 ? LYR_LINE : LYR_ARC));
}

static bool begin_packed(lyr_reader* r) {
    struct lyr_decoder* d = &r->decoder;
    const int64_t kept = d->motions < LYR_HISTORY ? (int64_t)d->motions : LYR_HISTORY;
    const bool leans = d->code != smooth_run, beside = d->code == parallel_run;
    if (leans) d->back = within(r, d->back + get_signed(r), LYR_HISTORY);
    check(r, !leans || (d->back > beside && d->back <= kept));
    if (beside) d->distance = within(r, d->distance + get_signed(r), farthest_beside);
    check(r, true);
    d->old = d->motions - (uint64_t)d->back;
    r->at.left = get_varint(r);
    d->orders = get_byte(r);
    d->left -= r->at.left - 1;
    // Each motion takes three bits at least.
    check(r, d->has_path && r->at.left > 0 && r->at.left <= left_of(r) * 8 / 3);
    return false;
}

// Hatches.

static bool take_end(lyr_reader* r, lyr_operation* o) {
    struct lyr_decoder* d = &r->decoder;
    const int64_t a = r->grid[0], b = r->grid[1], pitch = r->grid[3], half = unit / 2;
    // Doubles tell what would overflow.
    const double far = (double)d->row * (double)pitch, most = 3 * (double)offset_limit;
    const int64_t off = far > -most && far < most ? r->grid[2] + d->row * pitch : INT64_MAX;
    const int64_t w = (within(r, off, offset_limit) + (1 << 23)) >> 24;
    const bool few = d->ends <= 64, travels = d->end % 2 == 0 && !(d->end == 0 && d->linked);
    const uint64_t j = d->forward ? d->end : d->ends - 1 - d->end;
    int64_t* const before = d->before[few ? j : 0];  // in the last two rows
    const int64_t went = d->alike == 1 ? before[0] : 2 * before[0] - before[1];
    if (!check(r, true)) return false;
    const int64_t u =
        within(r, (few && d->alike > 0 ? went : d->last) + get_signed(r), hatch_limit);
    before[1] = before[0];
    before[0] = d->last = u;
    o->hatch = true;
    o->to = point(r, (u * a - w * b + half) >> 30, (u * b + w * a + half) >> 30, r->at.head.z);
    return move(r, o, travels ? LYR_TRAVEL : LYR_LINE);
}

// Rows come in groups of as many intervals each, which have two values of a byte at least.
static bool take_hatch(lyr_reader* r, lyr_operation* o, bool begins) {
    struct lyr_decoder* d = &r->decoder;
    if (begins) {
        d->flags = get_byte(r);
        d->row = within(r, get_signed(r), row_limit);
        r->at.left = get_varint(r);
        d->forward = !(d->flags & 2);
        d->alike = 0;
        d->last = 0;
        check(r, r->at.left <= (uint64_t)row_limit);
        return check(r, d->flags <= 3 && d->has_path && d->has_grid);
    }
    if (d->rows == 0) {
        const uint64_t code = get_varint(r), ends = code & ~UINT64_C(1);
        d->rows = get_varint(r);
        check(r, d->rows - 1 < r->at.left && ends <= left_of(r) && d->rows * ends <= left_of(r));
        if (ends != d->ends) d->alike = 0;
        d->ends = ends;
        d->linked = code & 1;
    }
    if (!fine(r)) return false;
    const bool given = d->ends > 0 && take_end(r, o);
    if (++d->end < d->ends) return given;
    const uint64_t rows = d->ends > 0 ? 1 : d->rows;
    r->at.left -= rows;
    d->rows -= rows;
    d->row += (int64_t)rows;
    d->alike += rows;
    d->forward ^= !(d->flags & 1) && rows % 2 == 1;
    d->end = 0;
    return given;
}

// Operations.

static bool take_setting(lyr_reader* r, lyr_operation* o) {
    lyr_style* s = &r->style;
    uint32_t* const fields[] = {&s->width, &s->height, &s->flow, &s->speed, &s->acceleration};
    const uint8_t code = r->decoder.code;
    const bool heats = code == LYR_TEMPERATURE, styles = code < LYR_TRAVEL_SPEED;
    if (code == LYR_PATH) {
        const uint8_t role = get_byte(r), stated = get_byte(r);
        s->role = role < 19 ? role : 0;
        check(r, stated <= 31);
        for (int i = 0; i < 5; ++i)
            if (stated >> i & 1) *fields[i] = get_setting(r);
        return r->decoder.has_path = check(r, true);
    }
    if (!check(r, code <= LYR_OBJECT && (r->decoder.has_path || !styles))) return false;
    if (heats) o->heater = get_byte(r);
    if (heats || code == LYR_FAN) o->number = get_setting(r);
    o->value = code == LYR_PAUSE ? get_byte(r) == 1 : get_setting(r);
    if (heats) o->wait = get_byte(r) != 0;
    if (styles) *fields[code == LYR_WIDTH ? 0 : code - LYR_SPEED + 3] = o->value;
    return check(r, o->heater <= 2 && (code != LYR_FAN || o->value <= 1000));
}

// A step of the operation at hand, or the beginning of the next one.
static bool take_step(lyr_reader* r, lyr_operation* o) {
    int64_t* const g = r->grid;
    const bool begins = r->at.left == 0;
    const uint8_t code = r->decoder.code = begins ? get_byte(r) : r->decoder.code;
    r->decoder.left -= begins;
    o->kind = (lyr_kind)code;
    if (code == grid_code) {
        for (int i = 0; i < 4; ++i) g[i] = within(r, get_signed(r), i < 2 ? unit : offset_limit);
        within(r, g[0] * g[0] + g[1] * g[1] - unit * unit, 2 * unit);
        r->decoder.has_grid = check(r, true);
        return false;
    }
    if (code == LYR_HATCH) return take_hatch(r, o, begins);
    if (code == LYR_WIPE && begins) return begin_wipe(r, o);
    if (code > LYR_HATCH && code < LYR_WIPE) return begins ? begin_packed(r) : take_packed(r, o);
    if (code >= skippable) return pass(r, get_varint(r)) && false;
    if (code >= LYR_PATH) return take_setting(r, o);
    if (begins) r->at.left = code < LYR_TRAVEL ? (code & 15) + 1 : 1;
    if (begins) r->decoder.left -= r->at.left - 1;
    return check(r, code <= LYR_WIPE) && take_motion(r, o);
}

bool lyr_next(lyr_reader* r, lyr_operation* o) {
    uint64_t begin = place(r);
    while (fine(r)) {
        *o = (lyr_operation){.offset = begin};
        if (!r->in_chunk) {
            if (take_block(r, o) && fine(r)) return true;
            begin = place(r);
        } else if (r->at.left > 0 || left_of(r) > 0) {
            if (take_step(r, o) && fine(r)) return true;
        } else {
            r->in_chunk = !check(r, r->decoder.left == 0);
        }
    }
    return false;
}

bool lyr_open(lyr_reader* r, const lyr_source* source, void* buffer, uint32_t size) {
    *r = (lyr_reader){.source = *source, .buffer = buffer, .end = buffer, .at.cursor = buffer};
    r->due = 1 << metadata_block;
    r->crc = r->offsets_crc = UINT32_MAX;
    r->capacity = size < longest_payload ? size : longest_payload;
    for (uint32_t i = 0; i < 256; ++i) {
        r->crc_table[i] = i;
        for (int bit = 0; bit < 8; ++bit)
            r->crc_table[i] = r->crc_table[i] >> 1 ^ (r->crc_table[i] & 1) * UINT32_C(0x82f63b78);
    }
    if (size < LYR_LEAST_BUFFER) return fail(r, LYR_TOO_LONG);
    for (int i = 0; i < 16; ++i)
        if (read_bytes(r, r->buffer + i, 1) && i < 4 && r->buffer[i] != "LYR\x1a"[i])
            fail(r, LYR_NO_LYR);
    if (r->crc != right_crc) return fail(r, LYR_DAMAGED);
    r->major = (uint32_t)get_fixed(r->buffer + 4, 2);
    r->minor = (uint32_t)get_fixed(r->buffer + 6, 2);
    r->quantum_nm = (uint32_t)get_fixed(r->buffer + 8, 4);
    r->offset = r->major == 1 ? 8 : 4;
    if (r->major != 1) return fail(r, LYR_UNSUPPORTED);
    if (!check(r, r->quantum_nm - 1 <= 999999) || !read_block(r)) return false;
    r->due = due_first;
    return true;
}

bool lyr_seek_layer(lyr_reader* r, uint32_t index, uint64_t offset) {
    r->status = LYR_OK;
    r->sought = true;
    r->too_large = r->in_chunk = false;
    r->due = 1 << layer_block;
    r->whole_layers = 0;
    r->layers = index;
    r->behind = offset;
    return (r->source.seek && r->source.seek(r->source.user, offset)) || fail(r, LYR_UNREADABLE);
}
