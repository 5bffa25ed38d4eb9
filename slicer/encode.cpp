#include "slicer/encode.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "kernel/contour/turned_round.h"
#include "kernel/toolpath/layer_order.h"
#include "slicer/cooling.h"
#include "slicer/overhang_walls.h"
#include "slicer/styles.h"
#include "slicer/support_order.h"
#include "slicer/wipe.h"

namespace lyr::slicer {
namespace {

using format::Role;

// The format asks for arcs of at most this; wider ones are written as two.
constexpr double widest_arc_rad = 1.5 * std::numbers::pi;

// Rounding moves a point of an arc by at most this many quanta (format/writer.h, contract 1).
constexpr double quanta_off = 1.3;

Strand reversed(Strand strand) {
    auto* path = std::get_if<Path>(&strand.path);
    if (!path) return strand;
    std::reverse(strand.widths_mm.begin(), strand.widths_mm.end());
    strand.path = turned_round(*path);
    return strand;
}

Point2 end_of(const Strand& strand) {
    const auto* path = std::get_if<Path>(&strand.path);
    return path && !path->segments.empty() ? path->segments.back().end : start_of(strand.path);
}

OpenPiece ends_of(const Piece& piece) {
    if (const auto* run = std::get_if<HatchRun>(&piece.way)) return {start_of(*run), end_of(*run)};
    const Strand& strand = std::get<Strand>(piece.way);
    return {start_of(strand.path), end_of(strand)};
}

class LayerWriter {
public:
    LayerWriter(const LayerToEncode& layer, const Options& options, format::Quantum quantum)
        : layer_(layer),
          profile_(options.profile),
          styles_(options.profile, layer.index, layer.span.height_mm()),
          held_(layer.below ? HeldWalls::of(layer.outlined, *layer.below, options) : std::nullopt),
          encoder_(quantum, state()) {}

    Result<format::EncodedLayer> encode() {
        if (!layer_.skirt.empty()) append_around(layer_.skirt);
        for (const Copy& copy : layer_.copies) append(copy);
        const auto wiped_to = retracts() ? draw_back() : std::nullopt;
        const Point2 end = wiped_to.value_or(head_.value_or(corner()));
        // From here the head goes straight to where the next layer begins.
        const double lift_mm = std::max(layer_.lift_mm, retracts() ? profile_.travel.z_hop_mm : 0);
        if (lift_mm > 0) travel_to(end, layer_.span.top_mm + lift_mm);
        return encoder_.finish();
    }

private:
    Point2 first_point() const {
        if (!layer_.skirt.empty()) return start_of(layer_.skirt.front());
        const Vector2& shift = layer_.copies.front().shift;
        if (!layer_.fill.around.empty()) return start_of(layer_.fill.around.front()) + shift;
        return (layer_.moves.empty() ? corner() : layer_.moves.front().seam.point) + shift;
    }

    // Of the first copy's box: where the head waits while there is nothing to print.
    Point2 corner() const { return {profile_.plate.at_mm[0], profile_.plate.at_mm[1]}; }

    static Point2 start_of(const Piece& closed) {
        return lyr::start_of(std::get<Strand>(closed.way).path);
    }

    void append(const Copy& copy) {
        const bool is_empty = layer_.fill.around.empty() && layer_.moves.empty();
        if (is_empty && layer_.copies.size() > 1) return;
        if (head_) *head_ += shift_ - copy.shift;
        shift_ = copy.shift;
        if (copy.object != object_) encoder_.object(copy.object);
        object_ = copy.object;
        enters_ = head_.has_value();
        append_around(layer_.fill.around);
        for (const PrintMove& move : layer_.moves) {
            if (move.is_wall) {
                append_wall(move);
            } else {
                append_piece(move);
            }
        }
    }

    // Closed, in the order in which they are printed.
    void append_around(std::span<const Piece> pieces) {
        for (const Piece& piece : pieces) {
            travel(straight_, start_of(piece));
            begin(piece_style(piece));
            append(std::get<Strand>(piece.way), start_of(piece));
            head_ = start_of(piece);
        }
    }

