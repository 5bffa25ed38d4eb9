// Random curves for properties that must hold of every curve: any kind, any place, either handedness.

#pragma once

#include <cmath>
#include <random>

#include "kernel/geometry/curve.h"
#include "kernel/geometry/tolerance.h"

namespace lyr::test {

inline constexpr double inversion_bound_mm = resolution_mm;

class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}

    double between(double low, double high) { return low + (high - low) * unit_(engine_); }
    int integer(int low, int high) {
        return std::uniform_int_distribution<int>(low, high)(engine_);
    }
    bool coin() { return integer(0, 1) == 1; }

    Vector3 vector(double size) {
        const double x = between(-size, size), y = between(-size, size);
        return {x, y, between(-size, size)};
    }

    Frame frame() {
        Frame frame;
        frame.origin = vector(100);
        frame.z = vector(1).normalized();
        frame.x = frame.z.unitOrthogonal();
        frame.y = frame.z.cross(frame.x);
        if (coin()) frame.y = -frame.y;
        return frame;
    }

    // Rotates, mirrors half of the time, and scales if asked to.
    Eigen::Affine3d similarity(bool scales) {
        Eigen::Affine3d t = Eigen::Affine3d::Identity();
        t.translate(vector(50));
        t.rotate(Eigen::AngleAxisd(between(-3, 3), vector(1).normalized()));
        if (coin()) t.scale(Vector3(1, -1, 1));
        if (scales) t.scale(between(0.2, 30));
        return t;
    }

private:
    std::mt19937 engine_;
    std::uniform_real_distribution<double> unit_{0.0, 1.0};
};

// A curve and a stretch of it.
struct Stretch {
    Curve curve;
    double from, to;
};

inline BSplineCurve random_spline(Random& random) {
    BSplineCurve c;
    c.degree = random.integer(1, 6);
    const int inner = random.integer(0, 6);
    const bool clamped = random.integer(0, 3) != 0;
    double u = random.between(-5, 5);
    for (int i = 0; i <= c.degree; ++i) {
        c.knots.push_back(u);
        if (!clamped) u += random.between(0.1, 1);
    }
    for (int i = 0; i < inner; ++i) {
        u += random.between(0.1, 1);
        const int multiplicity = random.integer(0, 2) == 0 ? random.integer(1, c.degree) : 1;
        c.knots.insert(c.knots.end(), static_cast<std::size_t>(multiplicity), u);
    }
    u += random.between(0.1, 1);
    for (int i = 0; i <= c.degree; ++i) {
        c.knots.push_back(u);
        if (!clamped) u += random.between(0.1, 1);
    }
    const std::size_t count = c.knots.size() - static_cast<std::size_t>(c.degree) - 1;
    for (std::size_t i = 0; i < count; ++i) c.control_points.push_back(random.vector(50));
    if (random.coin()) {
        for (std::size_t i = 0; i < count; ++i) c.weights.push_back(random.between(0.2, 4));
    }
    if (clamped && count > 3 && random.coin()) {
        c.control_points.back() = c.control_points.front();
        c.closed = true;
    }
    return c;
}

inline Stretch random_stretch(Random& random) {
    Stretch s;
    s.from = random.between(-7, 7);
    s.to = random.between(-7, 7);
    switch (random.integer(0, 5)) {
        case 0: {
            const Frame frame = random.frame();
            s.curve = Line{frame.origin, frame.x};
            break;
        }
        case 1:
            s.curve = Circle{random.frame(), random.between(0.01, 80)};
            break;
        case 2:
            s.curve = Ellipse{random.frame(), random.between(0.01, 80), random.between(0.01, 80)};
            break;
        case 3:
            s.curve = Parabola{random.frame(), random.between(0.1, 5)};
            break;
        case 4:
            s.curve = Hyperbola{random.frame(), random.between(0.1, 5), random.between(0.1, 5)};
            s.from /= 2;
            s.to /= 2;
            break;
        default: {
            const BSplineCurve spline = random_spline(random);
            const double start = spline.domain_start(), end = spline.domain_end();
            s.from = random.between(start, end);
            s.to = random.between(start, spline.closed ? end + (end - start) : end);
            s.curve = spline;
        }
    }
    return s;
}

}  // namespace lyr::test
