#include "kernel/brep/validity.h"

#include <doctest/doctest.h>

#include <set>
#include <string>

#include "kernel/brep/gaps.h"
#include "kernel/solids.h"

using namespace lyr;
using namespace lyr::testing;

TEST_CASE("validity 1: whole solids have nothing to report") {
    for (const Model& model :
         {box(3, 4, 5), frustum(1, 3, 5, Side::seam), frustum(3, 1, 5, Side::two_loops),
          torus(5, 2, true), torus(5, 2, false), sphere(2, true), cone_with_apex(2, 3, true)}) {
        CHECK(validate(model).empty());
        CHECK(open_shells(model).empty());
    }
}

TEST_CASE("validity 2: a missing face leaves a hole whose edges and size are named") {
    Model model = box(3, 4, 5);
    model.faces.pop_back();
    --model.shells[0].face_count;
    const Diagnostics found = validate(model);
    REQUIRE(found.size() == 1);
    CHECK(found[0].where.entity >= 1000);
    CHECK(found[0].where.x_mm.has_value());
    // The last face is the top, 3 by 4.
    CHECK(found[0].message.find("12 mm2, 14 mm around") != std::string::npos);
    std::set<EdgeId> edges;
    for (const Gap& gap : gaps(model)) edges.insert(gap.edges.begin(), gap.edges.end());
    CHECK(edges.size() == 4);
    for (const EdgeId edge : edges) {
        const std::string name = '#' + std::to_string(model[edge].source);
        CHECK(found[0].message.find(name) != std::string::npos);
        CHECK(model[model[edge].start].point.z() == 2.5);
        CHECK(model[model[edge].end].point.z() == 2.5);
    }
    CHECK(open_shells(model).size() == 1);
}

TEST_CASE("validity 2: a coedge turned round is found") {
    Model model = box(3, 4, 5);
    model.coedges[5].reversed = !model.coedges[5].reversed;
    CHECK(!validate(model).empty());
    CHECK(open_shells(model).size() == 1);
}
