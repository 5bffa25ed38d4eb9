// Writes a .lyr file. Layers are encoded each by itself (on any thread, in any order) and appended
// in order; the file appears under its name when it is whole.
//
//     LayerEncoder layer(quantum, state);
//     layer.begin_path({.role = Role::outer_wall, .width_mm = 0.45, .height_mm = 0.2,
//                       .speed_mm_s = 60});
//     layer.line_to(10, 0);
//     ...
//     Result<EncodedLayer> encoded = layer.finish();
//     if (Status s = writer.append(*encoded); !s) return s.error();
//     ...
//     Result<FileTotals> totals = writer.finish();
//
// Contract
//  1. Every position is the given one rounded to the nearest quantum, by itself: errors do not add
//     up. Ends are off by at most 0.71 quanta, arcs of up to half a turn by 1.3, wider ones by 2,
//     circles by 2.2 (start and centre are both rounded), hatch ends by 1.5 (within 2^26 quanta of
//     the origin: beyond, the rounding of the direction adds up to 1).
//  2. The bytes depend on the calls only: not on threads, machine or time.
//  3. What rounds to no motion at all is left out: lines, travels and hatch intervals of length 0.
//     An arc that rounds to its chord becomes a line.
//  4. A caller's mistake (number not finite or out of range, extrusion before begin_path, arc of
//     more than 3/2 pi) is kept and reported by finish(); nothing else of that layer is encoded.
//  5. Until Writer::finish() succeeds, the file at the path is as it was; on failure nothing is
//     left.
//  6. Encoded layers wait in memory, beyond 32 MiB in an unnamed temporary file, because counts and
//     estimates stand in front of them.

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "format/metadata.h"
#include "format/operation.h"

namespace lyr::format {

// Along the run's direction, from the foot of the origin's perpendicular; start < end.
struct HatchInterval {
    double start_mm = 0, end_mm = 0;
};

struct HatchRow {
    std::uint32_t intervals = 0;  // how many of HatchRun::intervals, in order; 0: the row is empty
    // Reached by an extruded straight link from where the head is, else by travel.
    bool linked = false;
};

// Parallel rows, pitch apart. Rows 0, 2, 4... run along the direction, rows 1, 3, 5... against it,
// intervals from last to first (one_way: all along it). Gaps within a row are travels.
struct HatchRun {
    double direction_x = 1, direction_y = 0;  // unit vector d
    double offset_mm = 0;  // of row 0 from the origin, to the left of d: along (-d.y, d.x)
    double pitch_mm = 0;   // signed; row k is at offset_mm + k * pitch_mm
    bool one_way = false;
    std::span<const HatchRow> rows;
    std::span<const HatchInterval> intervals;
};

// The end of a piece of a wipe, and its sagitta as of an arc; 0: a line.
struct WipePiece {
    double x_mm = 0, y_mm = 0, sagitta_mm = 0;
};

// A layer's operations as bytes.
struct EncodedLayer {
    struct Chunk {
        std::size_t begin = 0, end = 0;  // in bytes
        std::uint64_t operations = 0;
    };
    LayerState state;  // estimated_time_s may be set until the layer is appended
    LayerTotals totals;
    Quantum quantum;
    std::vector<Chunk> chunks;
    std::vector<std::byte> bytes;
};

class LayerEncoder {
public:
    LayerEncoder(Quantum quantum, const LayerState& state);
    LayerEncoder(LayerEncoder&&) noexcept;
    LayerEncoder& operator=(LayerEncoder&&) noexcept;
    ~LayerEncoder();

    // Motions extrude with this style from here on, until the next begin_path.
    void begin_path(const PathStyle& style);

    // Positions in mm. Without z the height does not change; with z the motion climbs evenly.
    void travel_to(double x_mm, double y_mm);
    void travel_to(double x_mm, double y_mm, double z_mm);
    void line_to(double x_mm, double y_mm);
    void line_to(double x_mm, double y_mm, double z_mm);
    // sagitta_mm: signed height of the arc over its chord, positive for counter-clockwise:
    // radius x (1 - cos(sweep / 2)). A sweep beyond 3/2 pi must be split by the caller.
    void arc_to(double x_mm, double y_mm, double sagitta_mm);
    void arc_to(double x_mm, double y_mm, double z_mm, double sagitta_mm);
    // A whole turn from the current point.
    void circle(double center_x_mm, double center_y_mm, bool counter_clockwise);
    // Travels to the first interval's start by itself, if the head is elsewhere.
    void hatch(const HatchRun& run);

    void width(double width_mm);  // of the current path from here on
    void speed(double speed_mm_s);
    void acceleration(double acceleration_mm_s2);
    void travel_speed(double speed_mm_s);
    void travel_acceleration(double acceleration_mm_s2);
    void retract();  // to LayerState::retract_length_mm
    void retract_to(double depth_mm);
    void unretract();
    // Draws the filament back to a depth on the way along the pieces, or at once if they have no length.
    void wipe(std::span<const WipePiece> pieces, double depth_mm);
    void temperature(Heater heater, double target_c, bool wait);
    void fan(std::uint32_t fan, double duty);
    void dwell(std::uint32_t time_ms);
    void tool(std::uint32_t tool);
    void pause(PauseReason reason);
    void object(std::uint32_t object);

    // The head's position, exactly as the file will have it.
    Point position() const;

    // Once. Errors (status internal): see 4.
    Result<EncodedLayer> finish();

private:
    class Implementation;
    std::unique_ptr<Implementation> implementation_;
};

struct FileTotals {
    std::uint32_t layers = 0;
    std::uint64_t chunks = 0, operations = 0, bytes = 0;
    Summary summary;
};

class Writer {
public:
    // Errors: quantum 0 or above 1 mm, metadata beyond 64 KiB (usage); not writable (output).
    static Result<Writer> create(const std::string& path, Quantum quantum, Metadata metadata);

    Writer(Writer&&) noexcept;
    Writer& operator=(Writer&&) = delete;
    ~Writer();

    // Instead of the metadata's. Errors: longer than a block may be (usage).
    Status set_thumbnails(std::vector<Thumbnail> thumbnails);

    // The next layer. Errors: another quantum than the file's (internal); temporary file (output).
    Status append(const EncodedLayer& layer);

    // Writes all and renames. Errors (status output): disk full, folder gone.
    Result<FileTotals> finish();

private:
    class Implementation;
    explicit Writer(std::unique_ptr<Implementation> implementation);
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace lyr::format
