// What a .lyr file says, as values: the operations of a print in the order in which they are done.
// Reader and writer share these types; docs/lyr-format.md gives the bytes.
//
// Contract
//  1. Positions are absolute and exact: whole numbers of the file's quantum, each at most
//     `coordinate_limit` from the origin. Everything else is in the unit that its name carries.
//  2. An Operation is trivially copyable, owns nothing and can be compared.
//  3. A motion whose ends differ in z climbs evenly along its length (a ramp or a helix).

#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string_view>
#include <type_traits>
#include <variant>

namespace lyr::format {

// 2^31 - 1: 2.1 m at the finest quantum (1 nm), so that a reader may keep coordinates in 32 bits.
inline constexpr std::int64_t coordinate_limit = 0x7fffffff;

// The unit of the file's coordinates.
struct Quantum {
    std::uint32_t nm = 1000;

    double mm(std::int64_t quanta) const { return static_cast<double>(quanta) * nm / 1e6; }
    // The nearest quantum; halves go away from zero. |mm| must be within coordinate_limit quanta.
    std::int64_t quanta(double mm) const { return std::llround(mm * 1e6 / nm); }
};

// In quanta.
struct Point {
    std::int64_t x = 0, y = 0, z = 0;
    friend bool operator==(const Point&, const Point&) = default;
};

// What a path is for. The numbers are the file's; one that is not listed reads as `other`.
enum class Role : std::uint8_t {
    other = 0,
    outer_wall = 1,
    inner_wall = 2,
    overhang_wall = 3,
    thin_wall = 4,
    gap_fill = 5,
    solid_infill = 6,
    sparse_infill = 7,
    top_skin = 8,
    bottom_skin = 9,
    bridge = 10,
    internal_bridge = 11,
    ironing = 12,
    support = 13,
    support_interface = 14,
    skirt = 15,
    brim = 16,
    raft = 17,
    prime_tower = 18,
};
inline constexpr std::size_t role_count = 19;

// "outer wall", "sparse infill", ...
std::string_view name_of(Role role);

// How the motions of a path are extruded. An acceleration of 0 leaves it to the machine.
struct PathStyle {
    Role role = Role::other;
    double width_mm = 0;
    double height_mm = 0;
    double flow = 1;  // multiplies the volume
    double speed_mm_s = 0;
    double acceleration_mm_s2 = 0;
    friend bool operator==(const PathStyle&, const PathStyle&) = default;
};

// Area of an extruded strand. Laid on something (width >= height) it is a rectangle with two half
// circles at its sides; narrower than high it is an ellipse. Both give a circle when width ==
// height, which is a strand in free air (a bridge). The volume of a motion is this x its length.
inline double cross_section_mm2(const PathStyle& style) {
    const double w = style.width_mm, h = style.height_mm, quarter_pi = std::numbers::pi / 4;
    return style.flow * (w >= h ? (w - h) * h + quarter_pi * h * h : quarter_pi * w * h);
}

// Motions. Line, Arc and Circle extrude with the style of the path that they belong to.

struct Line {
    Point from, to;
    bool hatch = false;  // belongs to a hatch run
    friend bool operator==(const Line&, const Line&) = default;
};

// The circular arc from `from` to `to` whose middle is `sagitta` quanta off the middle of the
// chord: positive: counter-clockwise (the bulge is to the right of from->to), negative: clockwise.
// Never 0; the sweep is at most 3/2 pi. arc.h gives centre, radius and angles.
struct Arc {
    Point from, to;
    std::int64_t sagitta = 0;
    friend bool operator==(const Arc&, const Arc&) = default;
};

// One whole turn from `from` about the centre; `to` differs from `from` in z at most.
struct Circle {
    Point from, to;
    std::int64_t center_x = 0, center_y = 0;
    bool counter_clockwise = true;
    friend bool operator==(const Circle&, const Circle&) = default;
};

// A straight motion without extrusion.
struct Travel {
    Point from, to;
    bool hatch = false;
    friend bool operator==(const Travel&, const Travel&) = default;
};

// A piece of a wipe: along the line (sagitta 0) or arc from `from` to `to`, without extruding, while the
// filament is drawn back evenly, so that after `left_mm` more of such way, this piece included, it is
// `depth_mm` behind where it was while extruding.
struct Wipe {
    Point from, to;
    std::int64_t sagitta = 0;
    double depth_mm = 0;
    double left_mm = 0;
    friend bool operator==(const Wipe&, const Wipe&) = default;
};

// A hatch run begins; its lines and travels follow as Line and Travel. For statistics only.
struct HatchStart {
    double direction_x = 1, direction_y = 0;  // unit vector
    double pitch_mm = 0;  // signed: rows follow to the left of the direction if > 0
    friend bool operator==(const HatchStart&, const HatchStart&) = default;
};

// A layer begins: the head goes to `start` from wherever it is, without extruding, z before x and y
// if it rises and after them if it sinks. Reader::layer() has the rest of the layer's state.
struct LayerStart {
    std::uint32_t index = 0;  // from 0
    Point start;
    friend bool operator==(const LayerStart&, const LayerStart&) = default;
};

struct PathStart {
    PathStyle style;
    friend bool operator==(const PathStart&, const PathStart&) = default;
};

// Changes of the current path's style from here on.
struct Width {
    double width_mm = 0;
    friend bool operator==(const Width&, const Width&) = default;
};
struct Speed {
    double speed_mm_s = 0;
    friend bool operator==(const Speed&, const Speed&) = default;
};
struct Acceleration {
    double acceleration_mm_s2 = 0;  // 0: the machine's own
    friend bool operator==(const Acceleration&, const Acceleration&) = default;
};
struct TravelSpeed {
    double speed_mm_s = 0;
    friend bool operator==(const TravelSpeed&, const TravelSpeed&) = default;
};
struct TravelAcceleration {
    double acceleration_mm_s2 = 0;  // 0: the machine's own
    friend bool operator==(const TravelAcceleration&, const TravelAcceleration&) = default;
};

// The filament is drawn back until it is `depth_mm` behind where it was while extruding; 0: it is
// pushed forward again.
struct Retract {
    double depth_mm = 0;
    friend bool operator==(const Retract&, const Retract&) = default;
};

enum class HeaterKind : std::uint8_t { bed = 0, chamber = 1, tool = 2 };

struct Heater {
    HeaterKind kind = HeaterKind::tool;
    std::uint32_t tool = 0;  // which one, if kind == tool
    friend bool operator==(const Heater&, const Heater&) = default;
};

struct Temperature {
    Heater heater;
    double target_c = 0;  // 0: off
    bool wait = false;    // until it is reached
    friend bool operator==(const Temperature&, const Temperature&) = default;
};

// Fan 0 cools the part.
struct Fan {
    std::uint32_t fan = 0;
    double duty = 0;  // 0..1
    friend bool operator==(const Fan&, const Fan&) = default;
};

struct Dwell {
    std::uint32_t time_ms = 0;
    friend bool operator==(const Dwell&, const Dwell&) = default;
};

struct Tool {
    std::uint32_t tool = 0;
    friend bool operator==(const Tool&, const Tool&) = default;
};

enum class PauseReason : std::uint8_t { user = 0, filament_change = 1 };

struct Pause {
    PauseReason reason = PauseReason::user;
    friend bool operator==(const Pause&, const Pause&) = default;
};

// What follows belongs to this object (metadata names it); 0: to none, such as a skirt.
struct Object {
    std::uint32_t object = 0;
    friend bool operator==(const Object&, const Object&) = default;
};

using Operation = std::variant<LayerStart, PathStart, Line, Arc, Circle, Travel, HatchStart, Width,
                               Speed, Acceleration, TravelSpeed, TravelAcceleration, Retract,
                               Temperature, Fan, Dwell, Tool, Pause, Object, Wipe>;
static_assert(std::is_trivially_copyable_v<Operation>);

// A list of at most N values, in place.
template <class T, std::size_t N>
class Bounded {
public:
    // False: full.
    bool push_back(const T& value) {
        if (size_ == N) return false;
        values_[size_++] = value;
        return true;
    }
    std::size_t size() const { return size_; }
    const T& operator[](std::size_t index) const { return values_[index]; }
    const T* begin() const { return values_.data(); }
    const T* end() const { return values_.data() + size_; }

private:
    std::array<T, N> values_{};
    std::size_t size_ = 0;
};

struct HeaterTarget {
    Heater heater;
    double target_c = 0;
};

// The state in which a layer begins. Nothing is taken over from the layer before, so that a print
// can start or resume at any layer.
struct LayerState {
    double z_mm = 0;       // of the nozzle: the top of the layer
    double height_mm = 0;  // thickness
    double start_x_mm = 0, start_y_mm = 0;
    double travel_speed_mm_s = 150;
    double travel_acceleration_mm_s2 = 0;  // 0: the machine's own
    std::uint32_t tool = 0;
    std::uint32_t object = 0;
    double retracted_mm = 0;  // how far the filament is drawn back at the start
    double retract_length_mm = 0;
    double retract_speed_mm_s = 0;
    double unretract_speed_mm_s = 0;
    // A machine that starts here waits for these; one that comes from the layer before sets them.
    Bounded<HeaterTarget, 16> temperatures;
    Bounded<Fan, 8> fans;
    double estimated_time_s = 0;  // 0: not estimated
};

// Corners of a box, in quanta.
struct Bounds {
    Point low, high;
};

// What the writer counted in a layer; stored in front of it.
struct LayerTotals {
    std::uint32_t chunks = 0;
    std::uint64_t operations = 0;      // a hatch run is one
    Bounds motion;                     // of all motions of the layer, travels included
    std::int64_t extruded_quanta = 0;  // length, rounded
    std::int64_t travel_quanta = 0;
    double volume_mm3 = 0;
};

struct Layer {
    std::uint32_t index = 0;  // from 0
    LayerState state;
    LayerTotals totals;
};

}  // namespace lyr::format
