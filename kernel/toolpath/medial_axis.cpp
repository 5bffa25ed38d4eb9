// A disc rolls along each site of the boundary and touches others. Where the other changes between two touches, the
// disc in between that touches both is found by a root of the difference of the two radii; if it turns out to touch a
// third, there are two such places. Every touch is one of both sites, so that what is narrow for one is not missed by
// the other.

#include "kernel/toolpath/medial_axis.h"

#include <algorithm>
#include <cmath>

namespace lyr {
namespace {

// Centres that are no farther from each other are the same; edges that are shorter are points.
constexpr double same_mm = 1e-5;

// A disc that is as near to one that touches three sites is that one.
constexpr double exact_mm = 1e-7;

// Discs are tried this many usual widths from each other: there cannot be much between.
constexpr double try_widths = 4;

// A curved edge has points so close that their feet turn by less, and never fewer than so many.
constexpr double point_turn_rad = 0.2;
constexpr int least_points = 12;

// Touches are refined in that many rounds at most: a halving each, where no root is found.
constexpr int most_rounds = 60;

// Touches of a region are about ten for each site; where contours cross each other, so that discs are nowhere right,
// there would be no end of them.
constexpr std::size_t most_touches = 100;

// Of the region's area, and not less than that of as many square millimetres: what areas may differ by.
constexpr double area_share = 2e-3, least_area_mm2 = 1e-4;

constexpr int most_root_steps = 40;

// Places along a site that differ by less are one to arithmetic; the sites opposite tell the discs there apart.
constexpr double least_share = 1e-12;

struct Pair {
    Touch first, second;
};

class AxisMaker {
public:
    AxisMaker(Region region, double usual_width_mm)
        : discs_(region, usual_width_mm), usual_mm_(usual_width_mm) {
        touches_.resize(discs_.site_count());
        changed_.resize(discs_.site_count(), true);
    }

    MedialAxis make() {
        for (SiteId site = 0; site < discs_.site_count(); ++site)
            if (discs_.is_site(site)) try_discs(site);
        bool again = true;
        for (int round = 0; round < most_rounds && again; ++round) {
            again = false;
            for (SiteId site = 0; site < discs_.site_count(); ++site)
                if (changed_[site] && !is_full()) again = refine(site) || again;
            if (is_full()) break;
        }
        for (SiteId site = 0; site < discs_.site_count(); ++site) add_edges(site);
        add_discs();
        return std::move(axis_);
    }

    double area_mm2() const { return area_mm2_; }

private:
    bool is_full() const { return count_ > most_touches * discs_.site_count(); }

    void insert(SiteId site, const Touch& touch) {
        ++count_;
        touches_[site].push_back(touch);
        changed_[site] = true;
        if (touch.other == site || touch.radius_mm == 0) return;
        touches_[touch.other].push_back(
            {touch.other_at, site, touch.at, touch.centre, touch.radius_mm});
        changed_[touch.other] = true;
    }

    void try_discs(SiteId site) {
        const double length = site % 2 == 0 ? discs_.piece(site).length_mm : 0;
        const int steps =
            2 + static_cast<int>(length / (try_widths * usual_mm_) + discs_.turn_rad(site));
        for (int i = 0; i <= steps; ++i)
            insert(site, discs_.touch(site, static_cast<double>(i) / steps));
    }

    static bool are_same(const Touch& a, const Touch& b, double within_mm = same_mm) {
        return (a.centre - b.centre).squaredNorm() <= within_mm * within_mm &&
               std::abs(a.radius_mm - b.radius_mm) <= within_mm;
    }

    // Whether a disc and the place where it touches the site are the same.
    bool are_one(SiteId site, const Touch& a, const Touch& b) const {
        const double whole =
            site % 2 == 0 ? discs_.piece(site).length_mm : discs_.turn_rad(site) * a.radius_mm;
        return std::abs(b.at - a.at) * whole <= same_mm && are_same(a, b);
    }

