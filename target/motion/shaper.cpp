// With d the period of the damped vibration, an impulse half a period later must be smaller by what the
// vibration has lost by then.

#include "target/motion/shaper.h"

#include <cmath>
#include <numbers>

#include "base/constants.h"

namespace lyr::motion {
namespace {

using std::numbers::pi;

struct Impulse {
    double delay_s = 0, weight = 0;
};
using Impulses = std::vector<Impulse>;

Impulses impulses_of(const Shaper& shaper) {
    const double root = std::sqrt(1 - shaper.damping * shaper.damping);
    const double period_s = 1 / (shaper.frequency_hz * root);
    const auto loss = [&](double periods) {
        return std::exp(-2 * pi * periods * shaper.damping / root);
    };
    const auto three = [&](double apart, double outer, double middle) -> Impulses {
        const double k = loss(apart);
        return {{0, outer}, {apart * period_s, middle * k}, {2 * apart * period_s, outer * k * k}};
    };
    switch (shaper.kind) {
        case ShaperKind::none:
            return {};
        case ShaperKind::zv:
            return {{0, 1}, {period_s / 2, loss(0.5)}};
        case ShaperKind::mzv:
            return three(0.375, 1 - std::numbers::sqrt2 / 2, std::numbers::sqrt2 - 1);
        case ShaperKind::ei:
            return three(0.5, (1 + ei_vibration) / 4, (1 - ei_vibration) / 2);
    }
    return {};
}

}  // namespace

Taps taps_of(const Shaper& shaper, std::size_t axis) {
    const Impulses impulses = impulses_of(shaper);
    double sum = 0, moment_s = 0;
    for (const Impulse& impulse : impulses) {
        sum += impulse.weight;
        moment_s += impulse.weight * impulse.delay_s;
    }
    Taps taps;
    for (const Impulse& impulse : impulses) {
        Tap& tap = taps.emplace_back();
        tap.offset_ns = std::llround((moment_s / sum - impulse.delay_s) * ns_per_s);
        tap.weights[axis] = impulse.weight / sum;
    }
    return taps;
}

Taps taps_of(const PressureAdvance& advance) {
    if (!(advance.advance_s > 0)) return {};
    const std::int64_t half_ns = std::llround(advance.smooth_s / 2 * ns_per_s);
    const double share = advance.advance_s / (2 * static_cast<double>(half_ns) / ns_per_s);
    Tap own, later, earlier;
    own.weights[axis_e] = 1;
    later.offset_ns = half_ns;
    later.weights[pressed_channel] = share;
    earlier.offset_ns = -half_ns;
    earlier.weights[pressed_channel] = -share;
    return {own, later, earlier};
}

}  // namespace lyr::motion
