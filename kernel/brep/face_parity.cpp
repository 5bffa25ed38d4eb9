// Union-find whose links carry a parity.

#include "kernel/brep/face_parity.h"

#include <array>
#include <utility>

namespace lyr {
namespace {

struct Use {
    FaceId face;
    bool reversed;
};

struct Uses {
    std::uint32_t count = 0;
    std::array<Use, 2> first_two{};
};

std::vector<Uses> uses_of_edges(const Model& model) {
    std::vector<Uses> uses(model.edges.size());
    for (std::size_t f = 0; f < model.faces.size(); ++f) {
        const Face& face = model.faces[f];
        for (std::uint32_t l = face.first_loop; l < face.first_loop + face.loop_count; ++l) {
            const Loop& loop = model.loops[l];
            for (std::uint32_t c = 0; c < loop.coedge_count; ++c) {
                const Coedge& coedge = model.coedges[loop.first_coedge + c];
                Uses& of_edge = uses[coedge.edge.value];
                if (of_edge.count < 2)
                    of_edge.first_two[of_edge.count] = {FaceId{f}, coedge.reversed};
                ++of_edge.count;
            }
        }
    }
    return uses;
}

}  // namespace

FaceParity::FaceParity(std::size_t faces) {
    for (std::size_t f = 0; f < faces; ++f) links_.push_back({FaceId{f}, false});
}

FaceParity::FaceParity(const Model& model) : FaceParity(model.faces.size()) {
    for (const Uses& uses : uses_of_edges(model)) {
        if (uses.count != 2) continue;
        const auto& [a, b] = uses.first_two;
        join(a.face, b.face, a.reversed != b.reversed);
    }
}

FaceParity::Link FaceParity::find(FaceId face) const {
    FaceId root = face;
    bool unlike = false;
    while (links_[root.value].root != root) {
        unlike = unlike != links_[root.value].unlike;
        root = links_[root.value].root;
    }
    const Link found{root, unlike};
    while (face != root) {
        Link& link = links_[face.value];
        const Link before = std::exchange(link, {root, unlike});
        unlike = unlike != before.unlike;
        face = before.root;
    }
    return found;
}

bool FaceParity::join(FaceId a, FaceId b, bool agree) {
    const Link one = find(a), other = find(b);
    const bool unlike = (one.unlike != other.unlike) == agree;
    if (one.root == other.root) return !unlike;
    // The lower index leads, so that the result does not depend on the order of joining.
    const auto [low, high] = std::minmax(one.root, other.root);
    links_[high.value] = {low, unlike};
    return true;
}

}  // namespace lyr
