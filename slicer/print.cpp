// The print: the model is put on the bed; its layers are cut and get their walls, then their seams, then fill and order.
// Layers are made on several threads and taken in order.

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <optional>
#include <span>

#include "base/replace_file.h"
#include "base/text.h"
#include "format/writer.h"
#include "kernel/brep/placement.h"
#include "kernel/region/curve.h"
#include "slicer/adaptive.h"
#include "slicer/adhesion.h"
#include "slicer/air_below.h"
#include "slicer/bounds.h"
#include "slicer/encode.h"
#include "slicer/layers.h"
#include "slicer/left_out.h"
#include "slicer/plate.h"
#include "slicer/raft.h"
#include "slicer/slicer.h"
#include "slicer/support.h"
#include "slicer/write_layers.h"

namespace lyr::slicer {
namespace {

// No printer of this kind is larger, and fill and layers are as many as the part is large.
constexpr double largest_print_mm = 10'000;

void count(const OutlinedLayer& layer, Summary& summary) {
    ++summary.layers;
    summary.contours += layer.printed.loops;
    summary.circles += layer.printed.circles;
    summary.lines += layer.printed.lines;
    summary.arcs += layer.printed.arcs;
    summary.united_layers += layer.united ? 1 : 0;
    summary.uncrossed_layers += layer.uncrossed ? 1 : 0;
    summary.slivers += layer.slivers;
}

Status check_size(const Eigen::AlignedBox3d& box, const profile::Layer& layer) {
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
    if (layer_spans(size_mm.z(), layer).empty())
        return error("the part is lower than half a layer: nothing to print");
    return Done{};
}

bool is_empty(const Walls& walls) {
    return walls.strands.empty() && walls.inside.empty() && walls.thin.empty();
}

void warn_of_no_wipe(const profile::Travel& travel, Diagnostics& diagnostics) {
    if (!(travel.wipe_mm > 0) || travel.retract_length_mm > 0) return;
    diagnostics.push_back({Severity::warning,
                           ExitStatus::usage,
                           "travel.wipe: nothing is wiped, as nothing is retracted "
                           "(travel.retract_length = 0)",
                           {}});
}

// Where a plate's size is stated, the part has to lie on it.
Status check_plate(const Eigen::AlignedBox3d& box, const profile::Plate& plate) {
    const auto& [width_mm, depth_mm] = plate.size_mm;
    if (width_mm == 0 && depth_mm == 0) return Done{};
    if (box.min().x() >= -plate_slack_mm && box.min().y() >= -plate_slack_mm &&
        box.max().x() <= width_mm + plate_slack_mm && box.max().y() <= depth_mm + plate_slack_mm)
        return Done{};
    char text[160];
    std::snprintf(
        text, sizeof text,
        "the part, from %.6g, %.6g to %.6g, %.6g mm, does not lie on the plate of %.6g x %.6g mm "
        "(plate.at, plate.size)",
        box.min().x(), box.min().y(), box.max().x(), box.max().y(), width_mm, depth_mm);
    return Diagnostic{Severity::error, ExitStatus::geometry, text, {}};
}

// Skirts, brims, rafts and supports reach out of the parts' boxes.
void warn_beside_plate(const PlateLayout& plate, const profile::Profile& profile,
                       Diagnostics& diagnostics) {
    const auto& [width_mm, depth_mm] = profile.plate.size_mm;
    if (width_mm == 0 && depth_mm == 0) return;
    const double reach_mm = adhesion_reach_mm(profile);
    double beside_mm = 0;
    for (const Contour& contour : plate.outline)
        for (const Segment& segment : std::get<Path>(contour).segments)
            beside_mm = std::max({beside_mm, reach_mm - segment.end.x(), reach_mm - segment.end.y(),
                                  segment.end.x() + reach_mm - width_mm,
                                  segment.end.y() + reach_mm - depth_mm});
    if (beside_mm <= resolution_mm) return;
    const char* what = "support";
    if (profile.adhesion.kind == profile::AdhesionKind::skirt) what = "skirt";
    if (profile.adhesion.kind == profile::AdhesionKind::brim) what = "brim";
    if (profile.adhesion.kind == profile::AdhesionKind::raft) what = "raft";
    char text[120];
    std::snprintf(text, sizeof text,
                  "the %s reaches %.3g mm beyond the plate (plate.at, plate.size)", what,
                  beside_mm);
    diagnostics.push_back({Severity::warning, ExitStatus::geometry, text, {}});
}

// The part's box with its support and raft.
Eigen::AlignedBox3d with_support(Eigen::AlignedBox3d box, const SupportPlan& support,
                                 std::size_t layers, const profile::Profile& profile) {
    const auto extend = [&](const Point2& point) { box.extend(Point3(point.x(), point.y(), 0)); };
    for (std::size_t i = 0; !support.empty() && i < layers; ++i)
        for (const Contour& contour : support.area(i)) {
            extend(region::box_of(contour).min());
            extend(region::box_of(contour).max());
        }
    const double reach_mm = raft_reach_mm(profile);
    box.min().head<2>().array() -= reach_mm;
    box.max().head<2>().array() += reach_mm;
    return box;
}

// All copies, with what is under them.
format::PicturedBox pictured_box(const Eigen::AlignedBox3d& box, const PlateLayout& plate,
                                 double top_mm) {
    Eigen::AlignedBox3d all = box;
    for (const Vector2& shift : plate.shifts)
        all.extend(box.translated(Vector3(shift.x(), shift.y(), 0)));
    return {all.min().x(), all.min().y(), all.max().x(), all.max().y(), top_mm};
}

Model on_bed(Model model, const Options& options, Eigen::AlignedBox3d& box) {
    box = bounding_box(model, options.tolerance(), thread_count(options));
    const Vector3 move(options.profile.plate.at_mm[0] - box.min().x(),
                       options.profile.plate.at_mm[1] - box.min().y(),
                       raised_mm(options.profile) - box.min().z());
    box.translate(move);
    return transformed(std::move(model), Eigen::Affine3d(Eigen::Translation3d(move)));
}

// Metadata are a block of 64 KiB; objects beyond that have their numbers only.
constexpr std::size_t most_named_bytes = 32'768;

format::Metadata metadata(const std::string& source_name, std::size_t copies,
                          const Options& options) {
    format::Metadata data;
    const std::size_t name_bytes = source_name.size() + std::to_string(copies).size() + 1;
    if (copies > 1 && copies * name_bytes <= most_named_bytes)
        for (std::size_t i = 1; i <= copies; ++i)
            data.objects.push_back(source_name + ' ' + std::to_string(i));
    data.generator = "stepc " LYR_VERSION;
    data.source_name = source_name;
    data.source_sha256 = options.source_sha256;
    data.printer = options.machine().name;
    data.material = options.profile.filament.material;
    data.profile = options.profile_name;
    data.tolerance_mm = options.tolerance().total_mm;
    data.filament_diameter_mm = options.profile.filament.diameter_mm;
    data.filament_density_g_cm3 = options.profile.filament.density_g_cm3;
    data.configuration = options.configuration;
    return data;
}

// On several threads, face by face.
void prepare(const Cutter& cutter, std::size_t faces, std::span<const LayerSpan> spans,
             unsigned threads) {
    if (threads < 2) return;
    std::vector<double> heights_mm;
    for (const LayerSpan& span : spans) heights_mm.push_back(span.middle_mm());
    std::atomic<std::uint32_t> next{0};
    on_threads(threads, [&] {
        for (std::uint32_t face; (face = next.fetch_add(1)) < faces;)
            cutter.prepare(FaceId{face}, heights_mm);
    });
}

// Outlines and walls of all layers, with what is wrong.
Result<std::vector<OutlinedLayer>> outlined(const Cutter& cutter, std::span<const LayerSpan> spans,
                                            const Options& options, const Progress& progress,
                                            Summary& summary, Diagnostics& diagnostics) {
    std::vector<OutlinedLayer> layers;
    std::optional<Diagnostic> failed;
    in_order(
        spans.size(), thread_count(options),
        [&](std::size_t i) { return outline_layer(cutter, i, spans[i], summary.box, options); },
        [&](std::size_t i, OutlinedLayer made) {
            diagnostics.insert(diagnostics.end(), made.diagnostics.begin(), made.diagnostics.end());
            if (made.section.open > 0 && !options.allow_open) {
                failed =
                    Diagnostic{Severity::error,
                               ExitStatus::geometry,
                               counted(made.section.open, "contour") +
                                   " cannot be closed (see above); --allow-open leaves such "
                                   "contours out",
                               {.layer = static_cast<int>(i + 1), .z_mm = spans[i].middle_mm()}};
            } else if (made.error) {
                failed = made.error;
            }
            if (failed) return false;
            count(made, summary);
            layers.push_back(std::move(made));
            progress("sections and walls", i + 1, spans.size());
            return true;
        });
    if (failed) return *failed;
    return layers;
}

}  // namespace

Result<Summary> print(Model model, const std::string& source_name, const std::string& lyr_path,
                      const std::string& report_path, const Options& options,
                      const Progress& progress, Diagnostics& diagnostics) {
    Summary summary{.solids = model.solids.size(), .faces = model.faces.size()};
    const Model placed = on_bed(std::move(model), options, summary.box);
    if (Status checked = check_size(summary.box, part_layers(options.profile)); !checked)
        return checked.error();
    if (Status checked = check_plate(summary.box, options.profile.plate); !checked)
        return checked.error();
    // What support adds is known later.
    if (const auto parts = lay_out(summary.box, options.profile); !parts) return parts.error();
    warn_of_no_wipe(options.profile.travel, diagnostics);
    const auto blocked = blocked_faces(placed, options.profile.support);
    if (!blocked) return blocked.error();
    const auto spans = planned_layers(placed, options, summary, diagnostics);
    auto writer =
        format::Writer::create(lyr_path, quantum_for(options.tolerance()),
                               metadata(source_name, options.profile.plate.copies, options));
    if (!writer) return writer.error();
    std::optional<ReplaceFile> report;
    if (!report_path.empty()) {
        auto opened = ReplaceFile::open(report_path);
        if (!opened) return opened.error();
        report.emplace(std::move(*opened));
    }
    const Cutter cutter(placed, options.tolerance());
    prepare(cutter, placed.faces.size(), spans, thread_count(options));
    const auto layers = outlined(cutter, spans, options, progress, summary, diagnostics);
    if (!layers) return layers.error();
    if (std::all_of(layers->begin(), layers->end(),
                    [](const auto& l) { return is_empty(l.walls); }))
        return nothing_to_print(options.profile.perimeters);
    SupportPlan support(*layers, spans, raft_layers(options.profile));
    if (options.profile.support.kind != profile::SupportKind::none) {
        support.find_overhangs(placed, cutter, *blocked, options);
        support.find_areas(options, diagnostics);
    } else {
        warn_of_air_below(*layers, spans, raft_layers(options.profile), placed, cutter, options,
                          diagnostics);
    }
    const auto printed_box = with_support(summary.box, support, spans.size(), options.profile);
    const auto plate = lay_out(printed_box, options.profile);
    if (!plate) return plate.error();
    summary.placed = layout_text(*plate);
    warn_beside_plate(*plate, options.profile, diagnostics);
    format::ThumbnailPainter painter(pictured_box(printed_box, *plate, spans.back().top_mm));
    const auto estimate = write_layers({*layers, spans, support, *plate, options}, *writer, painter,
                                       progress, diagnostics);
    if (!estimate) return estimate.error();
    if (Status set = writer->set_thumbnails(painter.thumbnails()); !set) return set.error();
    if (report) {
        for (const OutlinedLayer& layer : *layers) report->write(to_json(layer.section));
        if (Status written = report->flush(); !written) return written.error();
    }
    auto totals = writer->finish();
    if (!totals) return totals.error();
    summary.bytes = totals->bytes;
    summary.estimate = *estimate;
    summary.filament_mm = totals->summary.filament_mm;
    summary.mass_g = totals->summary.mass_g;
    if (report) {
        if (Status written = report->commit(); !written) return written.error();
    }
    return summary;
}

}  // namespace lyr::slicer
