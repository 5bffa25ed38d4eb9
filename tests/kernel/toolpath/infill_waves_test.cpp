// Honeycombs and gyroids: that they are what they are called.

#include "kernel/toolpath/infill_waves.h"

#include <doctest/doctest.h>

#include "kernel/toolpath/fills.h"
#include "kernel/toolpath/sizes.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

InfillRequest wave_request(InfillPattern pattern, double density, double z_mm,
                           std::size_t layer = 0) {
    return {.pattern = pattern,
            .density = density,
            .width_mm = width_mm,
            .height_mm = height_mm,
            .angle_rad = 0.4,
            .z_mm = z_mm,
            .layer = layer,
            .allowed_mm = infill_allowed_mm};
}

constexpr double fit_mm = 0.45 / 20;

// How far a point of the plane, in the pattern's coordinates, is off the gyroid at a height, to first order.
double off_gyroid_mm(const WavePattern& pattern, const Point2& at, double turned_rad, double z_mm) {
    const double unit = pattern.period_mm / (2 * pi);
    const Point2 p = Eigen::Rotation2Dd(pattern.angle_rad - turned_rad) * at / unit;
    const double x = p.x(), y = p.y(), z = z_mm / unit;
    const double value =
        std::sin(x) * std::cos(y) + std::sin(y) * std::cos(z) + std::sin(z) * std::cos(x);
    const Vector2 slope(std::cos(x) * std::cos(y) - std::sin(z) * std::sin(x),
                        std::cos(z) * std::cos(y) - std::sin(x) * std::sin(y));
    // Where curves nearly touch, the slope is small and says nothing; the second derivatives are 2 at most.
    return unit * std::min(std::abs(value) / slope.norm(), std::sqrt(std::abs(value)));
}

}  // namespace

TEST_CASE("gyroid: every height's curves are on the gyroid, periodic and smooth") {
    for (int i = 0; i < 40; ++i) {
        const double z_mm = 0.2 * i;
        CAPTURE(z_mm);
        const WavePattern pattern = gyroid_waves(wave_request(InfillPattern::gyroid, 0.2, z_mm));
        REQUIRE(pattern.waves.size() == 2);
        for (const Wave& wave : pattern.waves) {
            const Vector2 ends = wave.segments.back().end - wave.start;
            CHECK((ends - Vector2(pattern.period_mm, 0)).norm() < 1e-9);
            CHECK(wave.segments.size() < 40);
            Point2 from = wave.start;
            Vector2 tangent = start_tangent(from, wave.segments.front());
            const Vector2 first = tangent;
            for (const Segment& segment : wave.segments) {
                CHECK(angle_between(tangent, start_tangent(from, segment)) < 1e-6);
                for (const double share : {0.0, 0.3, 0.7}) {
                    const Point2 at = point_at(from, segment, share);
                    CHECK(off_gyroid_mm(pattern, at, 0.4, z_mm) < 1.2 * fit_mm);
                }
                tangent = end_tangent(from, segment);
                from = segment.end;
            }
            CHECK(angle_between(tangent, first) < 1e-6);
        }
    }
}

TEST_CASE("gyroid: heights at which curves touch are no worse than others") {
    for (const double off : {0.0, 1e-12, -1e-9, 1e-5, -1e-3, 2e-3}) {
        for (int quarter = 0; quarter < 4; ++quarter) {
            InfillRequest asked = wave_request(InfillPattern::gyroid, 0.2, 0);
            const double unit = gyroid_waves(asked).period_mm / (2 * pi);
            asked.z_mm = unit * ((quarter + 0.5) * pi / 2 + off);
            const WavePattern pattern = gyroid_waves(asked);
            CAPTURE(off);
            CAPTURE(quarter);
            for (const Wave& wave : pattern.waves) {
                CHECK(wave.segments.size() < 60);
                Point2 from = wave.start;
                for (const Segment& segment : wave.segments) {
                    CHECK(off_gyroid_mm(pattern, point_at(from, segment, 0.5), 0.4, asked.z_mm) <
                          2 * fit_mm);
                    from = segment.end;
                }
            }
        }
    }
}

TEST_CASE("gyroid: the mean length over all heights is the density's") {
    constexpr int heights = 400;
    double share = 0;
    InfillRequest asked = wave_request(InfillPattern::gyroid, 0.2, 0);
    const double period = gyroid_waves(asked).period_mm;
    for (int i = 0; i < heights; ++i) {
        asked.z_mm = period * (i + 0.5) / heights;
        double length = 0;
        for (const Wave& wave : gyroid_waves(asked).waves) {
            Point2 from = wave.start;
            for (const Segment& segment : wave.segments) {
                length += lyr::length_mm(from, segment);
                from = segment.end;
            }
        }
        share += length * line_spacing_mm(0.45, 0.2) / (period * period) / heights;
    }
    CHECK(share == doctest::Approx(0.2).epsilon(0.003));
}

TEST_CASE("honeycomb: the walls of all layers lie over each other, each double in one of three") {
    const Contours square{rectangle(-20, -20, 20, 20)};
    const double spacing = line_spacing_mm(0.45, 0.2);
    std::vector<std::vector<PrintedLine>> layers;
    for (std::size_t layer = 0; layer < 4; ++layer) {
        Fill fill;
        const InfillRequest asked = wave_request(InfillPattern::honeycomb, 0.15, 0, layer);
        fill_with_waves(square, honeycomb_waves(asked), asked, fill);
        layers.push_back(lines_of(fill));
    }
    for (std::size_t layer = 1; layer < 4; ++layer) {
        for (const PrintedLine& line : layers[0]) {
            const Point2 middle = point_at(line.start, line.segment, 0.5);
            if (distance_to(square, middle) < 2 * spacing) continue;
            double nearest = 1e9;
            std::size_t near = 0;
            for (const PrintedLine& other : layers[layer]) {
                const double distance = distance_mm(other.start, other.segment, middle);
                nearest = std::min(nearest, distance);
                near += distance < 1.01 * spacing;
            }
            CHECK(nearest < 0.51 * spacing);
            CHECK(near <= 3);
            if (layer == 3) CHECK(nearest < 1e-9);
        }
    }
}
