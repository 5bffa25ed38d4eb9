// Regions for tests, and what can be said of them by means that share nothing with the code under test.

#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "kernel/region/curve.h"
#include "kernel/region/region.h"

namespace lyr::testing {

using std::numbers::pi;

using Contours = std::vector<Contour>;

// What is allowed where results are to be as good as they get.
inline constexpr double fine_mm = 1e-5;

inline double total_area(const Contours& contours) {
    double area = 0;
    for (const Contour& contour : contours) area += area_mm2(contour);
    return area;
}

inline double total_length(const Contours& contours) {
    double length = 0;
    for (const Contour& contour : contours) length += length_mm(contour);
    return length;
}

inline Path rectangle(double x0, double y0, double x1, double y1) {
    return {{x0, y0}, {{{x1, y0}}, {{x1, y1}}, {{x0, y1}}, {{x0, y0}}}};
}

// A rectangle with rounded ends left and right; the arcs are tangent to the lines.
inline Path slot(double x0, double y0, double x1, double y1) {
    Path path{{x0, y0}, {}};
    path.segments.push_back({{x1, y0}});
    path.segments.push_back(arc_with_sweep({x1, y0}, {x1, y1}, pi));
    path.segments.push_back({{x0, y1}});
    path.segments.push_back(arc_with_sweep({x0, y1}, {x0, y0}, pi));
    return path;
}

inline Contour reversed(const Contour& contour) {
    if (const auto* circle = std::get_if<FullCircle>(&contour)) {
        return FullCircle{circle->centre, circle->radius_mm, !circle->counter_clockwise};
    }
    const Path& path = std::get<Path>(contour);
    std::vector<Point2> ends{path.start};
    for (const Segment& segment : path.segments) ends.push_back(segment.end);
    Path result{path.start, {}};
    for (std::size_t i = path.segments.size(); i-- > 0;) {
        result.segments.push_back({ends[i], -path.segments[i].sagitta_mm});
    }
    return result;
}

struct Motion {
    double angle_rad = 0;
    Vector2 shift = Vector2::Zero();
    bool mirrored = false;

    Point2 operator()(const Point2& p) const {
        const Point2 q(p.x(), mirrored ? -p.y() : p.y());
        return Eigen::Rotation2Dd(angle_rad) * q + shift;
    }
};

// A mirrored contour is turned round so that its material stays on the left.
inline Contour moved(const Contour& contour, const Motion& motion) {
    if (const auto* circle = std::get_if<FullCircle>(&contour)) {
        return FullCircle{motion(circle->centre), circle->radius_mm, circle->counter_clockwise};
    }
    Path path = std::get<Path>(contour);
    path.start = motion(path.start);
    for (Segment& segment : path.segments) {
        segment.end = motion(segment.end);
        if (motion.mirrored) segment.sagitta_mm = -segment.sagitta_mm;
    }
    return motion.mirrored ? reversed(path) : Contour(path);
}

inline Contours moved(Contours contours, const Motion& motion) {
    for (Contour& contour : contours) contour = moved(contour, motion);
    return contours;
}

class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}
    double within(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine_);
    }
    int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
    bool coin() { return whole(0, 1) == 1; }

private:
    std::mt19937 engine_;
};

// A ring of lines and arcs around a centre that lies between 0.6 and 1 times `size` from it and does not cross itself.
inline Path random_ring(Random& random, const Point2& centre, double size) {
    const int corners = random.whole(7, 14);
    std::vector<Point2> points;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * pi * (i + random.within(0, 0.5)) / corners;
        const double radius = size * random.within(0.78, 0.95);
        points.push_back(centre + radius * Vector2(std::cos(angle), std::sin(angle)));
    }
    Path path{points[0], {}};
    for (std::size_t i = 1; i <= points.size(); ++i) {
        const Point2 &from = points[i - 1], &to = points[i % points.size()];
        const double bend = random.coin() ? random.within(-0.08, 0.08) : 0;
        path.segments.push_back({to, bend * (to - from).norm()});
    }
    return path;
}

// An outer boundary and up to three holes.
inline Contours random_region(Random& random, const Point2& centre, double size) {
    Contours region;
    if (random.whole(0, 4) == 0) {
        region.push_back(FullCircle{centre, 0.9 * size, true});
    } else {
        region.push_back(random_ring(random, centre, size));
    }
    const int holes = random.whole(0, 3);
    for (int i = 0; i < holes; ++i) {
        const double angle = random.within(0, 1) + 2 * pi * i / 3;
        const Point2 at = centre + 0.35 * size * Vector2(std::cos(angle), std::sin(angle));
        const double hole_size = size * random.within(0.05, 0.17);
        if (random.coin()) {
            region.push_back(FullCircle{at, hole_size, false});
        } else {
            region.push_back(reversed(random_ring(random, at, hole_size)));
        }
    }
    return region;
}

// How often the contours wind around a point: the sum of the angles under which they are seen. An arc is seen as its
// chord, once around more from between the two.
inline int winding(const Contours& contours, const Point2& point) {
    double turn = 0;
    const auto add = [&](const Point2& from, const Segment& segment) {
        const Vector2 a = from - point, b = segment.end - point;
        turn += std::atan2(cross(a, b), a.dot(b));
        const auto circle = circle_of(from, segment);
        if (!circle || (point - circle->centre).norm() > circle->radius_mm) return;
        const bool right = cross(point - from, segment.end - from) > 0;
        const bool turns_left = segment.sagitta_mm > 0;
        if (right == turns_left) turn += turns_left ? 2 * pi : -2 * pi;
    };
    for (const Contour& contour : contours) {
        if (const auto* c = std::get_if<FullCircle>(&contour)) {
            const double out = (point - c->centre).norm() < c->radius_mm ? 2 * pi : 0;
            turn += c->counter_clockwise ? out : -out;
            continue;
        }
        const Path& path = std::get<Path>(contour);
        Point2 from = path.start;
        for (const Segment& segment : path.segments) {
            if (segment.end != from) add(from, segment);
            from = segment.end;
        }
    }
    return static_cast<int>(std::lround(turn / (2 * pi)));
}

inline double distance_to(const Contours& contours, const Point2& point) {
    double least = 1e300;
    for (const Contour& contour : contours) {
        if (const auto* c = std::get_if<FullCircle>(&contour)) {
            least = std::min(least, std::abs((point - c->centre).norm() - c->radius_mm));
            continue;
        }
        const Path& path = std::get<Path>(contour);
        Point2 from = path.start;
        for (const Segment& segment : path.segments) {
            if (segment.end != from) least = std::min(least, distance_mm(from, segment, point));
            from = segment.end;
        }
    }
    return least;
}

inline Eigen::AlignedBox2d box_of(const Contours& contours) {
    Eigen::AlignedBox2d box;
    for (const Contour& contour : contours) box.extend(region::box_of(contour));
    return box;
}

inline bool is_closed(const Contour& contour) {
    const auto* path = std::get_if<Path>(&contour);
    return !path || (path->segments.size() > 1 && path->segments.back().end == path->start);
}

// The same contours in any order.
inline bool same_set(const Contours& a, Contours b) {
    for (const Contour& contour : a) {
        const auto found = std::find(b.begin(), b.end(), contour);
        if (found == b.end()) return false;
        b.erase(found);
    }
    return b.empty();
}

inline RegionResult unite_all(const std::vector<Contours>& regions, double allowed_mm,
                              double sliver_mm = 0) {
    return united(std::vector<Region>(regions.begin(), regions.end()), allowed_mm, sliver_mm);
}

}  // namespace lyr::testing