    format::LayerState state() {
        slow_down_for_cooling();
        format::LayerState state;
        state.z_mm = layer_.span.top_mm;
        state.height_mm = layer_.span.height_mm();
        const Point2 start = first_point();
        state.start_x_mm = start.x();
        state.start_y_mm = start.y();
        const profile::Travel& travel = profile_.travel;
        state.travel_speed_mm_s = profile_.speed.travel_mm_s;
        state.travel_acceleration_mm_s2 = profile_.acceleration.travel_mm_s2;
        state.retract_length_mm = travel.retract_length_mm;
        state.retract_speed_mm_s = travel.retract_speed_mm_s;
        state.unretract_speed_mm_s = travel.unretract_speed_mm_s;
        state.retracted_mm = layer_.begins_print ? 0 : travel.retract_length_mm;
        state.object = object_ = layer_.skirt.empty() ? layer_.copies.front().object : 0;
        retracted_ = state.retracted_mm > 0;
        const profile::Temperature& heat = profile_.temperature;
        const bool first = layer_.index == 0;
        state.temperatures.push_back({{.kind = format::HeaterKind::bed, .tool = 0},
                                      first ? heat.bed_first_layer_c : heat.bed_c});
        state.temperatures.push_back({{.kind = format::HeaterKind::tool, .tool = 0},
                                      first ? heat.nozzle_first_layer_c : heat.nozzle_c});
        if (heat.chamber_c > 0)
            state.temperatures.push_back(
                {{.kind = format::HeaterKind::chamber, .tool = 0}, heat.chamber_c});
        state.fans.push_back({0, fan_});
        return state;
    }

    // At their own speeds, of all copies.
    std::vector<Timed> all_pieces() const {
        std::vector<Timed> pieces;
        const auto copies = static_cast<double>(layer_.copies.size());
        const auto add = [&](const format::PathStyle& style, double length) {
            pieces.push_back({copies * length, style.speed_mm_s});
        };
        const Walls& walls = layer_.outlined.walls;
        for (std::size_t i = 0; i < walls.strands.size(); ++i)
            for (const WallStretch& stretch : stretches(walls.strands[i]))
                add(style_of(stretch, i), lyr::length_mm(stretch.strand.path));
        for (const Piece& piece : layer_.fill.pieces) add(piece_style(piece), length_mm(piece));
        return pieces;
    }

    // The quicker a layer, the more fan; those that are too quick are slowed down (docs/profiles.md, fan).
    void slow_down_for_cooling() {
        const profile::Fan& fan = profile_.fan;
        const std::vector<Timed> pieces = all_pieces();
        const double own_s = time_s(pieces), ramp_s = fan.ramp_time_s - fan.min_layer_time_s;
        const double share = ramp_s > 0 ? std::clamp((fan.ramp_time_s - own_s) / ramp_s, 0.0, 1.0)
                                        : (own_s < fan.min_layer_time_s ? 1.0 : 0.0);
        fan_ = layer_.index < fan.off_layers ? 0 : fan.min + share * (fan.max - fan.min);
        if (own_s < fan.min_layer_time_s)
            styles_.slow_down(slowing(pieces, fan.min_layer_time_s, fan.min_speed_mm_s));
    }

    static double width_of(const Strand& strand) {
        return strand.widths_mm.empty() ? strand.width_mm : strand.widths_mm.front();
    }

    double width_of(const Piece& piece) const {
        if (const auto* strand = std::get_if<Strand>(&piece.way))
            if (const double width = width_of(*strand); width > 0) return width;
        return piece.role == Role::sparse_infill ? profile_.infill.width_mm
                                                 : profile_.skin.width_mm;
    }

    format::PathStyle wall_style(std::size_t wall) const {
        const Walls& walls = layer_.outlined.walls;
        const Strand& strand = walls.strands[wall];
        return styles_.of(walls.depths[wall] == 0 ? Role::outer_wall : Role::inner_wall,
                          strand.width_mm, lyr::length_mm(strand.path), 1);
    }

    format::PathStyle piece_style(const Piece& piece) const {
        return styles_.of(piece.role, width_of(piece), 0, piece.flow);
    }

    bool retracts() const { return profile_.travel.retract_length_mm > 0; }

    bool wipes() const { return retracts() && profile_.travel.wipe_mm > 0; }

    void begin(const format::PathStyle& style) {
        if (style == style_) return;
        encoder_.begin_path(style);
        style_ = style;
    }

    // The order was planned without what lies around and other copies: nobody looked at the way from there.
    const Travel& way_to(const PrintMove& move) const {
        return &move == &layer_.moves.front() ? straight_ : move.travel;
    }

    void travel(const Travel& way, const Point2& to) {
        const bool enters = std::exchange(enters_, false);
        const Point2 from = head_.value_or(to);
        double length = 0;
        Point2 at = from;
        for (const Point2& via : way.via) length += (via - std::exchange(at, via)).norm();
        length += (to - at).norm();
        const bool crosses = way.crosses || !profile_.travel.avoid_crossing;
        const bool is_long = length >= profile_.travel.retract_min_travel_mm;
        const double inside_mm = profile_.travel.retract_inside_mm;
        const bool needs = crosses ? is_long || enters : inside_mm > 0 && length >= inside_mm;
        const bool draws_back = retracts() && !retracted_ && needs;
        const double hop_mm = draws_back ? profile_.travel.z_hop_mm : 0;
        const Point2 lift = draws_back ? draw_back().value_or(from) : from;
        const double z_mm = layer_.span.top_mm;
        if (hop_mm > 0) travel_to(lift, z_mm + hop_mm);
        for (const Point2& via : way.via) travel_to(via, z_mm + hop_mm);
        travel_to(to, z_mm + hop_mm);
        if (hop_mm > 0) travel_to(to, z_mm);
        if (retracted_) encoder_.unretract();
        retracted_ = false;
    }

