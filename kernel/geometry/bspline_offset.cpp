// A grid of patches, each through points of the exact offset, refined until all of them are proved close.

#include "kernel/geometry/bspline_offset.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "kernel/geometry/interpolation.h"
#include "kernel/geometry/offset_patch.h"

namespace lyr {

namespace {

using namespace offset_patch;

// A side that is shorter than the model's coordinates resolve is a pole.
BSplineSurface with_exact_poles(BSplineSurface s) {
    const auto collapse = [&](std::size_t first, std::size_t stride, std::size_t count) {
        const Point3 pole = s.control_points[first];
        for (std::size_t k = 0; k < count; ++k) {
            if ((s.control_points[first + k * stride] - pole).norm() > resolution_mm) return;
        }
        for (std::size_t k = 0; k < count; ++k) s.control_points[first + k * stride] = pole;
    };
    collapse(0, 1, s.count_v);
    collapse((s.count_u - 1) * s.count_v, 1, s.count_v);
    collapse(0, s.count_v, s.count_u);
    collapse(s.count_v - 1, s.count_v, s.count_u);
    return s;
}

class OffsetGrid {
public:
    OffsetGrid(BSplineSurface surface, double distance_mm, double closable_mm)
        : surface_(std::move(surface)),
          distance_mm_(surface_.mirrored ? -distance_mm : distance_mm),
          closable_mm_(closable_mm) {
        BezierPatches patches = bezier_patches(surface_);
        spans_v_ = patches.spans_v;
        for (const BezierPatch& patch : patches.patches) {
            wholes_.push_back(piece_of(patch, !surface_.weights.empty()));
            from_to_.push_back({patch.from_u, patch.to_u, patch.from_v, patch.to_v});
        }
        for (std::size_t i = 0; i < patches.spans_u; ++i) u_.push_back({i, 0, 1});
        for (std::size_t i = 0; i < patches.spans_v; ++i) v_.push_back({i, 0, 1});
        degree_u_ = surface_.degree_u == 1 && is_straight(0) ? 1 : interpolation::degree;
        degree_v_ = surface_.degree_v == 1 && is_straight(1) ? 1 : interpolation::degree;
    }

    std::variant<BSplineSurface, OffsetFailure> refined() {
        // Patches beyond this are those of a surface that all but folds: they get smaller without end.
        const std::size_t most_patches = 4096 + 16 * wholes_.size();
        while (u_.size() * v_.size() <= most_patches) {
            if (const std::optional<OffsetFailure> failure = build()) return *failure;
            std::vector<bool> halve_u(u_.size()), halve_v(v_.size());
            bool done = true;
            for (std::size_t i = 0; i < u_.size(); ++i) {
                for (std::size_t j = 0; j < v_.size(); ++j) {
                    const Verdict verdict = judged(i, j);
                    if (verdict.failure) return *verdict.failure;
                    if (verdict.halve_u) halve_u[i] = true;
                    if (verdict.halve_v) halve_v[j] = true;
                    done = done && !verdict.halve_u && !verdict.halve_v;
                }
            }
            if (done) return result();
            halve(u_, halve_u);
            halve(v_, halve_v);
        }
        return OffsetFailure::unreachable;
    }

private:
    struct Verdict {
        std::optional<OffsetFailure> failure = {};
        bool halve_u = false, halve_v = false;
    };

    const Piece& whole(const Stretch& u, const Stretch& v) const {
        return wholes_[u.span * spans_v_ + v.span];
    }

    // Whether the surface goes straight and evenly along a parameter, and its normal stays the same.
    bool is_straight(int along) const {
        constexpr double round_off_mm = resolution_mm / 1000;
        for (const Stretch& u : u_) {
            for (const Stretch& v : v_) {
                const Piece piece = part(whole(u, v), u, v);
                for (const double t : interpolation::nodes(interpolation::degree)) {
                    const auto at = [&](double s) {
                        return along == 0 ? Point2(s, t) : Point2(t, s);
                    };
                    const auto point = [&](double s) {
                        return surface_point(piece, at(s).x(), at(s).y());
                    };
                    const auto out = [&](double s) -> Vector3 {
                        return unit_normal(piece, at(s).x(), at(s).y());
                    };
                    if ((point(0) + point(1) - 2 * point(0.5)).norm() > round_off_mm) return false;
                    if ((out(0) - out(1)).norm() > angular_resolution_rad) return false;
                }
            }
        }
        return true;
    }

    std::size_t rows() const { return u_.size() * static_cast<std::size_t>(degree_u_) + 1; }
    std::size_t columns() const { return v_.size() * static_cast<std::size_t>(degree_v_) + 1; }

    // Control point (k, l) of the patch (i, j), in the whole net.
    std::size_t index(std::size_t i, std::size_t j, std::size_t k, std::size_t l) const {
        return (i * static_cast<std::size_t>(degree_u_) + k) * columns() +
               j * static_cast<std::size_t>(degree_v_) + l;
    }

    // The net; a gap between patches is a failure.
    std::optional<OffsetFailure> build() {
        points_.assign(rows() * columns(), Point3::Constant(std::nan("")));
        pieces_.clear();
        gaps_mm_.clear();
        for (std::size_t i = 0; i < u_.size(); ++i) {
            for (std::size_t j = 0; j < v_.size(); ++j) {
                pieces_.push_back(part(whole(u_[i], v_[j]), u_[i], v_[j]));
                const Piece& piece = pieces_.back();
                Net net = interpolated(piece, distance_mm_, degree_u_, degree_v_);
                for (Point3& p : net.points) {
                    if (!p.allFinite()) return OffsetFailure::unreachable;
                }
                place(net, i, j);
                if (gaps_mm_.back() > closable_mm_) return OffsetFailure::creased;
            }
        }
        return std::nullopt;
    }