    static void move(std::vector<Touch>& touches, std::size_t from, std::size_t to) {
        const auto at = [&](std::size_t i) {
            return touches.begin() + static_cast<std::ptrdiff_t>(i);
        };
        if (from < to) std::rotate(at(from), at(from + 1), at(to + 1));
        if (to < from) std::rotate(at(to), at(from), at(from + 1));
    }

    // Touches of one disc, [first, last): the other of the touch before comes first, that of the one after last.
    static void arrange(std::vector<Touch>& touches, std::size_t first, std::size_t last) {
        if (first > 0) {
            const SiteId before = touches[first - 1].other;
            std::size_t i = first;
            while (i + 1 < last && touches[i].other != before) ++i;
            if (touches[i].other == before) move(touches, i, first);
        }
        if (last == touches.size()) return;
        const SiteId after = touches[last].other;
        for (std::size_t i = last; i-- > first + 1;)
            if (touches[i].other == after) return move(touches, i, last - 1);
    }

    // Touches of one disc so that their others follow each other as they do before and after.
    void sort(SiteId site) {
        std::vector<Touch>& touches = touches_[site];
        std::sort(touches.begin(), touches.end(), [](const Touch& a, const Touch& b) {
            return a.at < b.at || (a.at == b.at && a.other < b.other);
        });
        for (std::size_t first = 0; first < touches.size();) {
            std::size_t last = first + 1;
            while (last < touches.size() && are_one(site, touches[first], touches[last])) ++last;
            arrange(touches, first, last);
            first = last;
        }
    }

    // Whether there was a gap between touches of different sites.
    bool refine(SiteId site) {
        changed_[site] = false;
        sort(site);
        const std::vector<Touch> touches = touches_[site];
        for (std::size_t i = 0; i + 1 < touches.size(); ++i) {
            const Touch &a = touches[i], &b = touches[i + 1];
            if (a.other != b.other && b.at - a.at > least_share && !are_same(a, b))
                close_gap(site, a, b);
        }
        return changed_[site];
    }

    void close_gap(SiteId site, const Touch& a, const Touch& b) {
        if (discs_.are_neighbours(a.other, b.other)) {
            if (a.other_at == discs_.end_towards(a.other, b.other))
                return insert(site, discs_.touch_with(site, a.at, b.other));
            if (b.other_at == discs_.end_towards(b.other, a.other))
                return insert(site, discs_.touch_with(site, b.at, a.other));
        }
        if (also_touches(site, a, b.other) || also_touches(site, b, a.other)) return;
        const double at = place_between(site, a, b);
        if (!(a.at < at && at < b.at)) return;
        const Touch found = discs_.touch(site, at);
        insert(site, found);
        for (const SiteId side : {a.other, b.other})
            if (side != found.other) also_touches(site, found, side);
    }

    // Whether a disc touches another site as well; if so, that is a touch too.
    bool also_touches(SiteId site, const Touch& touch, SiteId other) {
        const Touch with = discs_.touch_with(site, touch.at, other);
        if (!are_same(with, touch, exact_mm) || !discs_.is_beside(other, with.centre)) return false;
        insert(site, with);
        return true;
    }

    // Where the discs that touch either of two others are the same; the middle if it is not known.
    double place_between(SiteId site, const Touch& a, const Touch& b) const {
        double low = a.at, high = b.at;
        const auto difference = [&](double at) {
            const double first = discs_.radius_mm(site, at, a.other);
            const double second = discs_.radius_mm(site, at, b.other);
            return first <= 0 ? 1 : second <= 0 ? -1 : (first - second) / (first + second);
        };
        double at_low = difference(low), at_high = difference(high);
        if (!(at_low < 0 && at_high > 0)) return (low + high) / 2;
        double at = low;
        for (int step = 0; step < most_root_steps; ++step) {
            const double before = at;
            at = (low * at_high - high * at_low) / (at_high - at_low);
            const double value = difference(at);
            if (value == 0 || at == before) break;
            // The end that stays counts half, so that both move.
            if (value < 0) {
                low = at, at_low = value, at_high /= 2;
            } else {
                high = at, at_high = value, at_low /= 2;
            }
        }
        return at;
    }

