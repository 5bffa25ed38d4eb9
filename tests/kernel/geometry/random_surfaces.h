// Random B-spline surfaces for properties that must hold of every one: any degree, any knots, any weights.

#pragma once

#include "kernel/geometry/bspline_surface.h"
#include "kernel/geometry/random_curves.h"

namespace lyr::test {

struct RandomKnots {
    int degree;
    std::vector<double> knots;
    bool clamped;

    std::size_t count() const { return knots.size() - static_cast<std::size_t>(degree) - 1; }
};

inline RandomKnots random_knots(Random& random, int highest_degree) {
    RandomKnots k;
    k.degree = random.integer(1, highest_degree);
    k.clamped = random.integer(0, 3) != 0;
    double t = random.between(-5, 5);
    const auto end = [&] {
        for (int i = 0; i <= k.degree; ++i) {
            k.knots.push_back(t);
            if (!k.clamped) t += random.between(0.1, 1);
        }
    };
    end();
    for (int inner = random.integer(0, 4); inner > 0; --inner) {
        t += random.between(0.1, 1);
        const int multiplicity = random.integer(0, 2) == 0 ? random.integer(1, k.degree) : 1;
        k.knots.insert(k.knots.end(), static_cast<std::size_t>(multiplicity), t);
    }
    t += random.between(0.1, 1);
    end();
    return k;
}

// A bumpy sheet about 50 mm wide; half of them with weights, some closed in one direction or with a pole.
inline BSplineSurface random_surface(Random& random, int highest_degree = 5) {
    const RandomKnots u = random_knots(random, highest_degree);
    const RandomKnots v = random_knots(random, highest_degree);
    BSplineSurface s{u.degree, v.degree, u.count(), v.count(), u.knots, v.knots, {}, {}};
    for (std::size_t i = 0; i < s.count_u; ++i) {
        for (std::size_t j = 0; j < s.count_v; ++j) {
            const Point3 in_sheet(50.0 * static_cast<double>(i) / static_cast<double>(s.count_u),
                                  50.0 * static_cast<double>(j) / static_cast<double>(s.count_v),
                                  0);
            s.control_points.push_back(in_sheet + random.vector(8));
        }
    }
    if (random.coin()) {
        for (std::size_t i = 0; i < s.control_points.size(); ++i) {
            s.weights.push_back(random.between(0.3, 3));
        }
    }
    const auto line = [&](std::size_t i) {
        return s.control_points.begin() + static_cast<std::ptrdiff_t>(i * s.count_v);
    };
    const int shape = u.clamped ? random.integer(0, 3) : 0;
    if (shape == 1 && s.count_u > 3) {
        std::copy(line(0), line(1), line(s.count_u - 1));
        if (!s.weights.empty()) {
            for (std::size_t j = 0; j < s.count_v; ++j) {
                s.weights[(s.count_u - 1) * s.count_v + j] = s.weights[j];
            }
        }
        s.closed_u = true;
    }
    if (shape == 2) std::fill(line(0), line(1), s.control_points.front());
    return s;
}

inline Point2 random_parameters(Random& random, const BSplineSurface& s) {
    return {random.between(s.start_u(), s.end_u()), random.between(s.start_v(), s.end_v())};
}

}  // namespace lyr::test
