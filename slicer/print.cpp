// The print: the model is put on the bed; its layers are cut and get their walls, then their seams, then fill and order.
// Layers are made on several threads and taken in order.

#include <cstdio>
#include <optional>
#include <span>

#include "base/replace_file.h"
#include "base/text.h"
#include "format/writer.h"
#include "kernel/brep/placement.h"
#include "kernel/toolpath/layer_order.h"
#include "slicer/bounds.h"
#include "slicer/encode.h"
#include "slicer/layers.h"
#include "slicer/print_fill.h"
#include "slicer/raft.h"
#include "slicer/slicer.h"

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

// What the profile asks for and no print has yet; nothing of it is left out in silence.
void warn_of_missing(const profile::Profile& profile, Diagnostics& diagnostics) {
    const auto warn = [&](bool asked, const char* what) {
        if (asked)
            diagnostics.push_back({Severity::warning,
                                   ExitStatus::unsupported,
                                   std::string(what) + ": not made yet, the print goes without",
                                   {}});
    };
    warn(profile.layer.adaptive, "layer.adaptive");
    warn(profile.travel.wipe_mm > 0, "travel.wipe");
    warn(profile.plate.copies > 1, "plate.copies");
    warn(profile.plate.sequential, "plate.sequential");
}

// Where a plate's size is stated, the part has to lie on it.
Status check_plate(const Eigen::AlignedBox3d& box, const profile::Plate& plate) {
    const auto& [width_mm, depth_mm] = plate.size_mm;
    if (width_mm == 0 && depth_mm == 0) return Done{};
    if (box.min().x() >= 0 && box.min().y() >= 0 && box.max().x() <= width_mm &&
        box.max().y() <= depth_mm)
        return Done{};
    char text[160];
    std::snprintf(
        text, sizeof text,
        "the part, from %.6g, %.6g to %.6g, %.6g mm, does not lie on the plate of %.6g x %.6g mm "
        "(plate.at, plate.size)",
        box.min().x(), box.min().y(), box.max().x(), box.max().y(), width_mm, depth_mm);
    return Diagnostic{Severity::error, ExitStatus::geometry, text, {}};
}

Model on_bed(Model model, const Options& options, Eigen::AlignedBox3d& box) {
    box = bounding_box(model, options.tolerance(), thread_count(options));
    const Vector3 move(options.profile.plate.at_mm[0] - box.min().x(),
                       options.profile.plate.at_mm[1] - box.min().y(),
                       raised_mm(options.profile) - box.min().z());
    box.translate(move);
    return transformed(std::move(model), Eigen::Affine3d(Eigen::Translation3d(move)));
}