    // Takes the control points that the patches before it have already, and adds the others.
    void place(Net& net, std::size_t i, std::size_t j) {
        double& gap_mm = gaps_mm_.emplace_back(0);
        const auto order_v = static_cast<std::size_t>(degree_v_ + 1);
        const auto there = [&](std::size_t c) -> Point3& {
            return points_[index(i, j, c / order_v, c % order_v)];
        };
        for (std::size_t c = 0; c < net.points.size(); ++c) {
            if (std::isnan(there(c).x())) continue;
            gap_mm = std::max(gap_mm, (there(c) - net.points[c]).norm());
            net.points[c] = there(c);
        }
        for (std::size_t k = 0; k < bernstein::sides.size(); ++k) {
            if (pieces_.back().pole[k]) collapse(net, bernstein::sides[k]);
        }
        for (std::size_t c = 0; c < net.points.size(); ++c) there(c) = net.points[c];
    }

    Net net_of(std::size_t i, std::size_t j) const {
        Net net{degree_u_, degree_v_, {}};
        for (std::size_t k = 0; k <= static_cast<std::size_t>(degree_u_); ++k) {
            for (std::size_t l = 0; l <= static_cast<std::size_t>(degree_v_); ++l) {
                net.points.push_back(points_[index(i, j, k, l)]);
            }
        }
        return net;
    }

    Verdict judged(std::size_t i, std::size_t j) {
        const Piece& piece = pieces_[i * v_.size() + j];
        const Net net = net_of(i, j);
        const Sign sign = facing(piece, net);
        if (sign == Sign::mixed) return {OffsetFailure::folded};
        if (sign != Sign::unknown) {
            if (facing_ != Sign::unknown && facing_ != sign) return {OffsetFailure::folded};
            facing_ = sign;
            const double allowed_mm = offset_accuracy_mm + 2 * gaps_mm_[i * v_.size() + j];
            if (error_bound_mm(piece, net, distance_mm_) <= allowed_mm) return {};
        }
        // Halving one way gains a factor of 2^8: the other way's share has to be near that to be worth halving too.
        constexpr double comparable = 32;
        const Vector2 share = unresolved_mm(net);
        const bool both = sign == Sign::unknown || share.maxCoeff() == 0;
        return {std::nullopt, both || comparable * share.x() >= share.y(),
                both || comparable * share.y() >= share.x()};
    }

    static void halve(std::vector<Stretch>& stretches, const std::vector<bool>& which) {
        std::vector<Stretch> finer;
        for (std::size_t i = 0; i < stretches.size(); ++i) {
            const Stretch& s = stretches[i];
            const double middle = 0.5 * (s.low + s.high);
            if (which[i]) finer.push_back({s.span, s.low, middle});
            finer.push_back({s.span, which[i] ? middle : s.low, s.high});
        }
        stretches = std::move(finer);
    }

    std::vector<double> knots(int along) const {
        const auto& stretches = along == 0 ? u_ : v_;
        const auto degree = static_cast<std::size_t>(along == 0 ? degree_u_ : degree_v_);
        std::vector<double> result(1, along == 0 ? surface_.start_u() : surface_.start_v());
        for (const Stretch& s : stretches) {
            const auto& ends = from_to_[along == 0 ? s.span * spans_v_ : s.span];
            const std::size_t from = along == 0 ? 0 : 2;
            result.insert(result.end(), degree, ends[from] + s.low * (ends[from + 1] - ends[from]));
        }
        result.insert(result.end(), degree + 1, along == 0 ? surface_.end_u() : surface_.end_v());
        return result;
    }

    BSplineSurface result() const {
        BSplineSurface s{degree_u_,
                         degree_v_,
                         rows(),
                         columns(),
                         knots(0),
                         knots(1),
                         points_,
                         {},
                         false,
                         false,
                         surface_.mirrored != (facing_ == Sign::negative)};
        const auto meets = [&](std::size_t a, std::size_t b) {
            return (points_[a] - points_[b]).norm() <= resolution_mm;
        };
        s.closed_u = surface_.closed_u;
        for (std::size_t j = 0; s.closed_u && j < columns(); ++j) {
            s.closed_u = meets(j, (rows() - 1) * columns() + j);
        }
        s.closed_v = surface_.closed_v;
        for (std::size_t i = 0; s.closed_v && i < rows(); ++i) {
            s.closed_v = meets(i * columns(), (i + 1) * columns() - 1);
        }
        return s;
    }

    BSplineSurface surface_;
    double distance_mm_;  // along d/du x d/dv
    double closable_mm_;
    std::size_t spans_v_ = 0;
    std::vector<Piece> wholes_;                   // the surface's patches
    std::vector<std::array<double, 4>> from_to_;  // their parameters: u, then v
    std::vector<Stretch> u_, v_;
    int degree_u_ = 0, degree_v_ = 0;
    std::vector<Piece> pieces_;
    std::vector<double> gaps_mm_;  // of each piece to those before it
    std::vector<Point3> points_;
    Sign facing_ = Sign::unknown;
};

}  // namespace

std::variant<BSplineSurface, OffsetFailure> offset(const BSplineSurface& surface,
                                                   double distance_mm, double closable_mm) {
    if (distance_mm == 0) return surface;
    return OffsetGrid(with_exact_poles(surface), distance_mm, closable_mm).refined();
}

}  // namespace lyr
