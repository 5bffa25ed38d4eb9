// The point of a B-spline surface that is nearest to a given one.
//
// A guess becomes exact by Newton's method on the squared distance. That no other part of the surface is nearer is
// shown, not sampled: knot spans and then halves of Bezier patches wait in a queue, nearest lower bound first, until
// none is left that could hold a nearer point. The bound of a patch is the smallest coefficient of its squared
// distance in Bernstein form, which is off by the square of the patch's size only. A patch on which that form is
// convex has one minimum, which Newton's method finds.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "kernel/geometry/bspline_jet.h"
#include "kernel/geometry/bspline_surface.h"
#include "kernel/geometry/distance_cell.h"
#include "kernel/geometry/tolerance.h"

namespace lyr {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Vector2 extent(const BSplineSurface& s) {
    return {s.end_u() - s.start_u(), s.end_v() - s.start_v()};
}

struct Foot {
    Point2 uv;
    double distance_mm;
};

// Half the squared distance's first and second derivatives.
struct Slope {
    Vector2 gradient;
    Eigen::Matrix2d hessian, gauss;  // `gauss` leaves second derivatives of the surface out

    Slope(const SurfaceJet& jet, const Vector3& offset) {
        gradient = {offset.dot(jet.du), offset.dot(jet.dv)};
        gauss(0, 0) = jet.du.squaredNorm();
        gauss(0, 1) = gauss(1, 0) = jet.du.dot(jet.dv);
        gauss(1, 1) = jet.dv.squaredNorm();
        hessian = gauss;
        hessian(0, 0) += offset.dot(jet.duu);
        hessian(0, 1) += offset.dot(jet.duv);
        hessian(1, 0) = hessian(0, 1);
        hessian(1, 1) += offset.dot(jet.dvv);
    }
};

bool is_definite(const Eigen::Matrix2d& m) {
    constexpr double smallest_share =
        1e-12;  // of the product of diagonals; below it, a singular matrix
    return m(0, 0) > 0 && m(1, 1) > 0 && m.determinant() > smallest_share * m(0, 0) * m(1, 1);
}

Vector2 solved(const Eigen::Matrix2d& m, const Vector2& b) {
    return Vector2(m(1, 1) * b.x() - m(0, 1) * b.y(), m(0, 0) * b.y() - m(1, 0) * b.x()) /
           m.determinant();
}

// A step that goes down, with the parameters that the window holds back left alone.
Vector2 step_down(Slope slope, const Point2& at, const Window& window) {
    for (const int i : {0, 1}) {
        const bool held = (at[i] <= window.low[i] && slope.gradient[i] > 0) ||
                          (at[i] >= window.high[i] && slope.gradient[i] < 0);
        if (!held) continue;
        slope.gradient[i] = 0;
        for (Eigen::Matrix2d* m : {&slope.hessian, &slope.gauss}) {
            (*m)(0, 1) = (*m)(1, 0) = 0;
            (*m)(i, i) = 1;
        }
    }
    if (is_definite(slope.hessian)) return -solved(slope.hessian, slope.gradient);
    if (is_definite(slope.gauss)) return -solved(slope.gauss, slope.gradient);
    Vector2 step = Vector2::Zero();
    for (const int i : {0, 1}) {
        if (slope.gauss(i, i) > 0) step[i] = -slope.gradient[i] / slope.gauss(i, i);
    }
    return step;
}

// Distances below this are none: a thousandth of what two points may be apart and be one.
constexpr double exact_mm = resolution_mm / 1000;

Foot descend(const BSplineSurface& s, const Point3& point, const Point2& start,
             const Window& window) {
    constexpr int max_steps = 50, max_halvings = 20;
    // Shares of the squared distance: where the fall drowns in round-off, and where a step cannot be judged by it
    // but, Newton's method converging by squares, is the last one that is needed.
    constexpr double no_fall = 1e-16, last_fall = 1e-11;
    Point2 at = window.clamped(start);
    SurfaceJet jet = second_partials(s, at, window);
    double square = (jet.point - point).squaredNorm();
    for (int i = 0; i < max_steps && square > exact_mm * exact_mm; ++i) {
        const Slope slope(jet, jet.point - point);
        const Vector2 step = step_down(slope, at, window);
        const double fall = -slope.gradient.dot(step);
        if (!(fall > no_fall * square)) break;
        bool moved = false;
        double share = 1;
        for (int k = 0; k < max_halvings && !moved; ++k, share /= 2) {
            const Point2 next = window.clamped(at + share * step);
            const SurfaceJet next_jet = second_partials(s, next, window);
            const double next_square = (next_jet.point - point).squaredNorm();
            if (!(next_square < square) && fall > last_fall * square) continue;
            if (next_square <= square * (1 + last_fall)) {
                at = next;
                jet = next_jet;
                square = next_square;
                moved = true;
            }
        }
        if (!moved || fall <= last_fall * square) break;
    }
    return {at, std::sqrt(square)};
}

// Where parameters at the end of a smooth window lie in the next one, if there is one.
std::optional<Point2> beyond(const BSplineSurface& s, const Window& window, Point2 uv, int axis) {
    const double start = axis == 0 ? s.start_u() : s.start_v();
    const double end = axis == 0 ? s.end_u() : s.end_v();
    const bool closed = axis == 0 ? s.closed_u : s.closed_v;
    if (uv[axis] == window.low[axis] && (closed || uv[axis] > start)) {
        // The last double of the window before.
        uv[axis] = std::nextafter(uv[axis] > start ? uv[axis] : end, start);
        return uv;
    }
    if (uv[axis] != window.high[axis] || (!closed && uv[axis] == end)) return std::nullopt;
    if (uv[axis] == end) uv[axis] = start;
    return uv;
}

// Downhill as far as it goes, over kinks and seams.
Foot descend(const BSplineSurface& s, const Point3& point, const Point2& start) {
    // Down a staircase, a step a window: enough to leave any of them that is of the size of the guess' error.
    constexpr int max_windows = 32;
    constexpr double gain = 1e-9;  // a share of the distance; what round-off may feign is less
    Window window = smooth_window(s, start);
    Foot best = descend(s, point, start, window);
    for (int i = 0; i < max_windows && best.distance_mm > exact_mm; ++i) {
        const std::optional<Point2> along_u = beyond(s, window, best.uv, 0);
        const std::optional<Point2> along_v = beyond(s, window, best.uv, 1);
        std::array<std::optional<Point2>, 3> starts{along_u, along_v, std::nullopt};
        if (along_u && along_v) starts[2] = Point2(along_u->x(), along_v->y());
        bool nearer = false;
        for (const std::optional<Point2>& next : starts) {
            if (!next) continue;
            const Window there = smooth_window(s, *next);
            const Foot foot = descend(s, point, *next, there);
            if (!(foot.distance_mm < best.distance_mm * (1 - gain))) continue;
            best = foot;
            window = there;
            nearer = true;
            break;
        }
        if (!nearer) break;
    }
    return best;
}

class NearestOnSurface {
public:
    NearestOnSurface(const BSplineSurface& surface, const Point3& point, double enough_mm)
        : s_(surface), point_(point), enough_mm_(enough_mm) {}

