// What operations cost, stated and held.

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "files.h"
#include "sample.h"

using namespace lyr;
using namespace lyr::format;
using test::micrometres;
using test::timed_wall_style;

namespace {

LayerEncoder pen() {
    LayerEncoder layer(micrometres, {});
    layer.begin_path(timed_wall_style);
    return layer;
}

// Bytes for each of `count`, printed and compared.
void bound(const std::string& what, LayerEncoder& layer, double count, double most) {
    const auto encoded = layer.finish();
    REQUIRE(encoded.ok());
    const double each = static_cast<double>(encoded->bytes.size()) / count;
    MESSAGE(what << ": " << each << " bytes");
    CHECK(each <= most);
}

// A wavy outline of about 60 mm across in `count` pieces of a few tenths of a millimetre to a few
// millimetres.
template <class Piece>
void outline(int count, Piece piece) {
    for (int i = 1; i <= count; ++i) {
        const double angle = 2 * std::numbers::pi * i / count;
        const double radius = 30 + 2 * std::sin(7 * angle);
        piece(radius * std::cos(angle), radius * std::sin(angle));
    }
}

// Rows across a disc of 60 mm.
void hatch_disc(LayerEncoder& layer, double pitch_mm, bool linked, int& intervals) {
    std::vector<HatchRow> rows;
    std::vector<HatchInterval> spans;
    for (double off = -30 + pitch_mm / 2; off < 30; off += pitch_mm) {
        const double half = std::sqrt(900 - off * off);
        rows.push_back({1, linked && !rows.empty()});
        spans.push_back({-half, half});
    }
    HatchRun run;
    run.direction_x = run.direction_y = std::numbers::sqrt2 / 2;
    run.offset_mm = -30 + pitch_mm / 2;
    run.pitch_mm = pitch_mm;
    run.rows = rows;
    run.intervals = spans;
    layer.hatch(run);
    intervals += static_cast<int>(rows.size());
}

}  // namespace

TEST_CASE("size: bytes for a line, an arc, a circle, a hatch interval, a path") {
    LayerEncoder lines = pen();
    outline(1000, [&](double x, double y) { lines.line_to(x, y); });
    bound("a line of 0.2 mm", lines, 1000, 4.2);

    LayerEncoder long_lines = pen();
    outline(50, [&](double x, double y) { long_lines.line_to(x, y); });
    bound("a line of 4 mm", long_lines, 50, 5.5);

    LayerEncoder arcs = pen();
    outline(200, [&](double x, double y) { arcs.arc_to(x, y, 0.02); });
    bound("an arc of 1 mm", arcs, 200, 5.5);

    LayerEncoder circles = pen();
    for (int i = 0; i < 1000; ++i) circles.circle(3.3, 0, true);
    bound("a circle of 3.3 mm radius", circles, 1000, 4.1);

    int intervals = 0;
    LayerEncoder linked = pen();
    for (int i = 0; i < 10; ++i) hatch_disc(linked, 0.45, true, intervals);
    bound("a hatch interval, linked, with its link", linked, intervals, 2.5);

    intervals = 0;
    LayerEncoder sparse = pen();
    for (int i = 0; i < 10; ++i) hatch_disc(sparse, 3, false, intervals);
    bound("a hatch interval of sparse infill, with its travel", sparse, intervals, 5);

    LayerEncoder paths = pen();
    PathStyle inner = timed_wall_style;
    inner.role = Role::inner_wall;
    inner.speed_mm_s = 90;
    for (int i = 0; i < 500; ++i) {
        paths.begin_path(inner);
        paths.begin_path(timed_wall_style);
    }
    bound("a path of another role and speed", paths, 1000, 5.1);

    LayerEncoder travels = pen();
    for (int i = 0; i < 1000; ++i) {
        travels.retract_to(0.8);
        travels.travel_to(i % 2 ? 3 : -4, i % 3 ? 2 : -5);
        travels.unretract();
    }
    bound("a travel of some millimetres, with retraction and back", travels, 1000, 12);
}
