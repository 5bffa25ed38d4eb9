// Curves given as functions, as B-splines within a proven bound.
//
// Contract
//  1. Where approximated() gives a curve, it has the parameters of its pieces, one after the other, and is off by no
//     more than `allowed_mm` at the same parameters (contract 1 of interpolation.h, with bounds from taylor.h).
//  2. It has none where a piece is not smooth (a direction vanishes), or does not begin where the one before it ends,
//     to within resolution_mm.

#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "kernel/geometry/curve.h"
#include "kernel/geometry/taylor.h"

namespace lyr {

template <class T>
using Triple = std::array<T, 3>;

// One function, for numbers and for bounds.
struct CurveFunction {
    std::function<Triple<double>(double)> value;
    std::function<Triple<Series>(const Series&)> series;

    template <class Function>
    static CurveFunction of(const Function& f) {
        return {[f](double t) { return f(t); }, [f](const Series& t) { return f(t); }};
    }
};

// Smooth from one parameter to the other.
struct SmoothPiece {
    double from, to;
    CurveFunction function;
};

std::optional<BSplineCurve> approximated(const std::vector<SmoothPiece>& pieces, double allowed_mm);

}  // namespace lyr
