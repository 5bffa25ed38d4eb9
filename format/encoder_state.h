// What LayerEncoder keeps while a layer is encoded: the bytes so far, the state that a reader would
// be in behind them, and what they add up to.

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "format/bytes.h"
#include "format/grid.h"
#include "format/motion_packer.h"
#include "format/row_predictor.h"
#include "format/writer.h"

namespace lyr::format {

// Rounding must not turn an arc of the widest kind into a wider one.
std::int64_t narrowed(const Point& from, const Point& to, std::int64_t sagitta);

class LayerEncoder::Implementation {
public:
    Implementation(Quantum quantum, const LayerState& state);

    void begin_path(const PathStyle& style);
    void travel_to(double x_mm, double y_mm, const double* z_mm);
    void line_to(double x_mm, double y_mm, const double* z_mm);
    void arc_to(double x_mm, double y_mm, const double* z_mm, double sagitta_mm);
    void circle(double center_x_mm, double center_y_mm, bool counter_clockwise);
    void hatch(const HatchRun& run);

    // An operation of one setting; `target` (may be null) is the style's field that it changes.
    void put_setting(std::uint8_t code, double value, double per_unit, double* target = nullptr);
    void retract_to(double depth_mm);
    void put_number(std::uint8_t code, std::uint32_t value);
    void temperature(Heater heater, double target_c, bool wait);
    void fan(std::uint32_t fan, double duty);
    void pause(PauseReason reason);
    void wipe(std::span<const WipePiece> pieces, double depth_mm);

    PathStyle& style() { return style_; }
    const LayerState& state() const { return state_; }
    Point position() const { return at_; }
    Result<EncodedLayer> finish();

private:
    struct Row {
        std::int64_t number = 0, offset = 0;
        bool forward = true, linked = false;
        std::vector<std::int64_t> ends;  // ascending along the direction
    };

    // Hatch rows of as many intervals, reached in the same way.
    struct Group {
        std::uint64_t head = 0, rows = 0;
        Bytes ends;
    };

    // Keeps the first mistake.
    void mistake(const std::string& what);
    bool has_path();
    // None: a mistake.
    std::optional<std::uint64_t> checked(double value, double per_unit, const char* name);
    std::optional<std::int64_t> quanta(double mm);
    std::optional<Point> point(double x_mm, double y_mm, const double* z_mm);

    // What waits is put first.
    void begin_operation(std::size_t most_bytes);
    void flush_motions();
    void make_room(std::size_t most_bytes);
    void put_step(const Point& to, bool with_z);
    void begin_run(std::uint8_t code, std::size_t most_bytes);
    void close_chunk();

    void put_line(const Point& to);
    void put_motion(const Point& to, std::int64_t sagitta);
    // What is rounded of some pieces of a wipe.
    struct Wiped {
        Point to;
        std::int64_t sagitta = 0;
        double length = 0;  // quanta
    };
    std::vector<Wiped> rounded(std::span<const WipePiece> pieces);
    void put_wipe(std::span<const Wiped> pieces, double depth_mm);
    void count_extrusion(double length_quanta);
    void count_travel(const Point& to);
    void count_line(const Point& to);
    void include(const Point& point);
    void include_arc(double center_x, double center_y, double radius, double from_rad,
                     double sweep_rad);

    std::optional<Grid> grid_of(const HatchRun& run);
    std::int64_t select_grid(const Grid& grid);
    bool round_row(const HatchRow& row, const HatchInterval* intervals, Row& out);
    void put_row(const Row& row, std::size_t begin, std::size_t end);
    void begin_hatch_row(std::uint64_t head);
    void close_group();
    void open_hatch(const Row& row);
    void close_hatch();
    void count_row(const Row& row, std::size_t begin, std::size_t end);

    Quantum quantum_;
    LayerState state_;
    std::optional<Diagnostic> error_;
    EncodedLayer out_;
    std::size_t chunk_begin_ = 0;
    std::uint64_t chunk_operations_ = 0;
    std::optional<std::size_t> run_at_;  // the opcode of a run that may grow
    MotionPacker packer_;

    Point at_;
    double given_x_mm_ = 0, given_y_mm_ = 0;  // the same before rounding
    PathStyle style_;                         // as the reader will have it
    bool has_path_ = false;
    double extruded_ = 0, travelled_ = 0;  // quanta
    double depth_mm_ = 0;                  // to which the filament is drawn back

    std::optional<Grid> grid_;
    bool one_way_ = false;
    RowPredictor predictor_;
    // The hatch operation being written: its rows from `hatch_first_row_` on, in groups.
    Bytes hatch_groups_;
    Group group_;
    std::int64_t hatch_first_row_ = 0, hatch_next_row_ = 0;
    bool hatch_backward_ = false, hatch_open_ = false;
};

}  // namespace lyr::format
