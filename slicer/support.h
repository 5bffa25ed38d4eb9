// Supports: under which faces they are, where they stand, and how they are printed.
//
// Contract
//  1. What leans out further than support.angle is held, by the exact normals of the faces (kernel/section/leaning.h), and
//     flat undersides that are no bridges (kernel/toolpath/overhang.h); not so under faces that support.blockers name.
//  2. Support stands as kernel/toolpath/support_areas.h has it.
//  3. It has one wall, sparse lines that lie over each other in all layers, and dense lines across where it meets the part.
//  4. On a raft, it stands on that: the lines of its lowest layer fill the gap under the part too.
//  5. Overhangs under which there is no room for support are warned of, with the first of their layers.

#pragma once

#include <span>
#include <vector>

#include "kernel/section/cutter.h"
#include "kernel/toolpath/overhang.h"
#include "kernel/toolpath/support_areas.h"
#include "slicer/fill.h"

namespace lyr::slicer {

// The faces that support.blockers name: by their names in the file, or as "#123" by their instances. Errors (usage): a name
// that no face has.
Result<std::vector<FaceId>> blocked_faces(const Model& model, const profile::Support& support);

class SupportPlan {
public:
    SupportPlan() = default;  // none
    // The layers below `first` are a raft's, without outlines.
    SupportPlan(std::span<const OutlinedLayer> layers, std::span<const LayerSpan> spans,
                std::size_t first = 0);

    // Where support is needed: from the normals of the model's faces.
    void find_overhangs(const Model& model, const Cutter& cutter, std::span<const FaceId> blocked,
                        const Options& options);
    // Where it stands.
    void find_areas(const Options& options, Diagnostics& diagnostics);

    bool empty() const { return areas_.layers.empty(); }
    Region area(std::size_t layer) const;
    Region overhang(std::size_t layer) const { return overhangs_[layer].contours; }

    // The part and its support, as one.
    std::vector<Contour> with_part(std::size_t layer, const Options& options,
                                   std::size_t& unresolved) const;

    // What a raft is to carry: the part's first layer, its support, and what hangs over so low that its support would begin
    // within the raft.
    std::vector<Contour> footprint(const Options& options, std::size_t& unresolved) const;

    // Of one layer; on any thread.
    std::vector<Piece> pieces(std::size_t layer, const Options& options,
                              std::size_t& unresolved) const;

private:
    std::span<const OutlinedLayer> layers_{};
    std::size_t first_ = 0;
    std::vector<Overhang> overhangs_{};  // by layer
    std::vector<SupportLevel> levels_{};
    SupportAreas areas_{};
};

}  // namespace lyr::slicer