    Point2 find() {
        descend_from(greville_of_nearest_control_point());
        if (!worth_a_look(0)) return best_.uv;
        queue_spans();
        // Only about the centre of what is all but a sphere are more cells needed, and there all are as near.
        constexpr int max_cells = 200000;
        for (int cells = 0; !queue_.empty() && cells < max_cells; ++cells) {
            std::pop_heap(queue_.begin(), queue_.end());
            Task task = std::move(queue_.back());
            queue_.pop_back();
            if (!worth_a_look(task.bound_mm)) break;
            if (task.cell.points.empty()) {
                push(cell_about(bezier_patch(s_, task.span_u, task.span_v), point_));
            } else {
                visit(task);
            }
        }
        return best_.uv;
    }

private:
    // A knot span, of which the cell is still to be made, or a cell. In the queue, a heap, the nearest comes first.
    struct Task {
        double bound_mm;
        std::size_t span_u = 0, span_v = 0;
        Cell cell = {};
        bool convex = false, split_u = false;

        bool operator<(const Task& other) const { return bound_mm > other.bound_mm; }
    };

    // Whether a bound leaves room for a point that is nearer by more than what does not matter.
    bool worth_a_look(double bound_mm) const {
        constexpr double indifferent_share = 1e-6;
        return best_.distance_mm > enough_mm_ &&
               bound_mm < best_.distance_mm * (1 - indifferent_share) - exact_mm;
    }

