// The second half of a print: what is within the walls of each layer, in the order in which it is printed, into the file.

#pragma once

#include "format/thumbnail/painter.h"
#include "format/writer.h"
#include "slicer/outline.h"
#include "slicer/plate.h"
#include "slicer/support.h"

namespace lyr::slicer {

struct LayersToWrite {
    std::span<const OutlinedLayer> layers;
    std::span<const LayerSpan> spans;
    const SupportPlan& support;
    const PlateLayout& plate;
    const Options& options;
};

// Fills and order are made once for all copies. The print's estimate; errors are those of the writer and the estimator.
// `painter` sees each layer, too.
Result<Estimate> write_layers(const LayersToWrite& layers, format::Writer& writer,
                              format::ThumbnailPainter& painter, const Progress& progress,
                              Diagnostics& diagnostics);

}  // namespace lyr::slicer