    void travel_to(const Point2& to, double z_mm) {
        encoder_.travel_to(to.x() + shift_.x(), to.y() + shift_.y(), z_mm);
    }

    void keep(Path wipe) {
        wipe_ = std::move(wipe);
        wipe_shift_ = shift_;
    }

    // The head's place, if a wipe has moved it. It is along what was printed last, which may be of another copy.
    std::optional<Point2> draw_back() {
        retracted_ = true;
        const Path wipe = std::move(wipe_);
        wipe_.segments.clear();
        if (wipe.segments.empty()) {
            encoder_.retract();
            return std::nullopt;
        }
        const double before_mm = depth_before_wipe_mm(wipe, profile_);
        if (before_mm > 0) encoder_.retract_to(before_mm);
        encoder_.wipe(wipe_pieces(wipe, wipe_shift_), profile_.travel.retract_length_mm);
        return wipe.segments.back().end + wipe_shift_ - shift_;
    }

    void append_wall(const PrintMove& move) {
        const Strand wall = started_at(layer_.outlined.walls.strands[move.index], move.seam);
        travel(way_to(move), move.seam.point);
        if (wipes()) keep(wipe_along(wall, move.seam.point, profile_.travel.wipe_mm));
        for (const WallStretch& stretch : stretches(wall, move.seam.point)) {
            if (stretch.over_air) encoder_.fan(0, profile_.bridge.fan);
            begin(style_of(stretch, move.index));
            draw(stretch.strand);
            if (stretch.over_air) encoder_.fan(0, fan_);
        }
        head_ = move.seam.point;
    }

    std::vector<WallStretch> stretches(const Strand& wall,
                                       const std::optional<Point2>& start = {}) const {
        if (!held_) return {{wall}};
        return held_->stretches(wall, start.value_or(lyr::start_of(wall.path)));
    }

    format::PathStyle style_of(const WallStretch& stretch, std::size_t wall) const {
        return stretch.over_air ? styles_.of(Role::overhang_wall, stretch.strand.width_mm, 0, 1)
                                : wall_style(wall);
    }

    void append_piece(const PrintMove& move) {
        const Piece& piece = layer_.fill.pieces[move.index];
        const bool bridges = is_bridge(piece.role);
        travel(way_to(move), move.seam.point);
        if (bridges) encoder_.fan(0, profile_.bridge.fan);
        begin(piece_style(piece));
        if (const auto* run = std::get_if<HatchRun>(&piece.way)) {
            append(move.reversed ? lyr::reversed(*run) : *run);
        } else {
            const Strand& strand = std::get<Strand>(piece.way);
            append(move.reversed ? reversed(strand) : strand, move.seam.point);
        }
        if (bridges) encoder_.fan(0, fan_);
        const OpenPiece ends = ends_of(piece);
        head_ = move.reversed ? ends.first : ends.last;
    }

    void append(const Strand& strand, const Point2& start) {
        if (wipes()) keep(wipe_along(strand, start, profile_.travel.wipe_mm));
        draw(strand);
    }

    void draw(const Strand& strand) {
        if (const auto* circle = std::get_if<FullCircle>(&strand.path)) {
            const Point2 centre = circle->centre + shift_;
            encoder_.circle(centre.x(), centre.y(), circle->counter_clockwise);
            return;
        }
        const Path& path = std::get<Path>(strand.path);
        Point2 from = path.start;
        for (std::size_t i = 0; i < path.segments.size(); ++i) {
            if (!strand.widths_mm.empty() && strand.widths_mm[i] != style_.width_mm) {
                style_.width_mm = strand.widths_mm[i];
                encoder_.width(style_.width_mm);
            }
            append(from, path.segments[i]);
            from = path.segments[i].end;
        }
    }

    void append(const Point2& from, const Segment& segment) {
        const auto arc_to = [&](const Point2& to, double sagitta_mm) {
            encoder_.arc_to(to.x() + shift_.x(), to.y() + shift_.y(), sagitta_mm);
        };
        const double sweep = sweep_rad(from, segment);
        if (segment.sagitta_mm == 0) {
            encoder_.line_to(segment.end.x() + shift_.x(), segment.end.y() + shift_.y());
        } else if (std::abs(sweep) <= widest_arc_rad) {
            arc_to(segment.end, segment.sagitta_mm);
        } else {
            const Point2 middle = point_at(from, segment, 0.5);
            arc_to(middle, arc_with_sweep(from, middle, sweep / 2).sagitta_mm);
            arc_to(segment.end, arc_with_sweep(middle, segment.end, sweep / 2).sagitta_mm);
        }
    }

