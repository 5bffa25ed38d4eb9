#include "slicer/encode.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "kernel/toolpath/layer_order.h"
#include "slicer/styles.h"
#include "slicer/support_order.h"

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
    Path back{path->segments.back().end, {}};
    for (std::size_t i = path->segments.size(); i-- > 0;)
        back.segments.push_back(
            {i > 0 ? path->segments[i - 1].end : path->start, -path->segments[i].sagitta_mm});
    std::reverse(strand.widths_mm.begin(), strand.widths_mm.end());
    strand.path = std::move(back);
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
          allowed_mm_(options.tolerance().unite_mm()),
          styles_(options.profile, layer.index, layer.span.height_mm()),
          detours_(options.profile.travel.avoid_crossing
                       ? std::make_optional<Detours>(inner_region(), allowed_mm_)
                       : std::nullopt),
          moves_(order()),
          encoder_(quantum, state()) {}

    Result<format::EncodedLayer> encode() {
        for (const Piece& piece : layer_.fill.around) {
            const Strand& strand = std::get<Strand>(piece.way);
            travel({.crosses = true}, start_of(strand.path));
            begin(piece_style(piece));
            append(strand);
            head_ = start_of(strand.path);
        }
        for (const PrintMove& move : moves_) {
            if (move.is_wall) {
                append_wall(move);
            } else {
                append_piece(move);
            }
        }
        if (retracts()) encoder_.retract();
        return encoder_.finish();
    }

