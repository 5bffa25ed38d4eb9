// What the machine can bear: speeds and accelerations by axis and along the path.

#pragma once

namespace lyr::motion {

struct AxisLimits {
    double speed_mm_s;
    double acceleration_mm_s2;
};

struct Limits {
    AxisLimits x{300, 3000};
    AxisLimits y{300, 3000};
    AxisLimits z{10, 100};
    AxisLimits e{60, 5000};
    double acceleration_mm_s2 = 3000;  // of the whole motion in (x, y, z), turning included

    // How far the path would cut a corner if it were rounded by the circle that is driven at corner speed.
    // A square corner is then passed at sqrt(acceleration * deviation / (sqrt(2) - 1)): 5 mm/s here.
    double junction_deviation_mm = 0.00345;

    // The jump of the extruder's speed that is allowed where the flow changes from one move to the next.
    double e_corner_speed_mm_s = 1;
};

}  // namespace lyr::motion
