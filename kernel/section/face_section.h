// The uniform face rule: crossings of a face's boundary with a plane, sorted along the components of the
// untrimmed section, alternate enter and leave; the spans from enter to leave are the face's section.
//
// Contract
//  1. Whether a crossing enters or leaves is not measured: a coedge that falls through the plane enters, one that
//     rises leaves (the face is to the left of its coedges, the section runs along z x outward normal).
//  2. Every enter starts exactly one span and every leave ends one, if there are as many of each.
//  3. Where both stand at one crossing (a seam, used twice by the face), the span goes all the way round.
//  4. Crossings so close that round-off has exchanged them on the component are still paired in their order.
//  5. Components with more enters than leaves are joined to those with fewer by a straight span, and counted in
//     `forced`. So are crossings between which their component does not run.

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernel/section/surface_section.h"

namespace lyr {

struct FaceCrossing {
    std::uint32_t crossing;  // index of the plane's crossing
    bool enters;
    CrossingPoint at;
};

struct Span {
    std::uint32_t enter, leave;  // crossings
    int component;               // of the section; -1: joined by force, straight
    double from, to;             // keys
};

struct FaceSpans {
    std::vector<Span> spans;
    std::uint32_t forced = 0;
    // Crossings that are left over because enters and leaves differ in number.
    std::vector<std::uint32_t> unpaired;
    std::vector<bool> crossed;  // by component of the section
};

FaceSpans pair_crossings(const SurfaceSection& section, std::span<const FaceCrossing> crossings);

}  // namespace lyr
