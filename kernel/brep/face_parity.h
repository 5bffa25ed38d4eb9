// Which faces hang together by shared edges, and which of them have to be turned over so that all agree.
//
// A face agrees with its neighbour if one uses the common edge along it and the other against it. Agreement is
// transitive: faces form groups, in each of which every face is turned like the group's root or unlike it.

#pragma once

#include <vector>

#include "kernel/brep/model.h"

namespace lyr {

class FaceParity {
public:
    explicit FaceParity(std::size_t faces);

    // Groups by every edge that two faces use.
    explicit FaceParity(const Model& model);

    // Puts two faces into one group. `agree`: as they are. False if they are in one group already that says otherwise.
    bool join(FaceId a, FaceId b, bool agree);

    FaceId root(FaceId face) const { return find(face).root; }
    // Whether the face has to be turned over to agree with its group's root.
    bool unlike_root(FaceId face) const { return find(face).unlike; }

private:
    struct Link {
        FaceId root;
        bool unlike;
    };
    Link find(FaceId face) const;

    mutable std::vector<Link> links_;  // towards the root; shortened on the way
};

}  // namespace lyr
