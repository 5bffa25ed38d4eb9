// Every end has one neighbour on the boundary ahead and one behind. From one strand after the other, the chain that it
// is part of grows at either end, to the nearer of the neighbours that are the end of another chain.

#include "kernel/toolpath/strand_links.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <utility>

#include "kernel/geometry/tolerance.h"

namespace lyr {
namespace {

// Of strand i: 2 i is its start, 2 i + 1 its end.
using End = std::uint32_t;
constexpr End none = std::numeric_limits<End>::max();

End across(End end) {
    return end ^ 1;
}

class Linker {
public:
    Linker(std::span<const BoundaryPiece> boundary, std::span<const OpenStrand> strands)
        : strands_(strands), ruler_(boundary), places_(2 * strands.size()) {
        for (End e = 0; e < places_.size(); ++e) {
            places_[e].far = across(e);
            places_[e].position_mm = ruler_.position_mm(place(e));
        }
        find_neighbours();
    }

    std::vector<Path> linked(double longest_mm) {
        for (End strand = 0; strand < places_.size(); strand += 2) {
            for (const End first : {strand + 1, strand}) {
                for (End end = first; end != none;) end = grow(end, longest_mm);
            }
        }
        std::vector<Path> paths;
        std::vector<bool> taken(strands_.size(), false);
        for (End end = 0; end < places_.size(); ++end) {
            if (places_[end].link == none && !taken[end / 2]) paths.push_back(chain(end, taken));
        }
        return paths;
    }

private:
    struct Place {
        double position_mm = 0;
        End ahead = none, behind = none;  // its neighbours on the contour
        End link = none;
        End far = none;  // of an end of a chain: the chain's other one
    };

    const BoundaryPlace& place(End end) const {
        const OpenStrand& strand = strands_[end / 2];
        return end % 2 == 0 ? strand.start : strand.end;
    }

    void find_neighbours() {
        std::vector<End> order(places_.size());
        for (End e = 0; e < order.size(); ++e) order[e] = e;
        const auto key = [&](End e) {
            return std::tuple(ruler_.contour(place(e)), places_[e].position_mm, e);
        };
        std::sort(order.begin(), order.end(), [&](End a, End b) { return key(a) < key(b); });
        for (std::size_t first = 0; first < order.size();) {
            std::size_t last = first;
            while (last < order.size() &&
                   ruler_.contour(place(order[last])) == ruler_.contour(place(order[first]))) {
                ++last;
            }
            for (std::size_t i = first; i < last; ++i) {
                const End next = order[i + 1 == last ? first : i + 1];
                places_[order[i]].ahead = next;
                places_[next].behind = order[i];
            }
            first = last;
        }
    }

    // From an end forward to the one ahead of it.
    double stretch_mm(End from, End to) const {
        const double length = places_[to].position_mm - places_[from].position_mm;
        const bool round_the_start =
            std::tie(places_[to].position_mm, to) < std::tie(places_[from].position_mm, from);
        return round_the_start ? length + ruler_.contour_length_mm(ruler_.contour(place(from)))
                               : length;
    }

    bool can_link(End a, End b) const {
        return a != b && places_[b].link == none && places_[a].far != b;
    }

    // Links an end of a chain, if it is one and if it can be; gives the other end of what was added.
    End grow(End end, double longest_mm) {
        if (places_[end].link != none) return none;
        const End ahead = places_[end].ahead, behind = places_[end].behind;
        double nearest = longest_mm;
        End other = none;
        if (can_link(end, ahead) && stretch_mm(end, ahead) <= nearest) {
            other = ahead;
            nearest = stretch_mm(end, ahead);
        }
        if (can_link(end, behind) && stretch_mm(behind, end) <= nearest && behind != other) {
            // Nearer by more than round-off, so that equal stretches make the same choice wherever they are.
            if (other == none || stretch_mm(behind, end) < nearest - resolution_mm) other = behind;
        }
        if (other == none) return none;
        const End start = places_[end].far, last = places_[other].far;
        places_[end].link = other;
        places_[other].link = end;
        places_[start].far = last;
        places_[last].far = start;
        return last;
    }

    Path chain(End start, std::vector<bool>& taken) const {
        Path path{place(start).point, {}};
        for (End at = start;;) {
            taken[at / 2] = true;
            append_strand(at, path.segments);
            at = across(at);
            if (places_[at].link == none) return path;
            append_link(at, places_[at].link, path.segments);
            at = places_[at].link;
        }
    }

    void append_strand(End from, std::vector<Segment>& segments) const {
        const OpenStrand& strand = strands_[from / 2];
        if (from % 2 == 0) {
            segments.insert(segments.end(), strand.way.begin(), strand.way.end());
            return;
        }
        for (std::size_t i = strand.way.size(); i-- > 0;) {
            const Point2& end = i == 0 ? strand.start.point : strand.way[i - 1].end;
            segments.push_back({end, -strand.way[i].sagitta_mm});
        }
    }

    void append_link(End from, End to, std::vector<Segment>& segments) const {
        const bool forward =
            places_[from].ahead == to &&
            (places_[from].behind != to || stretch_mm(from, to) <= stretch_mm(to, from));
        const double length = forward ? stretch_mm(from, to) : stretch_mm(to, from);
        if (length <= resolution_mm) return;
        if (forward) {
            ruler_.append_forward(place(from), place(to), segments);
        } else {
            ruler_.append_backward(place(from), place(to), segments);
        }
    }

    std::span<const OpenStrand> strands_;
    BoundaryRuler ruler_;
    std::vector<Place> places_;
};

}  // namespace

std::vector<Path> linked(std::span<const BoundaryPiece> boundary,
                         std::span<const OpenStrand> strands, double longest_link_mm) {
    return Linker(boundary, strands).linked(longest_link_mm);
}

}  // namespace lyr
