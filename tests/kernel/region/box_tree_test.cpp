#include "kernel/region/box_tree.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "kernel/region/regions.h"

using namespace lyr;
using namespace lyr::region;
using lyr::testing::Random;

TEST_CASE("box tree: finds the boxes that meet one, all of them and each once") {
    Random random(1);
    const auto box = [&](double size) {
        const Point2 corner(random.within(0, 10), random.within(0, 10));
        return Box2(corner, corner + Vector2(random.within(0, size), random.within(0, size)));
    };
    for (const int count : {0, 1, 8, 9, 300}) {
        std::vector<Box2> boxes;
        for (int i = 0; i < count; ++i) boxes.push_back(i % 5 == 0 ? Box2(box(0)) : box(2));
        for (const BoxOrder order : {BoxOrder::along_contours, BoxOrder::any}) {
            const BoxTree tree(boxes, order);
            for (int i = 0; i < 200; ++i) {
                const Box2 asked = box(3);
                std::vector<std::uint32_t> found, expected;
                tree.meeting(asked, [&](std::uint32_t index) { found.push_back(index); });
                std::sort(found.begin(), found.end());
                for (std::uint32_t b = 0; b < boxes.size(); ++b) {
                    if (boxes[b].intersects(asked)) expected.push_back(b);
                }
                CHECK(found == expected);
            }
        }
    }
}
