#include "slicer/fill.h"

#include <algorithm>
#include <numbers>

#include "kernel/toolpath/bridges.h"
#include "kernel/toolpath/centre_lines.h"
#include "kernel/toolpath/infill.h"
#include "kernel/toolpath/internal_bridges.h"
#include "kernel/toolpath/islands.h"

namespace lyr::slicer {
namespace {

InfillPattern kernel_pattern(profile::InfillPattern pattern) {
    switch (pattern) {
        case profile::InfillPattern::rectilinear:
            return InfillPattern::rectilinear;
        case profile::InfillPattern::aligned:
            return InfillPattern::aligned;
        case profile::InfillPattern::grid:
            return InfillPattern::grid;
        case profile::InfillPattern::triangles:
            return InfillPattern::triangles;
        case profile::InfillPattern::concentric:
            return InfillPattern::concentric;
        case profile::InfillPattern::honeycomb:
            return InfillPattern::honeycomb;
        case profile::InfillPattern::gyroid:
            return InfillPattern::gyroid;
        case profile::InfillPattern::cubic:
            return InfillPattern::cubic;
    }
    return InfillPattern::rectilinear;
}

InfillPattern kernel_pattern(profile::SkinPattern pattern) {
    switch (pattern) {
        case profile::SkinPattern::rectilinear:
            return InfillPattern::rectilinear;
        case profile::SkinPattern::aligned:
            return InfillPattern::aligned;
        case profile::SkinPattern::concentric:
            return InfillPattern::concentric;
    }
    return InfillPattern::rectilinear;
}

// How far the flow of solid fill may be off one.
constexpr double least_flow = 0.8, most_flow = 1.1;

// Of parts that are filled with rings in place of parallel lines.
constexpr double widest_strip_lines = 3;

// Parts with more contours are filled with lines of their pattern alone: the middle of what is narrow in a net takes long to
// find.
constexpr std::size_t most_contours = 24;

double radians(double degrees) {
    return degrees * std::numbers::pi / 180;
}

bool is_solid(const profile::Profile& profile) {
    return profile.infill.density == 1;
}

SkinRequest skin_request(const Options& options) {
    const profile::Skin& skin = options.profile.skin;
    // Of a solid part only what is bare has a role of its own.
    const auto layers = [&](std::uint32_t count) {
        return is_solid(options.profile) ? std::min(count, 1u) : count;
    };
    return {.top_layers = layers(skin.top_layers),
            .bottom_layers = layers(skin.bottom_layers),
            .width_mm = skin.width_mm,
            .min_sparse_mm2 = skin.min_area_mm2,
            .allowed_mm = options.tolerance().unite_mm()};
}

// How much more the strands of a narrow part lay down than along their way: they end half their width before it does, and
// what is around their ends is material too. No more than goes around ends, twice as wide as the strands at most.
double flow_to_ends(std::span<const Strand> strands, double part_mm2) {
    double laid_mm2 = 0, most_mm2 = 0;
    for (const Strand& strand : strands) {
        const double length = length_mm(strand.path);
        const double covered = flat_area_mm2(strand);
        laid_mm2 += covered;
        const double width_mm = length > 0 ? covered / length : 0;
        if (!is_closed(strand)) most_mm2 += 4 * width_mm * width_mm;
    }
    if (!(laid_mm2 > 0)) return 1;
    return 1 + std::clamp(part_mm2 - laid_mm2, 0.0, most_mm2) / laid_mm2;
}

class Filler {
public:
    Filler(std::size_t index, const LayerSpan& span, const Options& options)
        : index_(index),
          span_(span),
          profile_(options.profile),
          allowed_mm_(options.tolerance().unite_mm()) {}

    void solid(Region region, format::Role role) {
        const InfillPattern pattern = kernel_pattern(profile_.skin.pattern);
        const double angle_rad = radians(profile_.skin.angle_deg);
        const bool is_concentric = pattern == InfillPattern::concentric;
        if (!is_concentric && !(is_solid(profile_) && profile_.perimeters.gap_fill))
            return append(region, role, pattern, angle_rad);
        const Parts parts = parts_by_contours(region);
        if (is_concentric)
            append_rings(parts.few, role);
        else
            append(without_narrow(parts.few, role), role, pattern, angle_rad);
        append(parts.many, role, pattern, angle_rad);
    }

    void bridges(Region region, Region below) {
        for (const Bridge& bridge : bridges_over(region, below, profile_.skin.width_mm)) {
            if (bridge.angle_rad) {
                append(bridge.contours, format::Role::bridge, InfillPattern::aligned,
                       *bridge.angle_rad);
            } else {
                solid(bridge.contours, format::Role::bottom_skin);
            }
        }
    }

