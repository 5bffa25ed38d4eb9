// Layers are filled, ordered and encoded on several threads and taken in order. Where copies are printed layer by layer
// that is one pass; where they are printed one after the other, all layers are filled first and then encoded for each.

#include "slicer/write_layers.h"

#include <numeric>
#include <optional>
#include <utility>

#include "base/text.h"
#include "slicer/adhesion.h"
#include "slicer/balance.h"
#include "slicer/encode.h"
#include "slicer/fill_report.h"
#include "slicer/layers.h"
#include "slicer/left_out.h"
#include "slicer/print_fill.h"
#include "slicer/printer_range.h"
#include "slicer/raft.h"

namespace lyr::slicer {
namespace {

// Of the outermost walls, layer by layer: each next to those of the layer below.
std::vector<std::vector<Seam>> seams_of(std::span<const OutlinedLayer> layers, SeamChoice choice) {
    std::vector<std::vector<Seam>> seams;
    for (const OutlinedLayer& layer : layers) {
        const std::span<const Seam> below = seams.empty() ? std::span<const Seam>() : seams.back();
        seams.push_back(outer_seams(layer.walls.strands, layer.walls.depths, choice, below));
    }
    return seams;
}

std::vector<SkinOutline> skin_outlines(std::span<const OutlinedLayer> layers) {
    std::vector<SkinOutline> outlines;
    for (const OutlinedLayer& layer : layers) outlines.push_back(layer.seen);
    return outlines;
}

// Of all layers of the part; the raft's have none.
std::vector<LayerSkins> skins_of_layers(const LayersToWrite& in,
                                        std::span<const SkinOutline> outlines) {
    const std::size_t raft = raft_layers(in.options.profile);
    std::vector<LayerSkins> skins;
    in_order(
        in.layers.size(), thread_count(in.options),
        [&](std::size_t i) {
            return i < raft ? LayerSkins()
                            : skins_of_layer(i - raft, in.layers[i].walls, outlines.subspan(raft),
                                             in.options);
        },
        [&](std::size_t, LayerSkins made) {
            skins.push_back(std::move(made));
            return true;
        });
    return skins;
}

// All of a layer of one copy, in the order in which it is printed.
struct PlannedLayer {
    LayerFill fill{};
    std::vector<PrintMove> moves{};
    std::vector<Piece> skirt{};  // around all copies
};

struct TimedLayer {
    FillNotes notes{};
    LeftOut left_out{};
    std::optional<Imbalance> imbalance{};
    std::optional<format::EncodedLayer> encoded{};
    LayerEstimate estimate{};
    std::optional<Diagnostic> error{};
};

// What all layers of a print have in common.
struct Job {
    LayersToWrite in;
    Estimator estimator{in.options.machine(), in.options.profile.filament.diameter_mm};
    std::vector<std::vector<Seam>> seams{
        seams_of(in.layers, seam_choice(in.options.profile.perimeters.seam))};
    std::vector<SkinOutline> outlines{skin_outlines(in.layers)};
    std::vector<LayerSkins> skins{skins_of_layers(in, outlines)};
};

PlannedLayer planned(std::size_t i, const Job& job) {
    const OutlinedLayer& outlined = job.in.layers[i];
    const Options& options = job.in.options;
    const PartLayers layers{job.in.spans, job.outlines, job.skins};
    PlannedLayer made{.fill = print_fill(i, outlined.walls, layers, job.in.support, options)};
    if (options.profile.adhesion.kind == profile::AdhesionKind::skirt) {
        made.skirt = std::exchange(made.fill.around, {});
        if (i == 0 && job.in.plate.shifts.size() > 1)
            made.skirt = adhesion_of(job.in.plate.outline, job.in.spans[i].height_mm(), options,
                                     made.fill.unresolved);
    }
    made.moves = order_layer(outlined, made.fill, job.seams[i], options);
    return made;
}

// `lifts`: the head leaves the copy for the next one.
TimedLayer encoded(std::size_t i, const Job& job, const PlannedLayer& planned,
                   std::span<const Copy> copies, bool begins_print, bool lifts) {
    TimedLayer made;
    auto bytes = encode_layer(
        {.index = i,
         .span = job.in.spans[i],
         .outlined = job.in.layers[i],
         .below = i > raft_layers(job.in.options.profile) ? &job.in.layers[i - 1] : nullptr,
         .fill = planned.fill,
         .moves = planned.moves,
         .copies = copies,
         .skirt = begins_print ? planned.skirt : std::span<const Piece>(),
         .begins_print = begins_print,
         .lift_mm = lifts ? job.in.plate.lift_mm : 0},
        job.in.options, quantum_for(job.in.options.tolerance()));
    if (!bytes) {
        made.error = bytes.error();
        return made;
    }
    const auto estimate = job.estimator.layer(*bytes, static_cast<std::uint32_t>(i));
    if (!estimate) {
        made.error = estimate.error();
        return made;
    }
    made.encoded = std::move(*bytes);
    made.estimate = *estimate;
    return made;
}

std::vector<Copy> copies_of(const PlateLayout& plate, std::span<const std::uint32_t> order) {
    if (plate.shifts.size() == 1) return {Copy{}};
    std::vector<Copy> copies;
    for (const std::uint32_t number : order)
        copies.push_back({.object = number + 1, .shift = plate.shifts[number]});
    return copies;
}

// Appends layers, each with its time: that of its own motions and of the way to it.
class TimedWriter {
public:
    TimedWriter(format::Writer& writer, format::ThumbnailPainter& painter,
                const Estimator& estimator)
        : writer_(writer), painter_(painter), estimator_(estimator), head_(estimator.start()) {}

