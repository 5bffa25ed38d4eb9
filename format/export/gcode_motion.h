// The machine's motions as G-code: where the head is, what of E and F the firmware knows already, and the lines that
// change them. Private to this room; gcode.h has the contract.

#pragma once

#include <cstdint>
#include <string>

#include "format/arc.h"
#include "format/export/gcode.h"
#include "format/operation.h"

namespace lyr::format {

// Digits of filament.
inline constexpr int filament_decimals = 5;

class GcodeMotion {
public:
    GcodeMotion(const GcodeOptions& options, Quantum quantum, std::string& out);

    // Each goes on from where the head is. `filament_mm` is what is pushed on the way; speeds of 0 leave the firmware's.
    void line(const Point& to, double filament_mm, double speed_mm_s);
    void arc(const Arc& arc, double filament_mm, double speed_mm_s);
    void circle(const Circle& circle, double filament_mm, double speed_mm_s);
    void travel(const Point& to, double speed_mm_s);
    // From wherever the head is: up first, so that it passes over what may lie on the bed.
    void begin_at(const Point& to, double speed_mm_s);
    // At a standstill; negative draws back.
    void push(double filament_mm, double speed_mm_s);
    // Where E counts up, it begins anew.
    void reset_filament();

private:
    // In units of the last digit that is written.
    struct Place {
        std::int64_t x = 0, y = 0, z = 0;
        bool operator==(const Place&) const = default;
    };
    // A circle in mm.
    struct Round {
        double center_x = 0, center_y = 0, radius = 0, start_rad = 0, sweep_rad = 0;
    };

    Place place(const Point& point) const;
    double mm(std::int64_t units) const;
    void go(const char* command, const Place& to, double filament_mm, double speed_mm_s);
    void turn(const Round& round, const Place& to, double filament_mm, double speed_mm_s);
    void chords(const Round& round, const Place& to, double filament_mm, double speed_mm_s);
    void append_word(char letter, std::int64_t count, int decimals);
    void append_place(const Place& to, bool always);
    void append_filament(double filament_mm);
    void append_speed(double speed_mm_s);

    std::string& out_;
    Quantum quantum_;
    GcodeFlavor flavor_;
    bool relative_;
    int decimals_ = 3;
    std::int64_t unit_nm_ = 1000;
    Place at_{};
    std::int64_t filament_ = 0;  // E since it was set to 0
    double unwritten_ = 0;       // what rounding has left, in the unit of E
    std::int64_t speed_ = 0;     // F in its last digit; 0: none yet
};

}  // namespace lyr::format
