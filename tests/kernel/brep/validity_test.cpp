#include <doctest/doctest.h>

#include "kernel/brep/validity.h"
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

TEST_CASE("validity 2: a missing face leaves its edges named") {
    Model model = box(3, 4, 5);
    model.faces.pop_back();
    --model.shells[0].face_count;
    const Diagnostics found = validate(model);
    CHECK(found.size() == 4);
    for (const Diagnostic& diagnostic : found) CHECK(diagnostic.where.entity >= 1000);
    CHECK(open_shells(model).size() == 1);
}

TEST_CASE("validity 2: a coedge turned round is found") {
    Model model = box(3, 4, 5);
    model.coedges[5].reversed = !model.coedges[5].reversed;
    CHECK(!validate(model).empty());
    CHECK(open_shells(model).size() == 1);
}
