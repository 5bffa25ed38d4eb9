// One plane: stab the monotone pieces, one crossing each; hand every crossing to the faces of its edge as an enter
// or a leave; pair and trace face by face; follow spans from crossing to crossing.

#include "kernel/section/cutter.h"

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

#include "kernel/section/face_heights.h"
#include "kernel/section/face_section.h"
#include "kernel/section/surface_section.h"

namespace lyr {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Eigen::AlignedBox3d box_of(const Model& model) {
    Eigen::AlignedBox3d box;
    for (const Edge& edge : model.edges) {
        // A quarter of the way at a time: no curve of an edge strays from these by more than the edge is long.
        for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
            box.extend(evaluate(edge.curve, edge.t_start + share * (edge.t_end - edge.t_start)));
        }
    }
    for (const Face& face : model.faces) {
        if (const auto* sphere = std::get_if<Sphere>(&face.surface)) {
            const Vector3 reach = Vector3::Constant(sphere->radius_mm);
            box.extend(sphere->frame.origin - reach).extend(sphere->frame.origin + reach);
        } else if (const auto* torus = std::get_if<Torus>(&face.surface)) {
            const Vector3 reach = Vector3::Constant(torus->major_mm + torus->minor_mm);
            box.extend(torus->frame.origin - reach).extend(torus->frame.origin + reach);
        }
    }
    return box;
}

// The heights at which a closed component of the face's surface can lie in the face; empty for surfaces whose
// sections are never closed without meeting an edge.
HeightRange closed_component_range(const Face& face, HeightRange loops,
                                   const FreeformFace* freeform) {
    if (std::holds_alternative<Cylinder>(face.surface)) return loops;
    if (const auto* cone = std::get_if<Cone>(&face.surface)) {
        const double apex = apex_of(*cone).z();
        return {std::min(loops.bottom_mm, apex), std::max(loops.top_mm, apex)};
    }
    if (const auto* sphere = std::get_if<Sphere>(&face.surface)) {
        const double z = sphere->frame.origin.z();
        return {z - sphere->radius_mm, z + sphere->radius_mm};
    }
    if (std::holds_alternative<SharedBSplineSurface>(face.surface)) {
        const HeightRange hull = freeform->hull();
        return {std::min(loops.bottom_mm, hull.bottom_mm), std::max(loops.top_mm, hull.top_mm)};
    }
    if (const auto* torus = std::get_if<Torus>(&face.surface)) {
        const double lean = torus->frame.z.head<2>().norm(), z = torus->frame.origin.z();
        const double reach = lean * torus->major_mm + torus->minor_mm;
        return {z - reach, z + reach};
    }
    return {infinity, -infinity};
}

Point2 some_point(const Contour& contour) {
    const auto* circle = std::get_if<FullCircle>(&contour);
    return circle ? circle->centre : std::get<Path>(contour).start;
}

void sort_unique(std::vector<double>& heights) {
    std::sort(heights.begin(), heights.end());
    heights.erase(std::unique(heights.begin(), heights.end()), heights.end());
}

// Levels of edges, and heights where a surface is level that are not one of those but for round-off.
std::vector<double> critical_heights(const Model& model, const MonotoneEdges& edges) {
    std::vector<double> levels = edges.vertex_level_mm;
    for (const MonotonePiece& piece : edges.pieces) {
        levels.push_back(piece.bottom_mm);
        levels.push_back(piece.top_mm);
    }
    sort_unique(levels);
    std::vector<double> heights = levels;
    const auto add = [&](double z) {
        const auto next = std::lower_bound(levels.begin(), levels.end(), z - resolution_mm);
        if (next == levels.end() || *next > z + resolution_mm) heights.push_back(z);
    };
    for (const Face& face : model.faces) {
        for (const Point3& point : level_points(face.surface)) add(point.z());
        if (const auto* cone = std::get_if<Cone>(&face.surface)) add(apex_of(*cone).z());
    }
    sort_unique(heights);
    return heights;
}

}  // namespace

