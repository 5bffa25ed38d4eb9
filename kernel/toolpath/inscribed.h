// The largest discs inside a region that touch its boundary at a given place, and where else they touch it.
//
// The boundary is seen as sites: its segments and full circles, and the corners where it turns away from the
// material. Walking along all sites in turn, a disc rolls once around the inside of every contour: along segments,
// around corners.
//
// Contract
//  1. A touch's disc has no point of the boundary inside it, within round-off, and both places on it.
//  2. A disc that touches an arc only where it starts, being as curved as the arc, has that arc as its other site.
//
// Cost: log n for each disc and what is near.

#pragma once

#include <cstdint>
#include <vector>

#include "kernel/toolpath/boundary.h"

namespace lyr {

// Even: a piece of the boundary; odd: the corner at which the piece before it ends.
using SiteId = std::uint32_t;

struct Touch {
    double at = 0;  // along the site on which the disc rolls, in [0, 1]
    SiteId other = 0;
    double other_at = 0;
    Point2 centre = Point2::Zero();
    double radius_mm = 0;
};

// A place on a site, a corner's being the point that the disc rolls around.
struct SiteFoot {
    Point2 point;
    Vector2 normal;  // towards the disc's centre, unit
};

class InscribedDiscs {
public:
    // Discs of up to `usual_mm` in radius are found fast.
    InscribedDiscs(Region region, double usual_mm);

    SiteId site_count() const { return 2 * static_cast<SiteId>(boundary_.pieces().size()); }
    // Not a piece's end where the boundary goes straight on or turns into the material.
    bool is_site(SiteId site) const;
    const BoundaryPiece& piece(SiteId site) const { return boundary_.pieces()[site / 2]; }
    double curvature_per_mm(SiteId site) const;
    double turn_rad(SiteId site) const;  // in size
    SiteFoot foot(SiteId site, double at) const;
    // Where a disc with this centre touches a site that it is known to touch.
    SiteFoot foot_of(SiteId site, const Point2& centre) const;

    Touch touch(SiteId site, double at) const;
    // The disc that touches the whole line or circle of the other site; negative if there is none.
    double radius_mm(SiteId site, double at, SiteId other) const;
    double radius_mm(const SiteFoot& foot, SiteId other) const;
    // The touch with this site if there is such a disc.
    Touch touch_with(SiteId site, double at, SiteId other) const;
    // Whether the point of the site's whole line or circle that is nearest to a centre is on the site.
    bool is_beside(SiteId site, const Point2& centre) const;

    // Whether the sites follow each other, and where on the first this is.
    bool are_neighbours(SiteId site, SiteId other) const;
    double end_towards(SiteId site, SiteId other) const;

private:
    struct Joint {
        SiteId before, after;  // pieces
        double turn_rad;       // positive: to the left
    };

    bool is_passed_over(SiteId site, double at, SiteId other) const;
    double place(SiteId site, const Point2& centre) const;
    double other_place(SiteId site, double at, SiteId other, const Point2& centre,
                       double radius_mm) const;

    Boundary boundary_;
    std::vector<Joint> joints_;                   // by the piece that ends there
    std::vector<std::uint32_t> previous_, next_;  // by piece
    double usual_mm_;
};

}  // namespace lyr