private:
    // Where the empty head may go without crossing a wall: within the middles of the outermost.
    std::vector<Contour> inner_region() const {
        std::vector<Contour> region;
        const Walls& walls = layer_.outlined.walls;
        for (std::size_t i = 0; i < walls.strands.size(); ++i)
            if (walls.depths[i] == 0) region.push_back(walls.strands[i].path);
        return region;
    }

    // The support, then the part.
    std::vector<PrintMove> order() const {
        std::vector<OpenPiece> pieces;
        for (const Piece& piece : layer_.fill.pieces) pieces.push_back(ends_of(piece));
        const auto support = std::span(pieces).first(layer_.fill.support);
        const Region outline = layer_.outlined.outline;
        std::vector<PrintMove> moves =
            support_order(support, detours_ ? outline : Region(), allowed_mm_);
        const Walls& walls = layer_.outlined.walls;
        std::vector<PrintMove> part =
            layer_order({.region = outline,
                         .walls = walls.strands,
                         .depths = walls.depths,
                         .seams = layer_.seams,
                         .pieces = std::span(pieces).subspan(support.size()),
                         .sequence = profile_.perimeters.first == profile::WallOrder::outer
                                         ? WallSequence::outer_first
                                         : WallSequence::inner_first,
                         .head = head_after(moves, support),
                         .detours = detours_ ? &*detours_ : nullptr});
        for (PrintMove& move : part)
            if (!move.is_wall) move.index += static_cast<std::uint32_t>(support.size());
        moves.insert(moves.end(), part.begin(), part.end());
        return moves;
    }

    Point2 first_point() const {
        if (!layer_.fill.around.empty())
            return start_of(std::get<Strand>(layer_.fill.around.front().way).path);
        return moves_.empty() ? Point2::Zero() : moves_.front().seam.point;
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
        state.retracted_mm = layer_.index > 0 ? travel.retract_length_mm : 0;
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

    // What the layer takes at its speeds, without accelerations: it takes no less.
    double least_time_s() const {
        double time_s = 0;
        const auto add = [&](const format::PathStyle& style, double length) {
            time_s += length / style.speed_mm_s;
        };
        const Walls& walls = layer_.outlined.walls;
        for (std::size_t i = 0; i < walls.strands.size(); ++i)
            add(wall_style(i), lyr::length_mm(walls.strands[i].path));
        for (const Piece& piece : layer_.fill.pieces) add(piece_style(piece), length_mm(piece));
        return time_s;
    }

    // The quicker a layer, the more fan; those that are too quick are slowed down (docs/profiles.md, fan).
    void slow_down_for_cooling() {
        const profile::Fan& fan = profile_.fan;
        const double time_s = least_time_s();
        const double ramp_s = fan.ramp_time_s - fan.min_layer_time_s;
        const double share = ramp_s > 0 ? std::clamp((fan.ramp_time_s - time_s) / ramp_s, 0.0, 1.0)
                                        : (time_s < fan.min_layer_time_s ? 1.0 : 0.0);
        fan_ = layer_.index < fan.off_layers ? 0 : fan.min + share * (fan.max - fan.min);
        if (time_s < fan.min_layer_time_s) styles_.slow_down(time_s / fan.min_layer_time_s);
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

    void begin(const format::PathStyle& style) {
        if (style == style_) return;
        encoder_.begin_path(style);
        style_ = style;
    }

    void travel(const Travel& way, const Point2& to) {
        const Point2 from = head_.value_or(to);
        double length = 0;
        Point2 at = from;
        for (const Point2& via : way.via) length += (via - std::exchange(at, via)).norm();
        length += (to - at).norm();
        const bool draws_back = retracts() && !retracted_ && (way.crosses || !detours_) &&
                                length >= profile_.travel.retract_min_travel_mm;
        const double hop_mm = draws_back ? profile_.travel.z_hop_mm : 0;
        if (draws_back) {
            encoder_.retract();
            retracted_ = true;
        }
        const double z_mm = layer_.span.top_mm;
        if (hop_mm > 0) encoder_.travel_to(from.x(), from.y(), z_mm + hop_mm);
        for (const Point2& via : way.via) encoder_.travel_to(via.x(), via.y());
        encoder_.travel_to(to.x(), to.y());
        if (hop_mm > 0) encoder_.travel_to(to.x(), to.y(), z_mm);
        if (retracted_) encoder_.unretract();
        retracted_ = false;
    }

    void append_wall(const PrintMove& move) {
        const Strand wall = started_at(layer_.outlined.walls.strands[move.index], move.seam);
        travel(move.travel, move.seam.point);
        begin(wall_style(move.index));
        append(wall);
        head_ = move.seam.point;
    }

    void append_piece(const PrintMove& move) {
        const Piece& piece = layer_.fill.pieces[move.index];
        const bool bridges = piece.role == Role::bridge;
        travel(move.travel, move.seam.point);
        if (bridges) encoder_.fan(0, profile_.bridge.fan);
        begin(piece_style(piece));
        if (const auto* run = std::get_if<HatchRun>(&piece.way)) {
            append(move.reversed ? lyr::reversed(*run) : *run);
        } else {
            const Strand& strand = std::get<Strand>(piece.way);
            append(move.reversed ? reversed(strand) : strand);
        }
        if (bridges) encoder_.fan(0, fan_);
        const OpenPiece ends = ends_of(piece);
        head_ = move.reversed ? ends.first : ends.last;
    }

    void append(const Strand& strand) {
        if (const auto* circle = std::get_if<FullCircle>(&strand.path)) {
            encoder_.circle(circle->centre.x(), circle->centre.y(), circle->counter_clockwise);
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
            encoder_.arc_to(to.x(), to.y(), sagitta_mm);
        };
        const double sweep = sweep_rad(from, segment);
        if (segment.sagitta_mm == 0) {
            encoder_.line_to(segment.end.x(), segment.end.y());
        } else if (std::abs(sweep) <= widest_arc_rad) {
            arc_to(segment.end, segment.sagitta_mm);
        } else {
            const Point2 middle = point_at(from, segment, 0.5);
            arc_to(middle, arc_with_sweep(from, middle, sweep / 2).sagitta_mm);
            arc_to(segment.end, arc_with_sweep(middle, segment.end, sweep / 2).sagitta_mm);
        }
    }

    void append(const HatchRun& run) {
        std::vector<format::HatchRow> rows;
        std::vector<format::HatchInterval> intervals;
        for (const HatchRow& row : run.rows) {
            rows.push_back({1, row.linked});
            intervals.push_back({row.start_mm, row.end_mm});
        }
        encoder_.hatch({.direction_x = run.direction.x(),
                        .direction_y = run.direction.y(),
                        .offset_mm = run.offset_mm,
                        .pitch_mm = run.pitch_mm,
                        .one_way = false,
                        .rows = rows,
                        .intervals = intervals});
    }

    const LayerToEncode& layer_;
    const profile::Profile& profile_;
    double allowed_mm_;
    Styles styles_;
    std::optional<Detours> detours_;
    std::vector<PrintMove> moves_;
    double fan_ = 0;
    bool retracted_ = false;
    std::optional<Point2> head_;
    format::PathStyle style_{};
    format::LayerEncoder encoder_;
};

}  // namespace

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
