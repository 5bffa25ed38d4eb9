// The gyroid sin x cos y + sin y cos z + sin z cos x = 0 at one height, in closed form. Where |sin z| <= |cos z| it is a
// sum of two sines of y,
//     sqrt(sin^2 x + cos^2 z) sin(y + a) = -sin z cos x,  a = atan2(sin x, cos z),
// which has two solutions y for every x; else the same holds for x as a function of y, with
//     sqrt(sin^2 z + cos^2 y) sin(x + a) = -cos z sin y,  a = atan2(sin z, cos y).
// One solution is made arcs over one period. Turned by half a turn about (0, pi/2) the gyroid is itself, and that
// solution the other.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/contour/fit.h"
#include "kernel/toolpath/infill_waves.h"

namespace lyr {
namespace {

using std::numbers::pi;

// The mean length of the curves of all heights, in an area whose sides are the period: as often the period as this.
// Integrated numerically from the formulas above, to the last digit.
constexpr double mean_length = 2.4588;

// Where |sin z| is just |cos z| curves have corners where they touch each other. Heights keep off it by this angle: a
// thousandth of a millimetre in cells of several millimetres.
constexpr double corner_angle_rad = 1e-3;

// Arcs may leave the curve by this share of the strand's width: nobody sees it, and there are few of them.
constexpr double fit_share = 0.05;

class Slice {
public:
    explicit Slice(double z) : sin_z_(std::sin(z)), cos_z_(std::cos(z)) {}

    bool along_x() const { return std::abs(sin_z_) <= std::abs(cos_z_); }

    // At x, or at y, from 0 to 2 pi.
    CurvePoint at(double t) const {
        const Point2 p = along_x()
                             ? Point2(t, solution(std::sin(t), cos_z_, -sin_z_ * std::cos(t)))
                             : Point2(solution(sin_z_, std::cos(t), -cos_z_ * std::sin(t)), t);
        const double slope_x = std::cos(p.x()) * std::cos(p.y()) - sin_z_ * std::sin(p.x());
        const double slope_y = cos_z_ * std::cos(p.y()) - std::sin(p.x()) * std::sin(p.y());
        const Vector2 tangent = Vector2(slope_y, -slope_x).normalized();
        const double ahead = along_x() ? tangent.x() : tangent.y();
        return {p, ahead < 0 ? Vector2(-tangent) : tangent};
    }

private:
    // u of sine cos u + cosine sin u = value, continuous along the curve: on it either the sine or the cosine keeps its
    // sign, and the angle of the two must not jump where the other one changes.
    double solution(double sine, double cosine, double value) const {
        double a = std::atan2(sine, cosine);
        if (along_x() && cosine < 0 && a < 0) a += 2 * pi;
        const double size = std::hypot(sine, cosine);
        return std::asin(std::clamp(value / size, -1.0, 1.0)) - a;
    }

    double sin_z_, cos_z_;
};

// An angle that is off the odd multiples of a quarter of pi.
double off_corners(double z) {
    const double corner = (std::floor(z / (pi / 2)) + 0.5) * pi / 2;
    if (std::abs(z - corner) >= corner_angle_rad) return z;
    return z < corner ? corner - corner_angle_rad : corner + corner_angle_rad;
}

}  // namespace

WavePattern gyroid_waves(const InfillRequest& request) {
    const double s = line_spacing_mm(request.width_mm, request.height_mm);
    const double period = mean_length * s / request.density, unit = period / (2 * pi);
    const Slice slice(off_corners(request.z_mm / unit));
    // Waves run along x: those along y are seen from a quarter of a turn on, and the pattern is turned back.
    const double turn = slice.along_x() ? 0 : pi / 2;
    const auto seen = [&](const Vector2& v) {
        return slice.along_x() ? v : Vector2(v.y(), -v.x());
    };
    const auto curve = [&](double t) {
        const CurvePoint point = slice.at(t);
        return CurvePoint{unit * seen(point.point), seen(point.tangent)};
    };
    Wave wave{curve(0).point, {}};
    const Point2 end = wave.start + Vector2(period, 0);
    fit_arcs(curve, 0, 2 * pi, wave.start, end,
             std::max(request.allowed_mm, fit_share * request.width_mm), wave.segments);
    // About (0, pi/2), backwards and a period on.
    const Vector2 centre2 = unit * seen(Vector2(0, pi)) + Vector2(period, 0);
    Wave other{centre2 - end, {}};
    for (std::size_t i = wave.segments.size(); i-- > 0;) {
        const Point2& to = i == 0 ? wave.start : wave.segments[i - 1].end;
        other.segments.push_back({centre2 - to, -wave.segments[i].sagitta_mm});
    }
    return {.angle_rad = request.angle_rad + turn,
            .period_mm = period,
            .distance_mm = period,
            .spacing_mm = period / 2,
            .waves = {wave, other}};
}

}  // namespace lyr