    void append(const HatchRun& run) {
        if (wipes()) keep(wipe_along(run, profile_.travel.wipe_mm));
        const double along_mm = run.direction.dot(shift_);
        const double left_mm = cross(run.direction, shift_);
        std::vector<format::HatchRow> rows;
        std::vector<format::HatchInterval> intervals;
        for (const HatchRow& row : run.rows) {
            rows.push_back({1, row.linked});
            intervals.push_back({row.start_mm + along_mm, row.end_mm + along_mm});
        }
        encoder_.hatch({.direction_x = run.direction.x(),
                        .direction_y = run.direction.y(),
                        .offset_mm = run.offset_mm + left_mm,
                        .pitch_mm = run.pitch_mm,
                        .one_way = false,
                        .rows = rows,
                        .intervals = intervals});
    }

    const LayerToEncode& layer_;
    const profile::Profile& profile_;
    Styles styles_;
    std::optional<HeldWalls> held_;  // none: no wall is over air
    const Travel straight_{.crosses = true};
    double fan_ = 0;
    bool retracted_ = false;
    bool enters_ = false;  // a copy, by the next travel
    std::uint32_t object_ = 0;
    Vector2 shift_ =
        Vector2::Zero();  // of the copy that is printed; all points are those of the first one
    std::optional<Point2> head_;
    Path wipe_{Point2::Zero(), {}};  // along which the next retraction goes
    Vector2 wipe_shift_ = Vector2::Zero();
    format::PathStyle style_{};
    format::LayerEncoder encoder_;
};

// Where the empty head may go without crossing a wall: within the middles of the outermost.
std::vector<Contour> inner_region(const Walls& walls) {
    std::vector<Contour> region;
    for (std::size_t i = 0; i < walls.strands.size(); ++i)
        if (walls.depths[i] == 0) region.push_back(walls.strands[i].path);
    return region;
}

}  // namespace

// The support, then the part.
std::vector<PrintMove> order_layer(const OutlinedLayer& outlined, const LayerFill& fill,
                                   std::span<const Seam> seams, const Options& options) {
    const Walls& walls = outlined.walls;
    const Region outline = outlined.outline;
    const double allowed_mm = options.tolerance().unite_mm();
    std::vector<OpenPiece> pieces;
    for (const Piece& piece : fill.pieces) pieces.push_back(ends_of(piece));
    std::optional<Detours> detours;
    // A line's width from the outermost wall's middle, so that what drips is not seen.
    if (options.profile.travel.avoid_crossing)
        detours.emplace(inner_region(walls), allowed_mm, Detours::default_extra_mm,
                        options.profile.perimeters.width_mm);
    const auto support = std::span<const OpenPiece>(pieces).first(fill.support);
    std::vector<PrintMove> moves = support_order(support, detours ? outline : Region(), allowed_mm);
    const bool outer_first = options.profile.perimeters.first == profile::WallOrder::outer;
    std::vector<PrintMove> part = layer_order(
        {.region = outline,
         .walls = walls.strands,
         .depths = walls.depths,
         .seams = seams,
         .pieces = std::span<const OpenPiece>(pieces).subspan(support.size()),
         .sequence = outer_first ? WallSequence::outer_first : WallSequence::inner_first,
         .head = head_after(moves, support),
         .detours = detours ? &*detours : nullptr});
    for (PrintMove& move : part)
        if (!move.is_wall) move.index += static_cast<std::uint32_t>(support.size());
    moves.insert(moves.end(), part.begin(), part.end());
    return moves;
}

format::Quantum quantum_for(const Tolerance& tolerance) {
    format::Quantum best{1};
    for (const std::uint32_t nm : {1u, 2u, 5u, 10u, 20u, 50u, 100u, 200u, 500u, 1000u}) {
        if (quanta_off * nm * 1e-6 <= tolerance.quantise_mm()) best.nm = nm;
    }
    return best;
}

SeamChoice seam_choice(profile::Seam seam) {
    switch (seam) {
        case profile::Seam::nearest:
            return SeamChoice::nearest;
        case profile::Seam::rear:
            return SeamChoice::rear;
        case profile::Seam::aligned:
            return SeamChoice::aligned;
        case profile::Seam::sharp:
            return SeamChoice::sharp;
    }
    return SeamChoice::aligned;
}

Result<format::EncodedLayer> encode_layer(const LayerToEncode& layer, const Options& options,
                                          format::Quantum quantum) {
    return LayerWriter(layer, options, quantum).encode();
}

}  // namespace lyr::slicer