    void wait(Task task) {
        queue_.push_back(std::move(task));
        std::push_heap(queue_.begin(), queue_.end());
    }

    void offer(const Foot& foot) {
        if (foot.distance_mm < best_.distance_mm) best_ = foot;
    }
    void descend_from(const Point2& start) { offer(descend(s_, point_, start)); }

    Point2 greville_of_nearest_control_point() const {
        std::size_t nearest = 0;
        double least = infinity;
        for (std::size_t i = 0; i < s_.control_points.size(); ++i) {
            const double square = (s_.control_points[i] - point_).squaredNorm();
            if (square < least) {
                least = square;
                nearest = i;
            }
        }
        const auto mean_knot = [](const std::vector<double>& knots, std::size_t i, int degree) {
            double sum = 0;
            for (int k = 1; k <= degree; ++k) sum += knots[i + static_cast<std::size_t>(k)];
            return sum / degree;
        };
        const Point2 uv(mean_knot(s_.knots_u, nearest / s_.count_v, s_.degree_u),
                        mean_knot(s_.knots_v, nearest % s_.count_v, s_.degree_v));
        return uv.cwiseMax(Point2(s_.start_u(), s_.start_v()))
            .cwiseMin(Point2(s_.end_u(), s_.end_v()));
    }

    void queue_spans() {
        const auto degree_u = static_cast<std::size_t>(s_.degree_u);
        const auto degree_v = static_cast<std::size_t>(s_.degree_v);
        for (std::size_t u = degree_u; u < s_.count_u; ++u) {
            if (!(s_.knots_u[u] < s_.knots_u[u + 1])) continue;
            for (std::size_t v = degree_v; v < s_.count_v; ++v) {
                if (!(s_.knots_v[v] < s_.knots_v[v + 1])) continue;
                Eigen::AlignedBox3d box;
                for (std::size_t i = u - degree_u; i <= u; ++i) {
                    for (std::size_t j = v - degree_v; j <= v; ++j) {
                        box.extend(s_.control_points[i * s_.count_v + j]);
                    }
                }
                const double bound = box.exteriorDistance(point_);
                if (worth_a_look(bound)) wait({bound, u, v});
            }
        }
    }

    void push(Cell cell) {
        if (!worth_a_look(box_distance_mm(cell))) return;
        const DistanceForm form(cell, s_.degree_u, s_.degree_v);
        const double bound = form.lower_bound_mm();
        if (!worth_a_look(bound)) return;
        const bool convex = s_.weights.empty() && form.is_convex();
        wait({bound, 0, 0, std::move(cell), convex, form.varies_more_along_u()});
    }

    void visit(Task& task) {
        const Window window = task.cell.window;
        const Point2 middle = 0.5 * (window.low + window.high);
        if (task.convex) {
            offer(descend(s_, point_, middle, window));
            return;
        }
        if ((evaluate(s_, middle) - point_).norm() < best_.distance_mm) descend_from(middle);
        constexpr double smallest_share = 1e-15;  // of the domain: the spacing of doubles
        const int along = task.split_u ? 0 : 1;
        if (window.high[along] - window.low[along] <= smallest_share * extent(s_)[along]) return;
        auto [left, right] = halves(std::move(task.cell), s_.degree_u, s_.degree_v, along);
        push(std::move(left));
        push(std::move(right));
    }

    const BSplineSurface& s_;
    Point3 point_;
    double enough_mm_;
    Foot best_{Point2::Zero(), infinity};
    std::vector<Task> queue_ = {};
};

// Where Newton's method cannot tell which way to go: a side of the surface is one point.
bool at_pole(const BSplineSurface& s, const Point2& uv) {
    const Partials at = partials(s, uv);
    const Vector2 size = extent(s);
    return at.du.norm() * size.x() <= resolution_mm || at.dv.norm() * size.y() <= resolution_mm;
}

}  // namespace

Point2 invert(const BSplineSurface& surface, const Point3& point, double enough_mm) {
    return NearestOnSurface(surface, point, enough_mm).find();
}

Point2 invert_near(const BSplineSurface& surface, const Point3& point, const Point2& guess) {
    const Foot foot = descend(surface, point, into_domain(surface, guess));
    if (foot.distance_mm > resolution_mm && at_pole(surface, foot.uv))
        return invert(surface, point);
    return foot.uv;
}

}  // namespace lyr