format::Metadata metadata(const std::string& source_name, const Options& options) {
    format::Metadata data;
    data.generator = "stepc " LYR_VERSION;
    data.source_name = source_name;
    data.printer = options.machine().name;
    data.material = options.profile.filament.material;
    data.profile = options.profile_name;
    data.tolerance_mm = options.tolerance().total_mm;
    data.filament_diameter_mm = options.profile.filament.diameter_mm;
    data.filament_density_g_cm3 = options.profile.filament.density_g_cm3;
    data.configuration = options.configuration;
    return data;
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

// Of the outermost walls, layer by layer: each next to those of the layer below.
std::vector<std::vector<Seam>> seams_of(std::span<const OutlinedLayer> layers, SeamChoice choice) {
    std::vector<std::vector<Seam>> seams;
    for (const OutlinedLayer& layer : layers) {
        const std::span<const Seam> below = seams.empty() ? std::span<const Seam>() : seams.back();
        seams.push_back(outer_seams(layer.walls.strands, layer.walls.depths, choice, below));
    }
    return seams;
}

struct FilledLayer {
    std::size_t unresolved = 0;
    std::optional<format::EncodedLayer> encoded{};
    LayerEstimate estimate{};
    std::optional<Diagnostic> error{};
};

FilledLayer fill_and_encode(std::size_t i, const LayerSpan& span, const OutlinedLayer& outlined,
                            std::span<const SkinOutline> outlines, std::span<const Seam> seams,
                            const SupportPlan& support, const Options& options,
                            const Estimator& estimator) {
    const LayerFill fill = print_fill(i, span, outlined.walls, outlines, support, options);
    FilledLayer made{.unresolved = fill.unresolved};
    auto encoded =
        encode_layer({i, span, outlined, fill, seams}, options, quantum_for(options.tolerance()));
    if (!encoded) {
        made.error = encoded.error();
        return made;
    }
    const auto estimate = estimator.layer(*encoded, static_cast<std::uint32_t>(i));
    if (!estimate) {
        made.error = estimate.error();
        return made;
    }
    made.encoded = std::move(*encoded);
    made.estimate = *estimate;
    return made;
}

// Appends layers, each with its time: that of its own motions and of the way to it.
class TimedWriter {
public:
    TimedWriter(format::Writer& writer, const Estimator& estimator)
        : writer_(writer), estimator_(estimator), head_(estimator.start()) {}

    Status append(format::EncodedLayer layer, std::uint32_t index, const LayerEstimate& made) {
        const auto way = estimator_.approach(head_, layer, index);
        if (!way) return way.error();
        layer.state.estimated_time_s = way->time_s() + made.estimate.time_s();
        estimate_ += *way;
        estimate_ += made.estimate;
        head_ = made.end;
        return writer_.append(layer);
    }
    const Estimate& estimate() const { return estimate_; }

private:
    format::Writer& writer_;
    const Estimator& estimator_;
    moves::Head head_;
    Estimate estimate_{};
};

// Fills, orders and writes. The print's estimate.
Result<Estimate> write_layers(std::span<const OutlinedLayer> layers,
                              std::span<const LayerSpan> spans, const SupportPlan& support,
                              const Options& options, format::Writer& writer,
                              const Progress& progress, Diagnostics& diagnostics) {
    const Estimator estimator(options.machine(), options.profile.filament.diameter_mm);
    TimedWriter timed(writer, estimator);
    const auto seams = seams_of(layers, seam_choice(options.profile.perimeters.seam));
    std::vector<SkinOutline> outlines;
    for (const OutlinedLayer& layer : layers) outlines.push_back(layer.seen);
    std::optional<Diagnostic> failed;
    in_order(
        layers.size(), thread_count(options),
        [&](std::size_t i) {
            return fill_and_encode(i, spans[i], layers[i], outlines, seams[i], support, options,
                                   estimator);
        },
        [&](std::size_t i, FilledLayer made) {
            if (made.unresolved > 0)
                diagnostics.push_back(
                    {Severity::warning,
                     ExitStatus::geometry,
                     counted(made.unresolved, "part") + " of the layer's fill could not be made",
                     {.layer = static_cast<int>(i + 1), .z_mm = spans[i].middle_mm()}});
            if (made.error) {
                failed = made.error;
            } else if (Status appended = timed.append(std::move(*made.encoded),
                                                      static_cast<std::uint32_t>(i), made.estimate);
                       !appended) {
                failed = appended.error();
            }
            if (failed) return false;
            progress("fill", i + 1, layers.size());
            return true;
        });
    if (failed) return *failed;
    return timed.estimate();
}

}  // namespace

Result<Summary> print(Model model, const std::string& source_name, const std::string& lyr_path,
                      const std::string& report_path, const Options& options,
                      const Progress& progress, Diagnostics& diagnostics) {
    Summary summary{.solids = model.solids.size(), .faces = model.faces.size()};
    const Model placed = on_bed(std::move(model), options, summary.box);
    if (Status checked = check_size(summary.box, options.profile.layer); !checked)
        return checked.error();
    if (Status checked = check_plate(summary.box, options.profile.plate); !checked)
        return checked.error();
    warn_of_missing(options.profile, diagnostics);
    const auto blocked = blocked_faces(placed, options.profile.support);
    if (!blocked) return blocked.error();
    const auto spans = print_spans(summary.box.sizes().z(), options.profile);
    auto writer = format::Writer::create(lyr_path, quantum_for(options.tolerance()),
                                         metadata(source_name, options));
    if (!writer) return writer.error();
    std::optional<ReplaceFile> report;
    if (!report_path.empty()) {
        auto opened = ReplaceFile::open(report_path);
        if (!opened) return opened.error();
        report.emplace(std::move(*opened));
    }
    const Cutter cutter(placed, options.tolerance());
    const auto layers = outlined(cutter, spans, options, progress, summary, diagnostics);
    if (!layers) return layers.error();
    SupportPlan support(*layers, spans, raft_layers(options.profile));
    if (options.profile.support.kind != profile::SupportKind::none) {
        support.find_overhangs(placed, cutter, *blocked, options);
        support.find_areas(options, diagnostics);
    }
    const auto estimate =
        write_layers(*layers, spans, support, options, *writer, progress, diagnostics);
    if (!estimate) return estimate.error();
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
