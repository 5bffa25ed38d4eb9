// Shells as the file states them (shells.h), with the geometry that hangs on them, into a model.
//
// Contract: that of solids.h, 1 and 2. One Builder fills one model; each solid has vertices and edges of its own.

#pragma once

#include <map>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "kernel/brep/model.h"
#include "kernel/brep/polygon_sides.h"
#include "parser/import/entity.h"
#include "parser/import/shells.h"
#include "parser/import/surfaces.h"
#include "parser/import/units.h"

namespace lyr::importer {

class Builder {
public:
    Builder(const File& file, const Units& units, part21::Trail& trail, Diagnostics& diagnostics);

    // What add_shell() adds belongs to the solid begun last.
    void begin_solid(std::string name, SourceId source);
    Status add_shell(const ShellRecord& record, bool is_surface = false);

    // What closes has an inside, and that decides where faces look. Files do not agree on it: some give same_sense
    // against the loops, some turn a void's shell before its orientation flag is applied and some after, and a
    // surface model does not say (not `is_stated`: turning it is nothing to tell).
    void orient_last_shell(const ShellRecord& record, bool is_void, bool is_stated);

    // Of the last solid's shells, all of them oriented as the file states their parts, the one that holds the others is
    // the outer one. Where the largest does not hold the stated outer one, all are solids of their own.
    void settle_outer_shell();

    Model take() { return std::move(model_); }

private:
    void part_shells();
    void add_note(InstanceIndex instance, const std::string& message);
    Status add_face(const ShellRecord& record, const FaceRecord& face, ShellId shell);
    Result<StatedSurface> surface_of(const FaceRecord& face, std::uint32_t first_loop);
    Status add_loop(const ShellRecord& record, const LoopRecord& loop);
    Result<Coedge> coedge_of(InstanceIndex loop, const EdgeUse& use);
    bool find_stand_ins(const ShellRecord& record, const LoopRecord& loop, std::uint32_t use);
    Diagnostic in_file(Diagnostic found, InstanceIndex instance) const;
    Result<VertexId> vertex_of(InstanceIndex user, InstanceIndex instance);
    Result<EdgeId> edge_of(InstanceIndex instance);

    const File& file_;
    const Units& units_;
    part21::Trail& trail_;
    Diagnostics& diagnostics_;
    Model model_;
    std::unordered_map<std::uint32_t, VertexId> vertices_;  // by VERTEX_POINT
    std::unordered_map<std::uint32_t, EdgeId> edges_;       // by EDGE_CURVE
    // Vertices of the neighbours for those that the file does not define, by EDGE_CURVE and its attribute.
    std::map<std::pair<std::uint32_t, std::size_t>, InstanceIndex> stand_ins_;
    PolygonSides sides_{model_};
};

}  // namespace lyr::importer
