#include "slicer/print_fill.h"

#include <iterator>

#include "slicer/adhesion.h"
#include "slicer/raft.h"

namespace lyr::slicer {

LayerFill print_fill(std::size_t index, const Walls& walls, const PartLayers& layers,
                     const SupportPlan& support, const Options& options) {
    const std::size_t raft = raft_layers(options.profile);
    LayerFill fill;
    if (index < raft) {
        const auto footprint = support.footprint(options, fill.unresolved);
        fill.pieces = raft_pieces(index, footprint, options, fill.unresolved);
        fill.support = fill.pieces.size();
        return fill;
    }
    fill = fill_layer(index - raft, walls, layers.from(raft), options);
    std::vector<Piece> pieces = support.pieces(index, options, fill.unresolved);
    fill.support = pieces.size();
    fill.pieces.insert(fill.pieces.begin(), std::make_move_iterator(pieces.begin()),
                       std::make_move_iterator(pieces.end()));
    if (index == 0)
        fill.around = adhesion_of(support.with_part(index, options, fill.unresolved),
                                  layers.spans[index].height_mm(), options, fill.unresolved);
    return fill;
}

}  // namespace lyr::slicer
