// Green's theorem in the parameters: the integral of a density over a region is that of its antiderivative along v,
// taken at the region's boundary with the boundary's steps in u. Loops are followed in (u, v) through seams, so that
// on a closed surface they may end a turn away from where they began. Then there is no saying from a loop alone which
// of two regions it bounds, and the whole surface is added where the region is the rest of it.

#include "kernel/brep/freeform_integrals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "kernel/brep/parameter_loops.h"

namespace lyr {

namespace {

using Homogeneous = Eigen::Vector4d;

struct Integrals {
    double area = 0, flux = 0;

    Integrals& operator+=(const Integrals& other) { return add(other, 1); }
    Integrals& add(const Integrals& other, double share) {
        area += share * other.area;
        flux += share * other.flux;
        return *this;
    }
};

// The basis functions that do not vanish at a parameter, from the `first` on, and their slopes.
struct Basis {
    std::size_t first;
    std::array<double, highest_surface_degree + 1> value, slope;
};

Basis basis_at(const std::vector<double>& knots, int degree, std::size_t count, double t) {
    const auto begin = knots.begin() + degree, end = knots.begin() + static_cast<long>(count);
    const auto above = std::upper_bound(begin, std::lower_bound(begin, end, *end), t);
    const double* const span = &*std::max(above - 1, begin);
    Basis basis{static_cast<std::size_t>(span - knots.data() - degree), {}, {}};
    basis.value[0] = 1;
    for (int d = 1; d <= degree; ++d) {
        double value = 0, slope = 0;
        for (int r = 0; r < d; ++r) {
            const auto i = static_cast<std::size_t>(r);
            const double low = span[r + 1 - d], high = span[r + 1];
            const double term = basis.value[i] / (high - low);
            basis.value[i] = value + (high - t) * term;
            value = (t - low) * term;
            basis.slope[i] = d * (slope - term);
            slope = term;
        }
        basis.value[static_cast<std::size_t>(d)] = value;
        basis.slope[static_cast<std::size_t>(d)] = d * slope;
    }
    return basis;
}

// Integrals along lines of constant u, from the start of v.
class Columns {
public:
    Columns(const BSplineSurface& surface, const Point3& c, const Fineness& fineness)
        : s_(surface) {
        const auto borders = panel_borders(s_.knots_v, s_.start_v(), s_.end_v(), fineness);
        for (std::size_t panel = 0; panel + 1 < borders.size(); ++panel) {
            const double width = borders[panel + 1] - borders[panel];
            for (std::size_t g = 0; g < gauss_at.size(); ++g) {
                const double v = borders[panel] + gauss_at[g] * width;
                stations_.push_back({v, gauss_weight[g] * width, basis_v(v)});
            }
        }
        borders_ = borders;
        for (std::size_t i = 0; i < s_.control_points.size(); ++i) {
            const double w = s_.weights.empty() ? 1 : s_.weights[i];
            control_points_.push_back(
                (Homogeneous() << w * (s_.control_points[i] - c), w).finished());
        }
    }

    Integrals up_to(const Point2& uv) {
        collapse(uv.x());
        const double start = s_.start_v(), length = s_.end_v() - start;
        double v = uv.y(), turns = 0;
        if (s_.closed_v) {
            turns = std::floor((v - start) / length);
            v -= turns * length;
        }
        Integrals sum;
        if (turns != 0) sum.add(within(s_.end_v()), turns);
        return sum += within(v);
    }
    Integrals whole_at(double u) {
        collapse(u);
        return within(s_.end_v());
    }

private:
    struct Station {
        double v, weight;
        Basis basis;
    };

    Basis basis_v(double v) const { return basis_at(s_.knots_v, s_.degree_v, s_.count_v, v); }

