// A boundary representation in flat tables: solids of shells of faces of loops of coedges.
//
// Contract (what the importer fills in and validate() checks)
//  1. Seen against the outward normal, a face lies to the left of each of its coedges. Outward is away from the
//     material, for voids too.
//  2. An edge runs from start to end while its parameter goes from t_start to t_end, which may fall.
//  3. In a closed shell each edge has one coedge along it and one against it.
//  4. Everything names the instance of the file that it came from, for messages.

#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/typed_index.h"
#include "kernel/geometry/curve.h"
#include "kernel/geometry/surface.h"

namespace lyr {

using VertexId = TypedIndex<struct VertexTag>;
using EdgeId = TypedIndex<struct EdgeTag>;
using CoedgeId = TypedIndex<struct CoedgeTag>;
using LoopId = TypedIndex<struct LoopTag>;
using FaceId = TypedIndex<struct FaceTag>;
using ShellId = TypedIndex<struct ShellTag>;
using SolidId = TypedIndex<struct SolidTag>;
using SourceId = std::uint64_t;  // #id in the STEP file; 0: none

struct Vertex {
    Point3 point;
    SourceId source = 0;
};

struct Edge {
    Curve curve;
    double t_start, t_end;
    VertexId start, end;  // equal for a closed edge
    SourceId source = 0;
};

struct Coedge {
    EdgeId edge;
    bool reversed;  // against the edge
};

// A loop of no coedges is a vertex loop: the face reaches a pole or an apex there.
struct Loop {
    std::uint32_t first_coedge, coedge_count;
    SourceId source = 0;
};

struct Face {
    Surface surface;
    bool same_sense;  // the outward normal is normal(surface)
    std::uint32_t first_loop, loop_count;
    ShellId shell;
    SourceId source = 0;
};

struct Shell {
    std::uint32_t first_face, face_count;
    SolidId solid;
    SourceId source = 0;
    bool is_surface = false;  // not stated as the boundary of a solid: heal() finds what it bounds
};

struct Solid {
    std::string name;
    std::uint32_t first_shell, shell_count;  // the outer shell first, then voids
    SourceId source = 0;
};

struct Model {
    std::vector<Vertex> vertices;
    std::vector<Edge> edges;
    std::vector<Coedge> coedges;
    std::vector<Loop> loops;
    std::vector<Face> faces;
    std::vector<Shell> shells;
    std::vector<Solid> solids;
    double uncertainty_mm =
        0;  // the file's own statement of how far its parts may be apart; 0: none
    std::map<SourceId, std::string> face_names;  // by the face's source; of those that have one

    const Vertex& operator[](VertexId id) const { return vertices[id.value]; }
    const Edge& operator[](EdgeId id) const { return edges[id.value]; }
    const Coedge& operator[](CoedgeId id) const { return coedges[id.value]; }
    const Loop& operator[](LoopId id) const { return loops[id.value]; }
    const Face& operator[](FaceId id) const { return faces[id.value]; }
    const Shell& operator[](ShellId id) const { return shells[id.value]; }
    const Solid& operator[](SolidId id) const { return solids[id.value]; }

    // The vertices of a coedge, in the loop's direction.
    VertexId start_of(const Coedge& coedge) const {
        return coedge.reversed ? (*this)[coedge.edge].end : (*this)[coedge.edge].start;
    }
    VertexId end_of(const Coedge& coedge) const {
        return coedge.reversed ? (*this)[coedge.edge].start : (*this)[coedge.edge].end;
    }
};

}  // namespace lyr
