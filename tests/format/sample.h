// Random prints for the tests of the format: the same calls to the encoder and, as doubles, into a
// list of what a reader should give out.

#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "format/arc.h"
#include "format/reader.h"
#include "format/writer.h"

namespace lyr::format::test {

inline constexpr PathStyle timed_wall_style{Role::outer_wall, 0.45, 0.2, 1, 60, 0};

// A motion before rounding; `kind` is the operation's index in the variant.
struct Expected {
    std::size_t kind = 0;
    double x_mm = 0, y_mm = 0, z_mm = 0;  // end
    double a = 0, b = 0;                  // sagitta, centre or settings
    bool flag = false;
};

template <class T>
constexpr std::size_t kind_of() {
    return Operation(T{}).index();
}

class RandomLayer {
public:
    RandomLayer(std::uint32_t seed, double z_mm, Quantum quantum, int calls)
        : random_(seed), quantum_(quantum), z_mm_(z_mm), encoder_(quantum, state(z_mm)) {
        expected.push_back({kind_of<LayerStart>(), 1, 2, z_mm, 0, 0, false});
        x_mm_ = 1, y_mm_ = 2;
        path();
        for (int i = 0; i < calls; ++i) call();
    }

    static LayerState state(double z_mm) {
        LayerState state;
        state.z_mm = z_mm;
        state.height_mm = 0.2;
        state.start_x_mm = 1;
        state.start_y_mm = 2;
        state.travel_speed_mm_s = 180;
        state.travel_acceleration_mm_s2 = 3000;
        state.retract_length_mm = 0.8;
        state.retract_speed_mm_s = 35;
        state.unretract_speed_mm_s = 20;
        state.temperatures.push_back({{HeaterKind::bed, 0}, 90});
        state.temperatures.push_back({{HeaterKind::tool, 0}, 230.5});
        state.fans.push_back({0, 0.35});
        state.estimated_time_s = 12.345;
        return state;
    }

    Result<EncodedLayer> finish() { return encoder_.finish(); }