    // The edges along a site; of two sites those along the first.
    void add_edges(SiteId site) {
        sort(site);
        const std::vector<Touch>& touches = touches_[site];
        for (std::size_t first = 0; first < touches.size();) {
            std::size_t last = first;
            while (last + 1 < touches.size() && touches[last + 1].other == touches[first].other)
                ++last;
            if (touches[first].other > site) add_edge(site, touches[first], touches[last]);
            if (touches[first].other == site) add_sector(site, first, last);
            first = last + 1;
        }
    }

    // Along which a disc is an arc's own.
    void add_sector(SiteId site, std::size_t first, std::size_t last) {
        const std::vector<Touch>& touches = touches_[site];
        if (first > 0 && are_same(touches[first - 1], touches[first])) --first;
        if (last + 1 < touches.size() && are_same(touches[last], touches[last + 1])) ++last;
        area_mm2_ += (touches[last].at - touches[first].at) * discs_.piece(site).length_mm *
                     touches[first].radius_mm / 2;
    }

    void add_edge(SiteId site, const Touch& first, const Touch& last) {
        if (first.at == last.at) return;
        if (are_same(first, last) && last.at - first.at > 0.5) {  // around a hole
            Touch middle = discs_.touch_with(site, (first.at + last.at) / 2, first.other);
            add_edge(site, first, middle);
            return add_edge(site, middle, last);
        }
        const bool is_straight = site % 2 == 0 && first.other % 2 == 0 &&
                                 discs_.curvature_per_mm(site) == 0 &&
                                 discs_.curvature_per_mm(first.other) == 0;
        const double turn = discs_.turn_rad(site) * (last.at - first.at) +
                            discs_.turn_rad(first.other) *
                                std::abs(forwards(first.other, first.other_at, last.other_at));
        const int steps = is_straight ? 1 : least_points + static_cast<int>(turn / point_turn_rad);
        MedialEdge edge;
        Disc before = disc(site, first);
        double area = 0;
        for (int i = 0; i <= steps; ++i) {
            const double at = first.at + (last.at - first.at) * i / steps;
            const Disc here = i == 0       ? before
                              : i == steps ? disc(site, last)
                                           : disc_at(site, at, first.other);
            area += side_area(site, before.mine.point, here.mine.point, before.centre, here.centre);
            area += side_area(first.other, here.its.point, before.its.point, here.centre,
                              before.centre);
            if (edge.points.empty() || here.centre != edge.points.back().centre)
                edge.points.push_back({here.centre, tangent(here), here.radius_mm, area});
            before = here;
        }
        area_mm2_ += area;
        if (length_of(edge) > same_mm) axis_.edges.push_back(std::move(edge));
    }

    struct Disc {
        SiteFoot mine, its;
        Point2 centre;
        double radius_mm;
    };

    Disc disc(SiteId site, const Touch& touch) const {
        return {discs_.foot(site, touch.at), discs_.foot(touch.other, touch.other_at), touch.centre,
                touch.radius_mm};
    }

    Disc disc_at(SiteId site, double at, SiteId other) const {
        const SiteFoot mine = discs_.foot(site, at);
        const double radius = std::max(0.0, discs_.radius_mm(mine, other));
        const Point2 centre = mine.point + radius * mine.normal;
        return {mine, discs_.foot_of(other, centre), centre, radius};
    }

    // From one place of a site to another that is not far; a full circle goes on where it starts.
    double forwards(SiteId site, double from, double to) const {
        const double way = to - from;
        return site % 2 == 0 && discs_.piece(site).is_circle ? way - std::round(way) : way;
    }

    static double length_of(const MedialEdge& edge) {
        double length = 0;
        for (std::size_t i = 1; i < edge.points.size(); ++i)
            length += (edge.points[i].centre - edge.points[i - 1].centre).norm();
        return length;
    }

