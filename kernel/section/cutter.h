// Cuts a model with planes z = const into closed contours of lines and arcs.
//
// Contract
//  1. A Cutter holds what depends on the model only (monotone pieces, height intervals, outlines, cells of free-form
//     faces, these from the first plane on that meets them); cut() touches only what its plane meets, and may run
//     on several threads.
//  2. Contours close by construction: every crossing of an edge is computed once and is the end of one face's span
//     and the start of the neighbour's. What cannot close (an edge with one face) is counted in `open`, located
//     in `diagnostics` and left out of `contours`.
//  3. Contours have the material on the left; a solid's contours include its voids'.
//  4. The result depends on model, height and tolerance alone.
//  5. No height is special. Which side of the plane every vertex is on is decided at the height itself; coordinates
//     are taken at a height that has the same sides and keeps level_clearance_mm from every height where the topology
//     changes (half the way, between two that are closer).

#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "base/diagnostic.h"
#include "kernel/brep/model.h"
#include "kernel/brep/monotone.h"
#include "kernel/contour/contour.h"
#include "kernel/geometry/tolerance.h"
#include "kernel/section/face_section.h"
#include "kernel/section/freeform_face.h"
#include "kernel/section/interval_index.h"
#include "kernel/section/leaning.h"

namespace lyr {

struct SolidSection {
    SolidId solid;
    std::vector<Contour> contours;
};

struct Section {
    double z_mm = 0;
    std::vector<SolidSection> solids;  // those the plane meets, in the model's order
    // Ends that have no continuation, and solids whose area comes out negative: a face's part was taken for the rest
    // of its surface, or the shell is inside out. Neither has contours here.
    std::uint32_t open = 0;
    Diagnostics diagnostics;
};

class Cutter {
public:
    // Keeps a reference to the model.
    Cutter(const Model& model, const Tolerance& tolerance);

    Section cut(double z_mm) const;

    // Makes what a plane that meets the face would have to make first, if any of these (in rising order) may. On any thread:
    // threads that cut the same faces wait for each other there.
    void prepare(FaceId face, std::span<const double> heights_mm) const;

    // The section of each face, divided by how far the surface leans out (leaning.h).
    std::vector<LeaningSpan> leaning(double z_mm, double limit_rad) const;

    // The exact lowest and highest point of the model's faces.
    HeightRange height_range() const;

private:
    struct Crossing {
        Point3 point;
        const MonotonePiece* piece;
    };
    struct Event {
        FaceId face;
        std::uint32_t crossing;
        bool enters;
    };
    // The span that leaves from a crossing: its segments are [first, first + count) of Work::segments.
    struct TracedSpan {
        std::uint32_t enter, leave, first, count;
        SolidId solid;
    };
    struct Work {
        double z_mm = 0;  // clear of levels
        std::vector<Crossing> crossings{};
        std::vector<Event> events{};
        std::vector<TracedSpan> spans{};
        std::vector<Segment> segments{};
        std::vector<std::pair<SolidId, Contour>> contours{}, whole_contours{};
        Section section{};
    };

    double clear_of_levels(double z_mm) const;
    SolidId solid_of(FaceId face) const;
    void find_crossings(Work& work) const;
    // Calls visit(face, its events, whether it may hold whole components) for every face that the plane meets.
    using FaceVisit = std::function<void(FaceId, std::span<const Event>, bool)>;
    void for_faces(const Work& work, const FaceVisit& visit) const;
    void cut_face(FaceId face, std::span<const Event> events, bool whole, Work& work) const;
    SurfaceSection section_at(FaceId face, double z_mm) const;
    void add_spans(FaceId face, const SurfaceSection& section, const FaceSpans& spans,
                   Work& work) const;
    FaceSpans paired(const SurfaceSection& section, std::span<const Event> events,
                     const Work& work) const;
    std::vector<int> whole_components(FaceId face, const SurfaceSection& section,
                                      const std::vector<bool>& crossed, double z_mm) const;
    const Containment& containment(FaceId face) const;
    bool holds(FaceId face, const SurfaceSection& section, int component, double z_mm) const;
    void stitch(Work& work) const;
    void leave_out_contradictions(Work& work) const;
    void report(Work& work, std::string message, SourceId source, const Point3& point) const;

    const Model& model_;
    Tolerance tolerance_;
    MonotoneEdges edges_;
    double extent_mm_;                 // no two points of the model are farther apart
    std::vector<double> critical_mm_;  // heights where the topology changes, rising
    IntervalIndex pieces_by_height_;
    // Coedges by edge: uses_[use_start_[e] .. use_start_[e + 1]).
    struct Use {
        FaceId face;
        bool reversed;
    };
    std::vector<Use> uses_;
    std::vector<std::uint32_t> use_start_;
    // By face; null for elementary surfaces.
    std::vector<std::unique_ptr<FreeformFace>> freeform_;
    // Elementary faces of which a whole component can be inside, and where they are, by face; -1: none.
    std::vector<Containment> containments_;
    std::vector<std::int32_t> containment_of_;
    IntervalIndex closed_faces_by_height_;
};

}  // namespace lyr