    std::vector<Expected> expected;

private:
    double uniform(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    int pick(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
    // Mostly short ways, as in contours.
    double near(double from) {
        return std::clamp(from + uniform(-1, 1) * std::pow(10, uniform(-2, 2)), -200.0, 200.0);
    }

    void call() {
        switch (pick(14)) {
            case 0:
            case 1:
            case 2:
                return line();
            case 3:
            case 4:
            case 5:
                return arc();
            case 6:
                return travel();
            case 7:
                return circle();
            case 8:
                return hatch();
            case 9:
                return path();
            case 10:
                return wipe();
            case 11:
                return walls();
            default:
                return setting();
        }
    }

    // Rings of arcs and chords inside each other.
    void walls() {
        const double center_x = x_mm_, center_y = y_mm_, outer = uniform(2, 20);
        const int pieces = 4 + pick(20), rings = 1 + pick(3);
        const double turn = 2 * std::numbers::pi / pieces;
        for (int ring = 0; ring < rings; ++ring) {
            const double radius = outer - 0.45 * ring;
            for (int i = 0; i <= pieces; ++i) {
                x_mm_ = center_x + radius * std::cos(i * turn);
                y_mm_ = center_y + radius * std::sin(i * turn);
                const double sagitta = i % 3 == 0 ? 0 : radius * (1 - std::cos(turn / 2));
                if (i == 0)
                    encoder_.travel_to(x_mm_, y_mm_);
                else
                    sagitta == 0 ? encoder_.line_to(x_mm_, y_mm_)
                                 : encoder_.arc_to(x_mm_, y_mm_, sagitta);
                const std::size_t kind = i == 0         ? kind_of<Travel>()
                                         : sagitta == 0 ? kind_of<Line>()
                                                        : kind_of<Arc>();
                expected.push_back({kind, x_mm_, y_mm_, z_mm_, sagitta, 0, false});
            }
        }
    }

    void move_near(double least_mm) {
        const double x = x_mm_, y = y_mm_;
        do {
            x_mm_ = near(x);
            y_mm_ = near(y);
        } while (std::hypot(x_mm_ - x, y_mm_ - y) < least_mm);
    }

    // Far enough apart that rounding leaves a motion.
    double least_mm() const { return 4 * quantum_.mm(1); }

    void line() {
        move_near(least_mm());
        const bool climbs = pick(5) == 0;
        if (climbs) z_mm_ += uniform(-0.1, 0.2);
        climbs ? encoder_.line_to(x_mm_, y_mm_, z_mm_) : encoder_.line_to(x_mm_, y_mm_);
        expected.push_back({kind_of<Line>(), x_mm_, y_mm_, z_mm_, 0, 0, false});
    }

    void travel() {
        move_near(least_mm());
        const bool climbs = pick(3) == 0;
        if (climbs) z_mm_ += uniform(-0.2, 0.2);
        climbs ? encoder_.travel_to(x_mm_, y_mm_, z_mm_) : encoder_.travel_to(x_mm_, y_mm_);
        expected.push_back({kind_of<Travel>(), x_mm_, y_mm_, z_mm_, 0, 0, false});
    }

    void arc() {
        const double x = x_mm_, y = y_mm_;
        move_near(20 * quantum_.mm(1));
        const double chord = std::hypot(x_mm_ - x, y_mm_ - y);
        const double low = std::log(std::min(0.2, 5 * quantum_.mm(1) / chord));
        const double sagitta =
            (pick(2) ? 1 : -1) * chord * std::exp(uniform(low, std::log(widest_sagitta_per_chord)));
        const bool climbs = pick(5) == 0;
        if (climbs) z_mm_ += uniform(-0.1, 0.2);
        climbs ? encoder_.arc_to(x_mm_, y_mm_, z_mm_, sagitta)
               : encoder_.arc_to(x_mm_, y_mm_, sagitta);
        expected.push_back({kind_of<Arc>(), x_mm_, y_mm_, z_mm_, sagitta, 0, false});
    }

    // Nothing is extruded until the head has travelled on.
    void wipe() {
        std::vector<WipePiece> pieces;
        const double depth = 0.1 * pick(30);
        for (int left = 1 + pick(4); left > 0; --left) {
            const double x = x_mm_, y = y_mm_;
            move_near(20 * quantum_.mm(1));
            const double chord = std::hypot(x_mm_ - x, y_mm_ - y);
            const double sagitta = pick(2) ? chord * uniform(0.3, 1.1) * (pick(2) ? 1 : -1) : 0;
            pieces.push_back({x_mm_, y_mm_, sagitta});
            expected.push_back({kind_of<Wipe>(), x_mm_, y_mm_, z_mm_, sagitta, depth, false});
        }
        encoder_.wipe(pieces, depth);
        encoder_.retract_to(depth);
        expect<Retract>(depth);
        travel();
    }

    void circle() {
        const double x = x_mm_, y = y_mm_;
        move_near(least_mm());
        const double center_x = x_mm_, center_y = y_mm_;
        x_mm_ = x;
        y_mm_ = y;
        const bool ccw = pick(2) == 0;
        encoder_.circle(center_x, center_y, ccw);
        expected.push_back({kind_of<Circle>(), x_mm_, y_mm_, z_mm_, center_x, center_y, ccw});
    }

    void path() {
        PathStyle style;
        style.role = static_cast<Role>(pick(role_count));
        style.width_mm = pick(2) ? 0.45 : uniform(0.1, 1.2);
        style.height_mm = pick(3) ? 0.2 : uniform(0.05, 0.4);
        style.flow = pick(3) ? 1 : uniform(0.5, 1.5);
        style.speed_mm_s = pick(3) ? 60 : uniform(1, 300);
        style.acceleration_mm_s2 = pick(3) ? 0 : 1000;
        encoder_.begin_path(style);
        expected.push_back({kind_of<PathStart>(), style.width_mm, style.height_mm, style.flow,
                            style.speed_mm_s, static_cast<double>(style.role), false});
    }

    template <class T>
    void expect(double a, double b = 0, bool flag = false) {
        expected.push_back({kind_of<T>(), 0, 0, 0, a, b, flag});
    }

    void setting() {
        const double value = uniform(0, 100);
        switch (pick(13)) {
            case 0:
                return encoder_.width(value), expect<Width>(value);
            case 1:
                return encoder_.speed(value), expect<Speed>(value);
            case 2:
                return encoder_.acceleration(std::floor(value)),
                       expect<Acceleration>(std::floor(value));
            case 3:
                return encoder_.travel_speed(value), expect<TravelSpeed>(value);
            case 4:
                return encoder_.travel_acceleration(std::floor(value)),
                       expect<TravelAcceleration>(std::floor(value));
            case 5:
                return encoder_.retract(), expect<Retract>(0.8);
            case 6:
                return encoder_.unretract(), expect<Retract>(0);
            case 7:
                return encoder_.temperature({HeaterKind::tool, 1}, value, value > 50),
                       expect<Temperature>(value, 1, value > 50);
            case 8:
                return encoder_.fan(2, value / 100), expect<Fan>(value / 100, 2);
            case 9:
                return encoder_.dwell(1234), expect<Dwell>(1234);
            case 10:
                return encoder_.tool(3), expect<Tool>(3);
            case 11:
                return encoder_.pause(PauseReason::filament_change), expect<Pause>(1);
            default:
                return encoder_.object(7), expect<Object>(7);
        }
    }

    void hatch() {
        const double angle = pick(3) ? uniform(0, 7) : pick(8) * std::numbers::pi / 4;
        HatchRun run;
        run.direction_x = std::cos(angle);
        run.direction_y = std::sin(angle);
        run.offset_mm = pick(2) ? 10 : uniform(-50, 50);
        run.pitch_mm = (pick(2) ? 1 : -1) * (pick(2) ? 0.45 : uniform(0.2, 3));
        run.one_way = pick(4) == 0;
        std::vector<HatchRow> rows;
        std::vector<HatchInterval> intervals;
        const int count = 1 + pick(30);
        int holes = pick(5);
        double start = uniform(-50, 50);
        for (int k = 0; k < count; ++k) {
            if (pick(8) == 0) holes = pick(40) == 0 ? 40 : pick(5);
            start += uniform(-0.5, 0.5);
            const int here = pick(10) == 0 ? 0 : holes + 1;
            rows.push_back({static_cast<std::uint32_t>(here), pick(3) == 0});
            double along = start;
            for (int i = 0; i < here; ++i) {
                const double end = along + uniform(0.1, 4);
                intervals.push_back({along, end});
                along = end + uniform(0.1, 2);
            }
        }
        run.rows = rows;
        run.intervals = intervals;
        encoder_.hatch(run);
        if (!intervals.empty()) expect_hatch(run);
    }

    void expect_hatch(const HatchRun& run) {
        expected.push_back(
            {kind_of<HatchStart>(), run.direction_x, run.direction_y, 0, run.pitch_mm, 0, false});
        const auto at = [&](double along, double off, std::size_t kind) {
            x_mm_ = along * run.direction_x - off * run.direction_y;
            y_mm_ = along * run.direction_y + off * run.direction_x;
            expected.push_back({kind, x_mm_, y_mm_, z_mm_, 0, 0, true});
        };
        std::size_t first = 0;
        for (std::size_t k = 0; k < run.rows.size(); ++k) {
            const double off = run.offset_mm + static_cast<double>(k) * run.pitch_mm;
            const bool forward = run.one_way || k % 2 == 0;
            for (std::size_t i = 0; i < run.rows[k].intervals; ++i) {
                const auto& interval =
                    run.intervals[first + (forward ? i : run.rows[k].intervals - 1 - i)];
                const bool link = i == 0 && run.rows[k].linked;
                at(forward ? interval.start_mm : interval.end_mm, off,
                   link ? kind_of<Line>() : kind_of<Travel>());
                at(forward ? interval.end_mm : interval.start_mm, off, kind_of<Line>());
            }
            first += run.rows[k].intervals;
        }
    }

    std::mt19937 random_;
    Quantum quantum_;
    double x_mm_ = 0, y_mm_ = 0, z_mm_ = 0;
    LayerEncoder encoder_;
};

}  // namespace lyr::format::test
