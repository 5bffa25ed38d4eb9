// The topology of shells as the file states it: faces, loops and the edges that they use, with every orientation
// flag resolved, and no geometry read yet.
//
// Contract
//  1. A face's loops run, and its flag says which way it looks, as seen after all of: ORIENTED_FACE,
//     ORIENTED_CLOSED_SHELL, the bound's orientation, ORIENTED_EDGE.
//  2. A use is reversed when the loop runs against the EDGE_CURVE.
//  3. The sides of a POLY_LOOP are uses of no EDGE_CURVE, from point to point. Points with the same coordinates are
//     one, and sides without length are none. A face may do without a surface if it is bounded by polygons.
//  4. Subedges and other topology without edge curves or points are errors, status unsupported.

#pragma once

#include <vector>

#include "parser/import/entity.h"

namespace lyr::importer {

struct EdgeUse {
    InstanceIndex edge;  // EDGE_CURVE; not valid(): a polygon's side
    bool reversed;
    InstanceIndex from = {}, to = {};  // of a polygon's side: CARTESIAN_POINT
};

struct LoopRecord {
    InstanceIndex loop;
    InstanceIndex vertex;  // of a VERTEX_LOOP; else not valid()
    std::uint32_t first_use, use_count;
};

struct FaceRecord {
    InstanceIndex face, surface;  // a face of polygons may have no surface
    bool same_sense;
    std::uint32_t first_loop, loop_count;
    std::string name;
};

struct ShellRecord {
    InstanceIndex shell;  // as referred to, the oriented one if there is one
    std::vector<FaceRecord> faces;
    std::vector<LoopRecord> loops;
    std::vector<EdgeUse> uses;
};

Result<ShellRecord> read_shell(const File& file, InstanceIndex user, InstanceIndex shell,
                               part21::Trail& trail);

// How many of the shell's edges and sides are not used once along and once against.
std::size_t open_edge_count(const ShellRecord& shell);

}  // namespace lyr::importer