    Status append(format::EncodedLayer layer, std::uint32_t index, const LayerEstimate& made) {
        const auto way = estimator_.approach(head_, layer, index);
        if (!way) return way.error();
        layer.state.estimated_time_s = way->time_s() + made.estimate.time_s();
        estimate_ += *way;
        estimate_ += made.estimate;
        head_ = made.end;
        painter_.add(layer);
        return writer_.append(layer);
    }
    const Estimate& estimate() const { return estimate_; }

private:
    format::Writer& writer_;
    format::ThumbnailPainter& painter_;
    const Estimator& estimator_;
    moves::Head head_;
    Estimate estimate_{};
};

// Takes layers as they are made, in order.
struct Sink {
    TimedWriter timed;
    const Progress& progress;
    const Options& options;
    FillReport report{};
    LeftOutReport left_out{};
    BalanceReport balance{};
    RangeReport range{};
    std::optional<Diagnostic> failed{};

    bool take(std::size_t i, TimedLayer made, std::size_t count) {
        if (made.encoded && options.printer) range.add(*made.encoded, i, *options.printer);
        if (made.error) {
            failed = made.error;
        } else if (Status appended = timed.append(std::move(*made.encoded),
                                                  static_cast<std::uint32_t>(i), made.estimate);
                   !appended) {
            failed = appended.error();
        }
        if (failed) return false;
        progress("fill", i + 1, count);
        return true;
    }
};

Location place_of(std::size_t i, const Job& job) {
    return {.layer = static_cast<int>(i + 1), .z_mm = job.in.spans[i].middle_mm()};
}

std::optional<Imbalance> imbalance(std::size_t i, const Job& job, const LayerFill& fill) {
    return imbalance_of(job.in.layers[i], fill, job.in.spans[i], job.in.options.profile);
}

// Each layer of all copies.
void write_by_layer(const Job& job, Sink& sink, Diagnostics& diagnostics) {
    const auto to = copies_of(job.in.plate, job.in.plate.order);
    const std::vector<Copy> fro(to.rbegin(), to.rend());
    in_order(
        job.in.layers.size(), thread_count(job.in.options),
        [&](std::size_t i) {
            const PlannedLayer layer = planned(i, job);
            TimedLayer made = encoded(i, job, layer, i % 2 == 0 ? to : fro, i == 0, false);
            made.notes = notes_of(layer.fill);
            made.left_out = left_out_of(job.in.layers[i], layer.fill);
            made.imbalance = imbalance(i, job, layer.fill);
            return made;
        },
        [&](std::size_t i, TimedLayer made) {
            sink.report.add(made.notes, place_of(i, job), diagnostics);
            sink.left_out.add(made.left_out, i);
            sink.balance.add(made.imbalance, i);
            return sink.take(i, std::move(made), job.in.layers.size());
        });
}

// Each copy with all its layers, which are made once.
void write_in_sequence(const Job& job, Sink& sink, Diagnostics& diagnostics) {
    std::vector<PlannedLayer> layers;
    in_order(
        job.in.layers.size(), thread_count(job.in.options),
        [&](std::size_t i) { return planned(i, job); },
        [&](std::size_t i, PlannedLayer made) {
            sink.report.add(notes_of(made.fill), place_of(i, job), diagnostics);
            sink.left_out.add(left_out_of(job.in.layers[i], made.fill), i);
            sink.balance.add(imbalance(i, job, made.fill), i);
            layers.push_back(std::move(made));
            return true;
        });
    std::vector<std::uint32_t> from_front(job.in.plate.shifts.size());
    std::iota(from_front.begin(), from_front.end(), 0u);
    const auto copies = copies_of(job.in.plate, from_front);
    const std::size_t count = copies.size() * layers.size();
    in_order(
        count, thread_count(job.in.options),
        [&](std::size_t n) {
            const std::size_t copy = n / layers.size(), i = n % layers.size();
            const bool leaves = i + 1 == layers.size() && n + 1 < count;
            return encoded(i, job, layers[i], std::span(&copies[copy], 1), n == 0, leaves);
        },
        [&](std::size_t n, TimedLayer made) { return sink.take(n, std::move(made), count); });
}

}  // namespace

Result<Estimate> write_layers(const LayersToWrite& layers, format::Writer& writer,
                              format::ThumbnailPainter& painter, const Progress& progress,
                              Diagnostics& diagnostics) {
    const Job job{layers};
    Sink sink{.timed = TimedWriter(writer, painter, job.estimator),
              .progress = progress,
              .options = layers.options};
    if (job.in.plate.is_sequential()) {
        write_in_sequence(job, sink, diagnostics);
    } else {
        write_by_layer(job, sink, diagnostics);
    }
    if (sink.failed) return *sink.failed;
    sink.report.finish(layers.options.profile.infill, diagnostics);
    if (Status printed =
            sink.left_out.finish(layers.layers, layers.spans, layers.options, diagnostics);
        !printed)
        return printed.error();
    sink.balance.finish(layers.spans, diagnostics);
    if (layers.options.printer) sink.range.finish(*layers.options.printer, diagnostics);
    return sink.timed.estimate();
}

}  // namespace lyr::slicer