Cutter::Cutter(const Model& model, const Tolerance& tolerance)
    : model_(model), tolerance_(tolerance), edges_(monotone_pieces(model)) {
    const Eigen::AlignedBox3d box = box_of(model);
    extent_mm_ = box.isEmpty() ? 0 : box.diagonal().norm();

    std::vector<HeightInterval> pieces;
    for (std::size_t i = 0; i < edges_.pieces.size(); ++i) {
        const MonotonePiece& piece = edges_.pieces[i];
        pieces.push_back({piece.bottom_mm, piece.top_mm, static_cast<std::uint32_t>(i)});
    }
    pieces_by_height_ = IntervalIndex(std::move(pieces));

    std::vector<std::vector<Use>> uses(model.edges.size());
    for (std::size_t f = 0; f < model.faces.size(); ++f) {
        const Face& face = model.faces[f];
        for (std::uint32_t l = 0; l < face.loop_count; ++l) {
            const Loop& loop = model.loops[face.first_loop + l];
            for (std::uint32_t c = 0; c < loop.coedge_count; ++c) {
                const Coedge& coedge = model.coedges[loop.first_coedge + c];
                uses[coedge.edge.value].push_back({FaceId{f}, coedge.reversed});
            }
        }
    }
    for (const auto& of_edge : uses) {
        use_start_.push_back(static_cast<std::uint32_t>(uses_.size()));
        uses_.insert(uses_.end(), of_edge.begin(), of_edge.end());
    }
    use_start_.push_back(static_cast<std::uint32_t>(uses_.size()));

    critical_mm_ = critical_heights(model, edges_);

    const std::vector<HeightRange> ranges = loop_heights(model, edges_);
    std::vector<HeightInterval> closed;
    for (std::uint32_t f = 0; f < model.faces.size(); ++f) {
        const FaceId id{f};
        const HeightRange loops = ranges[f];
        const bool freeform = std::holds_alternative<SharedBSplineSurface>(model[id].surface);
        freeform_.push_back(
            freeform ? std::make_unique<FreeformFace>(model, id, edges_.vertex_level_mm, loops)
                     : nullptr);
        containment_of_.push_back(-1);
        const HeightRange range = closed_component_range(model[id], loops, freeform_.back().get());
        if (!(range.bottom_mm < range.top_mm)) continue;
        closed.push_back({range.bottom_mm, range.top_mm, f});
        if (freeform) continue;
        containment_of_.back() = static_cast<std::int32_t>(containments_.size());
        containments_.emplace_back(model, id, edges_.vertex_level_mm);
    }
    closed_faces_by_height_ = IntervalIndex(std::move(closed));
}

const Containment& Cutter::containment(FaceId face) const {
    if (freeform_[face.value]) return freeform_[face.value]->containment();
    return containments_[static_cast<std::size_t>(containment_of_[face.value])];
}

void Cutter::prepare(FaceId face, std::span<const double> heights_mm) const {
    const auto& freeform = freeform_[face.value];
    if (!freeform) return;
    const HeightRange hull = freeform->hull();
    const auto first = std::lower_bound(heights_mm.begin(), heights_mm.end(), hull.bottom_mm);
    if (first == heights_mm.end() || *first > hull.top_mm) return;
    freeform->mesh();
    freeform->heights();
}