    // The line's control points and those of its derivative by u.
    void collapse(double u) {
        const double start = s_.start_u(), length = s_.end_u() - start;
        if (s_.closed_u) u -= std::floor((u - start) / length) * length;
        u = std::clamp(u, start, s_.end_u());
        const Basis basis = basis_at(s_.knots_u, s_.degree_u, s_.count_u, u);
        points_.assign(s_.count_v, Homogeneous::Zero());
        slopes_.assign(s_.count_v, Homogeneous::Zero());
        for (std::size_t i = 0; i <= static_cast<std::size_t>(s_.degree_u); ++i) {
            const Homogeneous* const row = &control_points_[(basis.first + i) * s_.count_v];
            for (std::size_t j = 0; j < s_.count_v; ++j) {
                points_[j] += basis.value[i] * row[j];
                slopes_[j] += basis.slope[i] * row[j];
            }
        }
    }

    // Of the collapsed line. Whole panels have stations, the last one is taken for itself.
    Integrals within(double v) const {
        const auto above = std::upper_bound(borders_.begin(), borders_.end() - 1, v);
        const auto panel =
            static_cast<std::size_t>(std::max(above - 1, borders_.begin()) - borders_.begin());
        Integrals sum;
        const bool whole = v >= borders_.back();
        const std::size_t stations = whole ? stations_.size() : panel * gauss_at.size();
        for (std::size_t i = 0; i < stations; ++i) {
            sum.add(density(stations_[i].basis), stations_[i].weight);
        }
        const double width = v - borders_[panel];
        if (whole || !(width > 0)) return sum;
        for (std::size_t g = 0; g < gauss_at.size(); ++g) {
            sum.add(density(basis_v(borders_[panel] + gauss_at[g] * width)),
                    gauss_weight[g] * width);
        }
        return sum;
    }

    Integrals density(const Basis& basis) const {
        Homogeneous point = Homogeneous::Zero(), du = point, dv = point;
        for (std::size_t j = 0; j <= static_cast<std::size_t>(s_.degree_v); ++j) {
            point += basis.value[j] * points_[basis.first + j];
            du += basis.value[j] * slopes_[basis.first + j];
            dv += basis.slope[j] * points_[basis.first + j];
        }
        const Vector3 p = point.head<3>() / point.w();
        const Vector3 across =
            (du.head<3>() - du.w() * p).cross(dv.head<3>() - dv.w() * p) / (point.w() * point.w());
        return {across.norm(), p.dot(across)};
    }

    const BSplineSurface& s_;
    std::vector<Station> stations_;
    std::vector<double> borders_;
    std::vector<Homogeneous> control_points_;
    std::vector<Homogeneous> points_, slopes_;
};

BSplineSurface transposed(const BSplineSurface& s) {
    BSplineSurface t{s.degree_v, s.degree_u, s.count_v,  s.count_u,  s.knots_v,  s.knots_u,
                     {},         {},         s.closed_v, s.closed_u, !s.mirrored};
    for (std::size_t j = 0; j < s.count_v; ++j) {
        for (std::size_t i = 0; i < s.count_u; ++i) {
            t.control_points.push_back(s.control_points[i * s.count_v + j]);
            if (!s.weights.empty()) t.weights.push_back(s.weights[i * s.count_v + j]);
        }
    }
    return t;
}

class FaceIntegral {
public:
    FaceIntegral(const BSplineSurface& surface, std::vector<ParameterLoop> loops, const Point3& c,
                 const Fineness& fineness)
        : s_(surface),
          fineness_(fineness),
          loops_(std::move(loops)),
          columns_(s_, c, fineness),
          period_(periods_of(s_)),
          pole_at_start_(pole_of(s_, true, false)),
          pole_at_end_(pole_of(s_, true, true)) {}

    // With loops as they are about a normal along d/du x d/dv (+1) or against it (-1).
    FreeformIntegrals result(double sense) {
        for (const ParameterLoop& loop : loops_) {
            for (const ParameterNode& node : loop.nodes) add(node.uv, node.step.x());
            if (pole_at_end_) add_jumps(loop);
            turns_ += turns_of(loop, period_).x();
        }
        Integrals inside;
        inside.add(sum_, sense);
        if (const double share = rest(sense); share != 0) inside.add(whole(), share);
        return {inside.area, sense * inside.flux};
    }

private:
    void add(const Point2& uv, double step_u) {
        // Steps along a line of constant u are round-off only.
        constexpr double negligible_share = 1e-9;
        if (std::abs(step_u) <= negligible_share * (s_.end_u() - s_.start_u())) return;
        sum_.add(columns_.up_to(uv), -step_u);
        parameter_area_ -= (uv.y() - s_.start_v()) * step_u;
    }