    // From flank to flank: of thin walls, these are the outline.
    void narrow(Region region, std::span<const Joint> joints, format::Role role, double least_mm,
                double flank_mm) {
        for (const std::vector<Contour>& part : parts_of(region)) {
            CentreLines lines = centre_lines(part,
                                             {.min_width_mm = least_mm,
                                              .max_width_mm = profile_.perimeters.max_width_mm,
                                              .allowed_mm = allowed_mm_},
                                             joints);
            fill.unresolved += lines.unresolved;
            if (role == format::Role::thin_wall) {
                fill.thin_left_out_mm2 += lines.left_out_mm2;
                if (!fill.thin_broken) fill.thin_broken = lines.broken;
            }
            const double flow = flow_to_ends(lines.strands, area_mm2(part) - lines.left_out_mm2);
            for (Strand& strand : lines.strands) {
                strand.width_mm += 2 * flank_mm;
                for (double& width : strand.widths_mm) width += 2 * flank_mm;
                fill.pieces.push_back({role, std::move(strand), flow});
            }
        }
    }

    // By how much the flanks of walls reach over the boundary between them and what is beside them.
    double flank_mm() const {
        return profile_.perimeters.overlap * span_.height_mm() * (1 - std::numbers::pi / 4) / 2;
    }

    void sparse(Region region) {
        fill.asks_sparse = profile_.infill.density > 0 && !region.empty();
        append(sparse_lines(region), format::Role::sparse_infill);
    }

    Fill sparse_lines(Region region) const {
        if (profile_.infill.density == 0) return {};
        return lines(region, {.pattern = kernel_pattern(profile_.infill.pattern),
                              .density = profile_.infill.density,
                              .width_mm = profile_.infill.width_mm,
                              .angle_rad = radians(profile_.infill.angle_deg)});
    }

    // `holding`: the lines of the sparse fill below.
    void internal_bridges(Region region, Region below, Region sparse_below, const Fill& holding) {
        const std::vector<Chord> chords = chords_of(holding);
        for (const Bridge& bridge :
             bridges_inside(region, below, sparse_below, chords, profile_.skin.width_mm)) {
            if (bridge.angle_rad) {
                append(bridge.contours, format::Role::internal_bridge, InfillPattern::aligned,
                       *bridge.angle_rad);
            } else {
                solid(bridge.contours, format::Role::solid_infill);
                fill.is_unheld |= chords.empty();
            }
        }
    }

    LayerFill fill{};

private:
    void append(Region region, format::Role role, InfillPattern pattern, double angle_rad) {
        const std::size_t first = fill.pieces.size();
        append(lines(region, {.pattern = pattern,
                              .density = 1,
                              .width_mm = profile_.skin.width_mm,
                              .angle_rad = angle_rad}),
               role);
        balance(first, region, profile_.skin.width_mm);
    }

    struct Parts {
        std::vector<Contour> few, many;  // contours
    };
    static Parts parts_by_contours(Region region) {
        if (region.size() <= most_contours) return {{region.begin(), region.end()}, {}};
        Parts result;
        for (const std::vector<Contour>& part : parts_of(region)) {
            auto& list = part.size() > most_contours ? result.many : result.few;
            list.insert(list.end(), part.begin(), part.end());
        }
        return result;
    }

    double spacing_mm() const { return line_spacing_mm(profile_.skin.width_mm, span_.height_mm()); }

    // Walls that fill the region as lines do, the outermost with its flank on the boundary.
    Walls rings(Region region, std::uint32_t count) const {
        const bool fills = profile_.perimeters.gap_fill;
        return walls(region, {.count = count,
                              .width_mm = spacing_mm(),
                              .overlap = 0,
                              .min_width_mm = profile_.perimeters.min_gap_mm,
                              .min_gap_mm = profile_.perimeters.min_gap_mm,
                              .thin_walls = fills,
                              .gap_fill = fills && count > 1,
                              .allowed_mm = allowed_mm_});
    }

    // Where no wall as wide as a line would fit into the region, neither do parallel lines: that is filled along its middle.
    // Beside the ends of lines notches stay open, in a strip that is hardly longer across than these as much as a few per
    // cent: such parts are filled with rings. Gives the rest.
    std::vector<Contour> without_narrow(Region region, format::Role role) {
        const Walls lines = rings(region, 1);
        std::vector<Contour> wide;
        if (!lines.thin.empty()) {
            narrow(lines.thin, lines.thin_joints, format::Role::gap_fill,
                   profile_.perimeters.min_gap_mm, flank_mm());
            std::vector<Contour> middles;
            for (const Strand& strand : lines.strands) middles.push_back(strand.path);
            OffsetResult made =
                offset(middles, {.distance_mm = spacing_mm() / 2, .allowed_mm = allowed_mm_});
            fill.unresolved += made.unresolved.has_value();
            wide = std::move(made.contours);
            region = wide;
        }
        std::vector<Contour> rest;
        for (const std::vector<Contour>& part : parts_of(region)) {
            if (2 * area_mm2(part) <= widest_strip_lines * spacing_mm() * lyr::length_mm(part))
                append_rings(part, role);
            else
                rest.insert(rest.end(), part.begin(), part.end());
        }
        return rest;
    }