HeightRange Cutter::height_range() const {
    HeightRange range{infinity, -infinity};
    const auto extend = [&](double z) {
        range.bottom_mm = std::min(range.bottom_mm, z);
        range.top_mm = std::max(range.top_mm, z);
    };
    for (const double level : edges_.vertex_level_mm) extend(level);
    for (const MonotonePiece& piece : edges_.pieces) {
        extend(piece.bottom_mm);
        extend(piece.top_mm);
    }
    for (std::uint32_t f = 0; f < model_.faces.size(); ++f) {
        if (containment_of_[f] < 0) continue;
        const Face& face = model_.faces[f];
        for (const Point3& point : level_points(face.surface)) {
            if (containment(FaceId{f}).holds(point, point.z())) extend(point.z());
        }
        if (const auto* cone = std::get_if<Cone>(&face.surface)) {
            // Only an apex inside a loop that winds around it is part of the face.
            if (containment(FaceId{f}).holds_apex()) extend(apex_of(*cone).z());
        }
    }
    // Free-form faces last, those first whose hulls reach out farthest: where hulls stay within, faces need not be looked into.
    std::vector<std::pair<double, const FreeformFace*>> beyond;
    for (const auto& freeform : freeform_) {
        if (!freeform) continue;
        const HeightRange hull = freeform->hull();
        const double excess =
            std::max(hull.top_mm - range.top_mm, range.bottom_mm - hull.bottom_mm);
        if (excess > 0) beyond.emplace_back(excess, freeform.get());
    }
    std::stable_sort(beyond.begin(), beyond.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    for (const auto& [excess, freeform] : beyond) range = freeform->extended(range);
    return range;
}

double Cutter::clear_of_levels(double z_mm) const {
    if (critical_mm_.empty()) return z_mm;
    const auto above = std::upper_bound(critical_mm_.begin(), critical_mm_.end(), z_mm);
    if (above == critical_mm_.begin()) return std::min(z_mm, *above - level_clearance_mm);
    const double low = *std::prev(above);
    if (above == critical_mm_.end()) return std::max(z_mm, low + level_clearance_mm);
    const double clearance = std::min(level_clearance_mm, (*above - low) / 2);
    return std::clamp(z_mm, low + clearance, *above - clearance);
}

SolidId Cutter::solid_of(FaceId face) const {
    return model_[model_[face].shell].solid;
}

void Cutter::report(Work& work, std::string message, SourceId source, const Point3& point) const {
    work.section.diagnostics.push_back({Severity::error,
                                        ExitStatus::geometry,
                                        std::move(message),
                                        {.file = {},
                                         .line = 0,
                                         .column = 0,
                                         .entity = source,
                                         .layer = {},
                                         .x_mm = point.x(),
                                         .y_mm = point.y(),
                                         .z_mm = work.z_mm}});
}

void Cutter::find_crossings(Work& work) const {
    pieces_by_height_.stab(work.z_mm, [&](std::uint32_t item) {
        const MonotonePiece& piece = edges_.pieces[item];
        const Edge& edge = model_[piece.edge];
        const double t = parameter_at_height(edge.curve, piece.t_bottom, piece.t_top, work.z_mm);
        const auto index = static_cast<std::uint32_t>(work.crossings.size());
        work.crossings.push_back({evaluate(edge.curve, t), &piece});
        for (std::uint32_t u = use_start_[piece.edge.value]; u < use_start_[piece.edge.value + 1];
             ++u) {
            const bool rises = piece.rising != uses_[u].reversed;
            work.events.push_back({uses_[u].face, index, !rises});
        }
    });
    std::sort(work.events.begin(), work.events.end(), [](const Event& a, const Event& b) {
        return std::tie(a.face, a.crossing, a.enters) < std::tie(b.face, b.crossing, b.enters);
    });
}

SurfaceSection Cutter::section_at(FaceId id, double z_mm) const {
    const Face& face = model_[id];
    const auto& freeform = freeform_[id.value];
    if (!freeform) return section_of(face.surface, face.same_sense, z_mm, extent_mm_);
    const bool forward = face.same_sense != freeform->mesh().surface->mirrored;
    FreeformSection section{
        level_curves(freeform->mesh(), z_mm, forward, tolerance_.trace_mm() / 2)};
    if (section.curves.empty()) return TouchSection{};
    return section;
}

void Cutter::add_spans(FaceId id, const SurfaceSection& section, const FaceSpans& paired,
                       Work& work) const {
    const Face& face = model_[id];
    std::uint32_t straight = paired.forced;
    for (const Span& span : paired.spans) {
        const Point2 start = work.crossings[span.enter].point.head<2>();
        const Point2 end = work.crossings[span.leave].point.head<2>();
        const auto first = static_cast<std::uint32_t>(work.segments.size());
        if (span.component < 0) {
            work.segments.push_back({end});
        } else if (!trace(section, span.component, span.from, span.to, start, end, tolerance_,
                          work.segments)) {
            ++straight;
        }
        const auto count = static_cast<std::uint32_t>(work.segments.size()) - first;
        work.spans.push_back({span.enter, span.leave, first, count, solid_of(id)});
    }
    for (const std::uint32_t c : paired.unpaired) {
        ++work.section.open;
        report(work,
               "the face's boundary is open: edge #" +
                   std::to_string(model_[work.crossings[c].piece->edge].source) +
                   " has no counterpart",
               face.source, work.crossings[c].point);
    }
    if (straight == 0) return;
    work.section.diagnostics.push_back(
        {Severity::warning,
         ExitStatus::geometry,
         "edges lie off the face's surface: " + std::to_string(straight) +
             " of its spans were joined by straight lines",
         {.file = {},
          .line = 0,
          .column = 0,
          .entity = face.source,
          .layer = {},
          .z_mm = work.z_mm}});
}

bool Cutter::holds(FaceId face, const SurfaceSection& section, int component, double z_mm) const {
    if (const auto* freeform = std::get_if<FreeformSection>(&section)) {
        const auto c = static_cast<std::size_t>(component);
        return containment(face).holds_parameters(freeform->curves[c].uv);
    }
    const Point2 on = at(section, {component, 0}).point;
    return containment(face).holds({on.x(), on.y(), z_mm}, z_mm);
}

std::vector<int> Cutter::whole_components(FaceId id, const SurfaceSection& section,
                                          const std::vector<bool>& crossed, double z_mm) const {
    std::vector<int> whole;
    for (int component = 0; component < component_count(section); ++component) {
        const bool is_crossed = !crossed.empty() && crossed[static_cast<std::size_t>(component)];
        if (is_crossed || period(section, component) == 0) continue;
        if (holds(id, section, component, z_mm)) whole.push_back(component);
    }
    return whole;
}

FaceSpans Cutter::paired(const SurfaceSection& section, std::span<const Event> events,
                         const Work& work) const {
    if (events.empty()) return {};
    std::vector<FaceCrossing> crossings;
    for (const Event& event : events) {
        const Crossing& crossing = work.crossings[event.crossing];
        crossings.push_back(
            {event.crossing, event.enters, {crossing.point, crossing.piece->middle}});
    }
    return pair_crossings(section, crossings);
}

void Cutter::cut_face(FaceId id, std::span<const Event> events, bool whole, Work& work) const {
    const SurfaceSection section = section_at(id, work.z_mm);
    const FaceSpans spans = paired(section, events, work);
    add_spans(id, section, spans, work);
    if (!whole) return;
    for (const int component : whole_components(id, section, spans.crossed, work.z_mm))
        work.whole_contours.emplace_back(solid_of(id),
                                         whole_component(section, component, tolerance_));
}

void Cutter::for_faces(const Work& work, const FaceVisit& visit) const {
    std::vector<FaceId> closed;
    closed_faces_by_height_.stab(work.z_mm, [&](std::uint32_t f) { closed.push_back(FaceId{f}); });
    std::sort(closed.begin(), closed.end());
    auto whole = closed.begin();
    for (auto first = work.events.cbegin(); first != work.events.cend() || whole != closed.end();) {
        const FaceId face = first == work.events.cend() ? *whole
                            : whole == closed.end()     ? first->face
                                                        : std::min(first->face, *whole);
        auto last = first;
        while (last != work.events.cend() && last->face == face) ++last;
        const bool is_whole = whole != closed.end() && *whole == face;
        if (is_whole) ++whole;
        const auto& freeform = freeform_[face.value];
        // Most of a free-form surface's hull is empty; what the face spans is known after a first look.
        const bool beyond =
            first == last && freeform &&
            (work.z_mm < freeform->heights().bottom_mm || freeform->heights().top_mm <= work.z_mm);
        if (!beyond) visit(face, {first, last}, is_whole);
        first = last;
    }
}

void Cutter::stitch(Work& work) const {
    // Spans by the crossing they leave from; more than one only where more than two faces meet.
    std::sort(work.spans.begin(), work.spans.end(), [](const TracedSpan& a, const TracedSpan& b) {
        return std::tie(a.solid, a.enter, a.leave) < std::tie(b.solid, b.enter, b.leave);
    });
    const auto next_of = [&](SolidId solid, std::uint32_t crossing) {
        return std::lower_bound(work.spans.begin(), work.spans.end(), std::pair(solid, crossing),
                                [](const TracedSpan& a, const auto& key) {
                                    return std::pair(a.solid, a.enter) < key;
                                }) -
               work.spans.begin();
    };
    std::vector<bool> used(work.spans.size(), false);
    for (std::size_t s = 0; s < work.spans.size(); ++s) {
        if (used[s]) continue;
        const std::uint32_t origin = work.spans[s].enter;
        const SolidId solid = work.spans[s].solid;
        Path path{work.crossings[origin].point.head<2>(), {}};
        for (auto at_span = s;;) {
            used[at_span] = true;
            const TracedSpan& span = work.spans[at_span];
            const auto from = work.segments.begin() + span.first;
            path.segments.insert(path.segments.end(), from, from + span.count);
            if (span.leave == origin) {
                if (auto contour = simplified(std::move(path), tolerance_.trace_mm())) {
                    work.contours.emplace_back(solid, std::move(*contour));
                }
                break;
            }
            auto next = static_cast<std::size_t>(next_of(solid, span.leave));
            while (next < work.spans.size() && used[next] && work.spans[next].enter == span.leave) {
                ++next;
            }
            if (next >= work.spans.size() || work.spans[next].enter != span.leave ||
                work.spans[next].solid != solid) {
                ++work.section.open;
                report(work, "the contour does not close: the edge has no face on its other side",
                       model_[work.crossings[span.leave].piece->edge].source,
                       work.crossings[span.leave].point);
                break;
            }
            at_span = next;
        }
    }
}

void Cutter::leave_out_contradictions(Work& work) const {
    std::erase_if(work.section.solids, [&](const SolidSection& part) {
        double area = 0, length = 0;
        for (const Contour& contour : part.contours) {
            area += area_mm2(contour);
            length += length_mm(contour);
        }
        if (area >= -tolerance_.total_mm * length) return false;
        ++work.section.open;
        const Point2 at = some_point(part.contours.front());
        report(work, "the solid's section has a negative area: its faces contradict each other",
               model_[part.solid].source, {at.x(), at.y(), work.z_mm});
        return true;
    });
}

Section Cutter::cut(double z_mm) const {
    Work work{.z_mm = clear_of_levels(z_mm)};
    work.section.z_mm = z_mm;
    find_crossings(work);
    for_faces(work, [&](FaceId face, std::span<const Event> events, bool whole) {
        cut_face(face, events, whole, work);
    });
    stitch(work);
    std::move(work.whole_contours.begin(), work.whole_contours.end(),
              std::back_inserter(work.contours));
    std::stable_sort(work.contours.begin(), work.contours.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (auto& [solid, contour] : work.contours) {
        if (work.section.solids.empty() || work.section.solids.back().solid != solid) {
            work.section.solids.push_back({solid, {}});
        }
        work.section.solids.back().contours.push_back(std::move(contour));
    }
    leave_out_contradictions(work);
    return std::move(work.section);
}

}  // namespace lyr