    // The edge leaves to the left of the way from one foot to the other, as seen along the first.
    static Vector2 tangent(const Disc& disc) {
        const Vector2 across = disc.mine.normal - disc.its.normal;
        return Vector2(across.y(), -across.x()).normalized();
    }

    // Between a short stretch of a site and the chord of the centres; the centres lie to the left.
    double side_area(SiteId site, const Point2& from, const Point2& to, const Point2& first,
                     const Point2& last) const {
        const double quadrangle = cross(last - from, first - to) / 2;
        const double k = discs_.curvature_per_mm(site);
        if (k == 0) return quadrangle;
        const double turn = 2 * std::asin(std::min(1.0, std::abs(k) * (to - from).norm() / 2));
        return quadrangle + (k > 0 ? 1 : -1) * (turn - std::sin(turn)) / (2 * k * k);
    }

    // Parts that are touched by one disc only.
    void add_discs() {
        const SiteId count = discs_.site_count();
        for (SiteId first = 0; first < count;) {
            SiteId last = first;
            bool is_disc = true;
            for (; last < count && discs_.piece(last).contour == discs_.piece(first).contour;
                 ++last)
                for (const Touch& touch : touches_[last])
                    is_disc = is_disc && are_same(touch, touches_[first].front());
            if (is_disc && touches_[first].front().radius_mm > 0)
                axis_.discs.push_back(
                    {touches_[first].front().centre, touches_[first].front().radius_mm});
            first = last;
        }
    }

    InscribedDiscs discs_;
    double usual_mm_;
    std::vector<std::vector<Touch>> touches_;  // by site
    std::vector<bool> changed_;
    std::size_t count_ = 0;  // of touches
    MedialAxis axis_;
    double area_mm2_ = 0;
};

// Gives ends that are the same one point.
void join_ends(std::vector<MedialEdge>& edges) {
    std::vector<MedialPoint*> ends;
    for (MedialEdge& edge : edges) {
        ends.push_back(&edge.points.front());
        ends.push_back(&edge.points.back());
    }
    std::stable_sort(ends.begin(), ends.end(), [](const MedialPoint* a, const MedialPoint* b) {
        return a->centre.x() < b->centre.x();
    });
    constexpr double near_mm = 4 * same_mm;
    for (std::size_t i = 0; i < ends.size(); ++i)
        for (std::size_t j = i + 1;
             j < ends.size() && ends[j]->centre.x() - ends[i]->centre.x() <= near_mm; ++j)
            if ((ends[j]->centre - ends[i]->centre).norm() <= near_mm)
                ends[j]->centre = ends[i]->centre;
}

bool is_finite(Region region) {
    for (const Contour& contour : region) {
        if (const auto* circle = std::get_if<FullCircle>(&contour)) {
            if (!circle->centre.allFinite() || !(circle->radius_mm > 0) ||
                std::isinf(circle->radius_mm))
                return false;
            continue;
        }
        const Path& path = std::get<Path>(contour);
        if (!path.start.allFinite()) return false;
        for (const Segment& segment : path.segments)
            if (!segment.end.allFinite() || !std::isfinite(segment.sagitta_mm)) return false;
    }
    return true;
}

}  // namespace

MedialEdge reversed(const MedialEdge& edge) {
    MedialEdge result = edge;
    std::reverse(result.points.begin(), result.points.end());
    for (MedialPoint& point : result.points) {
        point.tangent = -point.tangent;
        point.area_mm2 = edge.points.back().area_mm2 - point.area_mm2;
    }
    return result;
}

MedialAxis medial_axis(Region region, double usual_width_mm) {
    if (!is_finite(region) || !(usual_width_mm > 0)) return {.complete = false};
    AxisMaker maker(region, usual_width_mm);
    MedialAxis axis = maker.make();
    join_ends(axis.edges);
    const double area = area_mm2(region);
    const double allowed = std::max(least_area_mm2, area_share * area);
    axis.complete = std::abs(maker.area_mm2() - area) <= allowed;
    return axis;
}

}  // namespace lyr
