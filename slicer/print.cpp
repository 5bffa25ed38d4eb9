// The print: the model is put on the bed, cut layer by layer and encoded; layers are made on several threads and
// written in order.

#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>

#include "base/replace_file.h"
#include "base/text.h"
#include "format/writer.h"
#include "kernel/brep/placement.h"
#include "kernel/toolpath/hatch.h"
#include "slicer/bounds.h"
#include "slicer/layers.h"
#include "slicer/slicer.h"

namespace lyr::slicer {
namespace {

// The format asks for arcs of at most this; wider ones are written as two.
constexpr double widest_arc_rad = 1.5 * std::numbers::pi;

// No printer of this kind is larger, and fill and layers are as many as the part is large.
constexpr double largest_print_mm = 10'000;

// Rounding moves a point of an arc by at most this many quanta (format/writer.h, contract 1).
constexpr double quanta_off = 1.3;

// The coarsest of 1, 2, 5, 10, ... nm up to 1 um whose rounding stays within its share of the tolerance.
format::Quantum quantum_for(const Tolerance& tolerance) {
    format::Quantum best{1};
    for (const std::uint32_t nm : {1u, 2u, 5u, 10u, 20u, 50u, 100u, 200u, 500u, 1000u}) {
        if (quanta_off * nm * 1e-6 <= tolerance.quantise_mm()) best.nm = nm;
    }
    return best;
}

void encode_path(const Path& path, format::LayerEncoder& layer) {
    layer.travel_to(path.start.x(), path.start.y());
    Point2 from = path.start;
    const auto arc_to = [&](const Point2& to, double sagitta_mm) {
        layer.arc_to(to.x(), to.y(), sagitta_mm);
    };
    for (const Segment& segment : path.segments) {
        const double sweep = sweep_rad(from, segment);
        if (segment.sagitta_mm == 0) {
            layer.line_to(segment.end.x(), segment.end.y());
        } else if (std::abs(sweep) <= widest_arc_rad) {
            arc_to(segment.end, segment.sagitta_mm);
        } else {
            const Point2 middle = point_at(from, segment, 0.5);
            arc_to(middle, arc_with_sweep(from, middle, sweep / 2).sagitta_mm);
            arc_to(segment.end, arc_with_sweep(middle, segment.end, sweep / 2).sagitta_mm);
        }
        from = segment.end;
    }
}

void encode_contour(const Contour& contour, format::LayerEncoder& layer) {
    if (const auto* circle = std::get_if<FullCircle>(&contour)) {
        layer.travel_to(circle->centre.x() + circle->radius_mm, circle->centre.y());
        layer.circle(circle->centre.x(), circle->centre.y(), circle->counter_clockwise);
    } else {
        encode_path(std::get<Path>(contour), layer);
    }
}

void encode_hatch(const Hatch& hatch, format::LayerEncoder& layer) {
    if (hatch.spans.empty()) return;
    std::vector<format::HatchRow> rows;
    for (std::size_t row = 0; row < hatch.row_count(); ++row) {
        rows.push_back({hatch.row_start[row + 1] - hatch.row_start[row], false});
    }
    std::vector<format::HatchInterval> intervals;
    for (const HatchSpan& span : hatch.spans) intervals.push_back({span.start_mm, span.end_mm});
    layer.hatch({.direction_x = hatch.direction.x(),
                 .direction_y = hatch.direction.y(),
                 .offset_mm = hatch.first_offset_mm,
                 .pitch_mm = hatch.pitch_mm,
                 .one_way = false,
                 .rows = rows,
                 .intervals = intervals});
}

format::LayerState layer_state(std::size_t index, Region region, const Options& options) {
    format::LayerState state;
    state.z_mm = static_cast<double>(index + 1) * options.profile.layer.height_mm;
    state.height_mm = options.profile.layer.height_mm;
    if (!region.empty()) {
        const Point2 start = start_of(region.front());
        state.start_x_mm = start.x();
        state.start_y_mm = start.y();
    }
    state.travel_speed_mm_s = options.profile.speed.travel_mm_s;
    const profile::Temperature& heat = options.profile.temperature;
    state.temperatures.push_back({{.kind = format::HeaterKind::bed, .tool = 0},
                                  index == 0 ? heat.bed_first_layer_c : heat.bed_c});
    state.temperatures.push_back({{.kind = format::HeaterKind::tool, .tool = 0},
                                  index == 0 ? heat.nozzle_first_layer_c : heat.nozzle_c});
    return state;
}

Result<format::EncodedLayer> encode(std::size_t index, Region region, const Options& options,
                                    format::Quantum quantum) {
    format::LayerEncoder layer(quantum, layer_state(index, region, options));
    layer.begin_path({.role = format::Role::outer_wall,
                      .width_mm = options.profile.perimeters.width_mm,
                      .height_mm = options.profile.layer.height_mm,
                      .speed_mm_s = options.profile.speed.outer_wall_mm_s});
    for (const Contour& contour : region) encode_contour(contour, layer);
    layer.begin_path({.role = format::Role::solid_infill,
                      .width_mm = options.profile.skin.width_mm,
                      .height_mm = options.profile.layer.height_mm,
                      .speed_mm_s = options.profile.speed.solid_infill_mm_s});
    const double angle = (index % 2 == 0 ? 1 : 3) * std::numbers::pi / 4;
    encode_hatch(hatch(region, angle, options.profile.skin.width_mm), layer);
    return layer.finish();
}

// What one layer's work gives; `error` ends the print.
struct MadeLayer {
    SectionFigures section{}, printed{};
    bool united = false;
    std::size_t slivers = 0;
    Diagnostics diagnostics{};
    std::optional<format::EncodedLayer> encoded{};
    std::optional<Diagnostic> error{};
};

// How far the region reaches out of the box, seen from the ends and middles of its segments.
double excess_mm(const Region& region, const Eigen::AlignedBox3d& box) {
    const Eigen::AlignedBox2d base(Point2(box.min().head<2>()), Point2(box.max().head<2>()));
    double excess = 0;
    const auto look = [&](const Point2& at) {
        excess = std::max(excess, base.exteriorDistance(at));
    };
    for (const Contour& contour : region) {
        if (const auto* circle = std::get_if<FullCircle>(&contour)) {
            for (const Vector2& to : {Vector2(1, 0), Vector2(0, 1), Vector2(-1, 0), Vector2(0, -1)})
                look(circle->centre + circle->radius_mm * to);
            continue;
        }
        Point2 from = std::get<Path>(contour).start;
        for (const Segment& segment : std::get<Path>(contour).segments) {
            look(point_at(from, segment, 0.5));
            look(segment.end);
            from = segment.end;
        }
    }
    return excess;
}

// A section that leaves the part's own box follows faces or edges that are not where the rest is; filling it may be endless.
Status check_inside(const Region& region, const Eigen::AlignedBox3d& box, const Location& where) {
    constexpr double most_share = 0.01;
    const double excess = excess_mm(region, box);
    if (excess <= most_share * box.diagonal().norm()) return Done{};
    char text[128];
    std::snprintf(text, sizeof text,
                  "the section reaches %.3g mm out of the part's box: an edge or a face is damaged",
                  excess);
    return Diagnostic{Severity::error, ExitStatus::geometry, text, where};
}

MadeLayer make_layer(const Cutter& cutter, std::size_t index, double middle_mm,
                     const Eigen::AlignedBox3d& box, const Options& options,
                     format::Quantum quantum) {
    const Location where{.layer = static_cast<int>(index + 1), .z_mm = middle_mm};
    Section section = cutter.cut(middle_mm);
    for (Diagnostic& found : section.diagnostics) found.where.layer = static_cast<int>(index + 1);
    const RegionResult region = region_of(section, options.tolerance());
    MadeLayer made{.section = figures_of(section),
                   .printed = figures_of(region.contours),
                   .united = region.changed,
                   .slivers = region.slivers,
                   .diagnostics = section.diagnostics};
    if (region.unresolved > 0) {
        made.diagnostics.push_back({Severity::warning, ExitStatus::geometry,
                                    "solids that overlap could not be united: their walls are "
                                    "printed over each other",
                                    where});
    }
    if (Status inside = check_inside(region.contours, box, where); !inside) {
        made.error = inside.error();
        return made;
    }
    auto encoded = encode(index, region.contours, options, quantum);
    if (encoded) {
        made.encoded = std::move(*encoded);
    } else {
        made.error = encoded.error();
    }
    return made;
}

void count(const MadeLayer& layer, Summary& summary) {
    ++summary.layers;
    summary.contours += layer.printed.loops;
    summary.circles += layer.printed.circles;
    summary.lines += layer.printed.lines;
    summary.arcs += layer.printed.arcs;
    summary.united_layers += layer.united ? 1 : 0;
    summary.slivers += layer.slivers;
}

Status check_size(const Eigen::AlignedBox3d& box, double layer_height_mm) {
    const auto error = [](const std::string& message) {
        return Diagnostic{Severity::error, ExitStatus::geometry, message, {}};
    };
    const Vector3 size_mm = box.sizes();
    if (size_mm.maxCoeff() > largest_print_mm) {
        char size[80];
        std::snprintf(size, sizeof size, "%.5g x %.5g x %.5g m", size_mm.x() / 1000,
                      size_mm.y() / 1000, size_mm.z() / 1000);
        return error(std::string("the part is ") + size +
                     ", more than the 10 m that are printed: is the file's length unit wrong?");
    }
    if (layer_middles(size_mm.z(), layer_height_mm).empty())
        return error("the part is lower than half a layer: nothing to print");
    return Done{};
}

Model on_bed(Model model, const Options& options, Eigen::AlignedBox3d& box) {
    box = bounding_box(model, options.tolerance());
    const Vector3 move(options.profile.plate.at_mm[0] - box.min().x(),
                       options.profile.plate.at_mm[1] - box.min().y(), -box.min().z());
    box.translate(move);
    return transformed(std::move(model), Eigen::Affine3d(Eigen::Translation3d(move)));
}

format::Metadata metadata(const std::string& source_name, const Options& options) {
    format::Metadata data;
    data.generator = "stepc " LYR_VERSION;
    data.source_name = source_name;
    data.material = options.profile.filament.material;
    data.profile = options.profile_name;
    data.tolerance_mm = options.tolerance().total_mm;
    data.filament_diameter_mm = options.profile.filament.diameter_mm;
    data.filament_density_g_cm3 = options.profile.filament.density_g_cm3;
    data.configuration = options.configuration;
    return data;
}

}  // namespace

Result<Summary> print(Model model, const std::string& source_name, const std::string& lyr_path,
                      const std::string& report_path, const Options& options,
                      const Progress& progress, Diagnostics& diagnostics) {
    Summary summary{.solids = model.solids.size(), .faces = model.faces.size()};
    const Model placed = on_bed(std::move(model), options, summary.box);
    if (Status checked = check_size(summary.box, options.profile.layer.height_mm); !checked)
        return checked.error();
    const auto middles = layer_middles(summary.box.sizes().z(), options.profile.layer.height_mm);
    const format::Quantum quantum = quantum_for(options.tolerance());
    auto writer = format::Writer::create(lyr_path, quantum, metadata(source_name, options));
    if (!writer) return writer.error();
    std::optional<ReplaceFile> report;
    if (!report_path.empty()) {
        auto opened = ReplaceFile::open(report_path);
        if (!opened) return opened.error();
        report.emplace(std::move(*opened));
    }

    const Cutter cutter(placed, options.tolerance());
    std::optional<Diagnostic> failed;
    in_order(
        middles.size(), thread_count(options),
        [&](std::size_t i) {
            return make_layer(cutter, i, middles[i], summary.box, options, quantum);
        },
        [&](std::size_t i, MadeLayer made) {
            diagnostics.insert(diagnostics.end(), made.diagnostics.begin(), made.diagnostics.end());
            if (made.section.open > 0 && !options.allow_open) {
                failed = Diagnostic{Severity::error,
                                    ExitStatus::geometry,
                                    counted(made.section.open, "contour") +
                                        " cannot be closed (see above); --allow-open leaves such "
                                        "contours out",
                                    {.layer = static_cast<int>(i + 1), .z_mm = middles[i]}};
            } else if (made.error) {
                failed = made.error;
            } else if (Status appended = writer->append(*made.encoded); !appended) {
                failed = appended.error();
            }
            if (failed) return false;
            count(made, summary);
            if (report) report->write(to_json(made.section));
            progress("layers", i + 1, middles.size());
            return true;
        });
    if (failed) return *failed;
    if (report) {
        if (Status written = report->flush(); !written) return written.error();
    }
    auto totals = writer->finish();
    if (!totals) return totals.error();
    summary.bytes = totals->bytes;
    if (report) {
        if (Status written = report->commit(); !written) return written.error();
    }
    return summary;
}

}  // namespace lyr::slicer
