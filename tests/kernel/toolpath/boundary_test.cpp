#include "kernel/toolpath/boundary.h"

#include <doctest/doctest.h>

#include "kernel/region/regions.h"

using namespace lyr;
using namespace lyr::testing;

TEST_CASE("boundary 1: arcs that begin or end at their circle's lowest point count at its height") {
    Random random(4);
    for (int i = 0; i < 500; ++i) {
        const double radius = random.within(0.1, 20), sweep = random.within(1.8, 3.1);
        const Point2 bottom(random.within(-50, 50), random.within(-50, 50));
        const Point2 centre = bottom + Vector2(0, radius);
        const double end_angle = sweep - pi / 2;
        const Point2 end = centre + radius * Vector2(std::cos(end_angle), std::sin(end_angle));
        // From the bottom up on the right, to the left, and straight down and back.
        const Point2 left(bottom.x() - 2 * radius, end.y()), corner(left.x(), bottom.y() - radius);
        const Path path{bottom,
                        {arc_with_sweep(bottom, end, sweep),
                         {left},
                         {corner},
                         {{bottom.x(), corner.y()}},
                         {bottom}}};
        for (const bool mirrored : {false, true}) {
            const Motion motion{.angle_rad = 0, .shift = {0.3, 0.1}, .mirrored = mirrored};
            const Boundary boundary(Contours{moved(Contour(path), motion)});
            CHECK(boundary.winding(motion(bottom - Vector2(radius, 0))) == 1);
            CHECK(boundary.winding(motion(bottom + Vector2(radius, 0))) == 0);
        }
    }
}
