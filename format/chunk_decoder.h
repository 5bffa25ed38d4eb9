// The operations of a layer's chunks, one at a time, from bytes whose CRC was found right.
//
// Contract
//  1. Whatever the bytes are, next() ends after finitely many calls, reads nothing outside them and
//     gives positions within coordinate_limit only.
//  2. The byte ranges of the operations given out follow each other without a gap; what is passed
//     over counts to the next one.
//  3. Motions of no length are passed over.

#pragma once

#include <cstdint>
#include <span>

#include "format/bytes.h"
#include "format/grid.h"
#include "format/motion_history.h"
#include "format/operation.h"
#include "format/row_predictor.h"

namespace lyr::format {

class ChunkDecoder {
public:
    enum class Step { operation, end, error };

    // The history is the decoder's alone; large, so that it stands elsewhere.
    explicit ChunkDecoder(MotionHistory& history) : history_(&history) {}

    void begin_layer(const Point& start, Quantum quantum);
    // `operations` is how many the chunk says it has.
    void begin_chunk(std::span<const std::byte> bytes, std::uint64_t operations);

    Step next(Operation& out) {
        begin_offset_ = cursor_.offset();
        // Most are within packed runs.
        if (packed_left_ > 0 && decode_packed(out)) return Step::operation;
        return find_next(out);
    }

    const PathStyle& style() const { return style_; }
    // What is wrong, after Step::error.
    const char* error() const { return error_; }
    // The byte range of the operation given out last, within the chunk's operations.
    std::size_t begin_offset() const { return begin_offset_; }
    std::size_t end_offset() const { return cursor_.offset(); }

private:
    enum class Packed { smooth, parallel, repeated };
    enum class HatchStage { none, row, start, end };

    Step find_next(Operation& out);
    bool fail(const char* error);
    // These return false if they gave nothing out: passed over, or an error.
    bool decode(std::uint8_t code, Operation& out);
    bool decode_motion(std::uint8_t code, Operation& out);
    bool decode_style(std::uint8_t code, Operation& out);
    bool decode_machine(std::uint8_t code, Operation& out);
    bool decode_run(Operation& out);
    bool decode_line(bool with_z, Operation& out);
    bool decode_arc(bool with_z, Operation& out);
    bool decode_travel(bool with_z, Operation& out);
    bool decode_circle(bool counter_clockwise, bool with_z, Operation& out);
    bool decode_grid();
    bool decode_path(Operation& out);
    bool decode_hatch(Operation& out);
    bool decode_hatch_step(Operation& out);
    bool decode_smooth(Operation& out);
    bool decode_parallel(Operation& out);
    bool decode_repeated(Operation& out);
    bool reach_back(std::int64_t least);
    bool begin_packed(Operation& out);
    bool decode_packed(Operation& out);
    // Where the next motion of a packed run would end if nothing were stored.
    struct Expected {
        std::int64_t x = 0, y = 0, sagitta = 0;
    };
    Expected expect_smooth(std::int64_t x, std::int64_t y);
    Expected expect_beside();
    void go_on_beside();
    Expected expect_repeated();
    bool give_packed(const Point& to, std::int64_t sagitta, Operation& out);
    bool decode_wipe(Operation& out);
    bool decode_wipe_piece(Operation& out);
    bool begin_hatch_row();
    bool begin_hatch_group();
    void pass_hatch_rows(std::uint64_t rows);
    bool hatch_point(Point& point);

    Point step(bool with_z) { return step_from(at_, with_z); }
    Point step_from(const Point& from, bool with_z = false);
    static bool beyond(std::int64_t value, std::int64_t limit) {
        return value < -limit || value > limit;
    }
    bool in_range(const Point& point) {
        return (!beyond(point.x, coordinate_limit) && !beyond(point.y, coordinate_limit) &&
                !beyond(point.z, coordinate_limit)) ||
               fail("a position is out of range");
    }
    // A path has begun.
    bool may_extrude();
    std::uint32_t number();
    double setting(double per_unit);

    Quantum quantum_;
    Cursor cursor_;
    std::size_t begin_offset_ = 0;
    std::uint64_t stated_operations_ = 0, operations_ = 0;
    const char* error_ = nullptr;

    Point at_;
    PathStyle style_;
    bool has_path_ = false;

    std::uint8_t run_code_ = 0, run_left_ = 0;

    MotionHistory* history_;
    std::uint64_t packed_left_ = 0;
    unsigned position_order_ = 0, sagitta_order_ = 0;
    bool smooth_ = false;  // a smooth run goes on from a motion before it
    Vector last_chord_;
    double last_length_ = 0;
    Packed packed_ = Packed::smooth;
    std::uint64_t old_ = 0;  // the number of the motion that the next one is parallel to or repeats
    Course old_course_, next_course_;  // of a parallel run: of that motion and the one behind it
    std::int64_t back_ = 0, distance_ = 0;  // of the last run that had them

    Grid grid_;
    bool has_grid_ = false;
    RowPredictor predictor_;
    HatchStage stage_ = HatchStage::none;
    bool one_way_ = false, forward_ = true, linked_ = false, group_linked_ = false;
    std::int64_t row_ = 0, row_offset_ = 0;
    std::uint64_t rows_left_ = 0, group_rows_left_ = 0, intervals_ = 0, ends_left_ = 0;

    std::uint64_t wipe_left_ = 0;                     // pieces
    double wipe_depth_mm_ = 0, wipe_way_quanta_ = 0;  // of these pieces
};

}  // namespace lyr::format