    // At a pole a loop passes from one line of constant u to another without an edge.
    void add_jumps(const ParameterLoop& loop) {
        for (const PolePassage& passage : loop.passages) {
            if (passage.pole != *pole_at_end_) continue;
            const bool is_first = passage.next_node % loop.nodes.size() == 0;
            const Point2 from =
                is_first ? loop.nodes.back().uv : loop.nodes[passage.next_node - 1].uv;
            const Point2 to = is_first ? followed(loop.nodes.front().uv, from, period_)
                                       : loop.nodes[passage.next_node].uv;
            const double width = (to.x() - from.x()) / fineness_.most;
            for (int panel = 0; panel < fineness_.most; ++panel) {
                for (std::size_t g = 0; g < gauss_at.size(); ++g) {
                    add({from.x() + (panel + gauss_at[g]) * width, s_.end_v()},
                        gauss_weight[g] * width);
                }
            }
        }
    }

    // How many times the whole surface belongs to the region besides what the loops bound.
    double rest(double sense) const {
        const double turns = sense * turns_;
        if (turns > 0) return pole_at_end_ ? 1 : 0;
        if (turns < 0) return pole_at_start_ || !pole_at_end_ ? 0 : -1;
        if (!s_.closed_u) return 0;
        constexpr double closeness = 1e-8;  // a smaller share of the whole is no face but round-off
        const double share =
            sense * parameter_area_ / (s_.end_u() - s_.start_u()) / (s_.end_v() - s_.start_v());
        if (s_.closed_v) return -std::floor(share - closeness);
        return pole_at_start_ && pole_at_end_ && share <= closeness ? 1 : 0;
    }

    Integrals whole() {
        Integrals sum;
        const auto borders = panel_borders(s_.knots_u, s_.start_u(), s_.end_u(), fineness_);
        for (std::size_t panel = 0; panel + 1 < borders.size(); ++panel) {
            const double width = borders[panel + 1] - borders[panel];
            for (std::size_t g = 0; g < gauss_at.size(); ++g) {
                sum.add(columns_.whole_at(borders[panel] + gauss_at[g] * width),
                        gauss_weight[g] * width);
            }
        }
        return sum;
    }

    const BSplineSurface& s_;
    Fineness fineness_;
    std::vector<ParameterLoop> loops_;
    Columns columns_;
    Vector2 period_;
    std::optional<Point3> pole_at_start_, pole_at_end_;
    Integrals sum_;
    double parameter_area_ = 0;
    int turns_ = 0;
};

// Whether v is the parameter that loops wind in, or could: then it has to be the one that the steps are in.
bool winds_along_v(const BSplineSurface& s, const std::vector<ParameterLoop>& loops) {
    Eigen::Vector2i most = Eigen::Vector2i::Zero();
    for (const ParameterLoop& loop : loops) {
        most = most.cwiseMax(turns_of(loop, periods_of(s)).cwiseAbs());
    }
    if (most != Eigen::Vector2i::Zero()) return most.y() > 0 && most.x() == 0;
    return s.closed_v && !s.closed_u;
}

}  // namespace

FreeformIntegrals freeform_integrals(const Model& model, const Face& face, const Point3& c,
                                     const Fineness& fineness) {
    const BSplineSurface& surface = *std::get<SharedBSplineSurface>(face.surface);
    const double sense = face.same_sense != surface.mirrored ? 1 : -1;
    std::vector<ParameterLoop> loops = parameter_loops(model, face, fineness);
    if (!winds_along_v(surface, loops)) {
        return FaceIntegral(surface, std::move(loops), c, fineness).result(sense);
    }
    for (ParameterLoop& loop : loops) {
        for (ParameterNode& node : loop.nodes) {
            std::swap(node.uv.x(), node.uv.y());
            std::swap(node.step.x(), node.step.y());
        }
    }
    const BSplineSurface across = transposed(surface);
    return FaceIntegral(across, std::move(loops), c, fineness).result(-sense);
}

}  // namespace lyr