    void append_rings(Region region, format::Role role) {
        region::Box2 box;
        for (const Contour& contour : region) box.extend(region::box_of(contour));
        if (box.isEmpty()) return;
        const double most = box.sizes().minCoeff() / 2 / spacing_mm();
        Walls made = rings(region, static_cast<std::uint32_t>(most) + 2);
        fill.unresolved += made.unresolved;
        const double lap_mm = profile_.skin.width_mm - spacing_mm();
        for (Strand& strand : made.strands) {
            strand.width_mm += lap_mm;
            for (double& width : strand.widths_mm) width += lap_mm;
            fill.pieces.push_back({role, std::move(strand)});
        }
        const double least_mm = profile_.perimeters.min_gap_mm;
        narrow(made.thin, made.thin_joints, format::Role::gap_fill, least_mm, flank_mm());
        narrow(made.gaps, made.gap_joints, format::Role::gap_fill, least_mm, flank_mm());
    }

    void append(Fill lines, format::Role role) {
        fill.unresolved += lines.unresolved;
        for (HatchRun& run : lines.runs) fill.pieces.push_back({role, std::move(run)});
        for (Strand& strand : lines.strands) fill.pieces.push_back({role, std::move(strand)});
    }

    // The region begins half a spacing from the walls' middles; lines end so that their flanks overlap with those of the
    // walls by what the profile says.
    Fill lines(Region region, InfillRequest request) const {
        if (region.empty()) return {};
        request.height_mm = span_.height_mm();
        request.z_mm = span_.middle_mm();
        request.layer = index_;
        request.allowed_mm = allowed_mm_;
        // Without walls it begins at the outline itself.
        const bool is_bare = profile_.perimeters.count == 0;
        const double inset_mm =
            is_bare ? request.width_mm / 2
                    : flank_mm() + (0.5 - profile_.infill.overlap) * request.width_mm;
        const OffsetResult middles =
            offset(region, {.distance_mm = -inset_mm, .allowed_mm = allowed_mm_});
        Fill lines = infill(middles.contours, request);
        lines.unresolved += middles.unresolved.has_value();
        return lines;
    }

    // What lines reach over into walls and links add makes up for what is left beside them, by the flow.
    void balance(std::size_t first, Region region, double width_mm) {
        double lines_mm = 0;
        for (std::size_t i = first; i < fill.pieces.size(); ++i)
            lines_mm += length_mm(fill.pieces[i]);
        const double filled_mm2 = lines_mm * line_spacing_mm(width_mm, span_.height_mm());
        if (!(filled_mm2 > 0)) return;
        const double flow = std::clamp(area_mm2(region) / filled_mm2, least_flow, most_flow);
        for (std::size_t i = first; i < fill.pieces.size(); ++i) fill.pieces[i].flow = flow;
    }

    std::size_t index_;
    LayerSpan span_;
    const profile::Profile& profile_;
    double allowed_mm_;
};

}  // namespace

double length_mm(const Piece& piece) {
    const auto* run = std::get_if<HatchRun>(&piece.way);
    return run ? lyr::length_mm(*run) : lyr::length_mm(std::get<Strand>(piece.way).path);
}

LayerSkins skins_of_layer(std::size_t index, const Walls& walls,
                          std::span<const SkinOutline> outlines, const Options& options) {
    return skins_of(outlines, index, walls.inside, skin_request(options));
}

LayerFill fill_layer(std::size_t index, const Walls& walls, const PartLayers& layers,
                     const Options& options) {
    const profile::Profile& profile = options.profile;
    Filler filler(index, layers.spans[index], options);
    LayerSkins skins = layers.skins[index];
    const bool may_bridge = index > 0 && !is_solid(profile);
    if (may_bridge)
        add_internal_bridges(skins, layers.skins[index - 1].sparse, skin_request(options));
    filler.fill.unresolved += skins.unresolved;
    const profile::Perimeters& perimeters = profile.perimeters;
    filler.narrow(walls.thin, walls.thin_joints, format::Role::thin_wall, perimeters.min_width_mm,
                  0);
    filler.narrow(walls.gaps, walls.gap_joints, format::Role::gap_fill, perimeters.min_gap_mm,
                  filler.flank_mm());
    filler.solid(skins.bottom, format::Role::bottom_skin);
    filler.solid(skins.top, format::Role::top_skin);
    if (index > 0) filler.bridges(skins.bridge, layers.outlines[index - 1].region());
    if (!skins.internal_bridge.empty()) {
        const Region sparse_below = layers.skins[index - 1].sparse;
        const Filler below(index - 1, layers.spans[index - 1], options);
        filler.internal_bridges(skins.internal_bridge, layers.outlines[index - 1].region(),
                                sparse_below, below.sparse_lines(sparse_below));
    }
    if (is_solid(profile)) {
        const RegionResult rest =
            combined(skins.solid, skins.sparse, Operation::unite, options.tolerance().unite_mm());
        filler.fill.unresolved += rest.unresolved;
        filler.solid(rest.contours, format::Role::solid_infill);
    } else {
        filler.solid(skins.solid, format::Role::solid_infill);
        filler.sparse(skins.sparse);
        filler.fill.sparse = std::move(skins.sparse);
    }
    return std::move(filler.fill);
}

}  // namespace lyr::slicer
