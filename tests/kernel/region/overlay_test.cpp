// Several regions of the same operands, by where points are.

#include <doctest/doctest.h>

#include "kernel/region/regions.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

constexpr double allowed_mm = 1e-4;

Membership membership(const std::vector<Contours>& operands, const Point2& point) {
    Membership result = 0;
    for (std::size_t i = 0; i < operands.size(); ++i) {
        if (winding(operands[i], point) > 0) result |= Membership{1} << i;
    }
    return result;
}

bool is_near_any(const std::vector<Contours>& operands, const Point2& point) {
    return std::any_of(operands.begin(), operands.end(), [&](const Contours& operand) {
        return distance_to(operand, point) < 2 * allowed_mm;
    });
}

std::vector<Contours> random_operands(Random& random, std::size_t count) {
    std::vector<Contours> operands;
    for (std::size_t i = 0; i < count; ++i) {
        operands.push_back(random_region(random, {random.within(-4, 4), random.within(-4, 4)}, 10));
    }
    return operands;
}

}  // namespace

TEST_CASE("overlaid: a point is in the results whose membership it has, of up to eight operands") {
    Random random(7);
    const std::vector<Wanted> wanted{[](Membership m) { return m == 1; },
                                     [](Membership m) { return (m & 3) == 3; },
                                     [](Membership m) { return (m >> 2) != 0; }};
    for (std::size_t count = 1; count <= most_operands; ++count) {
        const std::vector<Contours> operands = random_operands(random, count);
        const std::vector<Region> regions(operands.begin(), operands.end());
        const auto results = overlaid(regions, wanted, allowed_mm);
        REQUIRE(results.has_value());
        for (int i = 0; i < 300; ++i) {
            const Point2 point(random.within(-14, 14), random.within(-14, 14));
            if (is_near_any(operands, point)) continue;
            const Membership in = membership(operands, point);
            for (std::size_t k = 0; k < wanted.size(); ++k)
                CHECK(winding((*results)[k].contours, point) == (wanted[k](in) ? 1 : 0));
        }
    }
}

TEST_CASE("overlaid: what divides the plane has areas that add up") {
    Random random(8);
    for (int i = 0; i < 20; ++i) {
        const std::vector<Contours> operands = random_operands(random, 4);
        std::vector<Wanted> wanted;
        for (Membership in = 1; in < 8; ++in)
            wanted.push_back([in](Membership m) { return (m & 7) == in; });
        wanted.push_back([](Membership m) { return (m & 7) != 0; });
        const auto results =
            overlaid(std::vector<Region>(operands.begin(), operands.end()), wanted, allowed_mm);
        REQUIRE(results.has_value());
        double area = 0;
        for (std::size_t k = 0; k + 1 < wanted.size(); ++k)
            area += total_area((*results)[k].contours);
        // Off by slivers at most.
        CHECK(area == doctest::Approx(total_area(results->back().contours)).epsilon(1e-5));
    }
}

TEST_CASE(
    "overlaid: an operand that is another's is cut out of it, one that winds backwards is none") {
    const Contours plate{rectangle(0, 0, 10, 10)}, hole{reversed(rectangle(2, 2, 4, 4))};
    const auto results = overlaid(std::vector<Region>{plate, plate, hole},
                                  std::vector<Wanted>{[](Membership m) { return m == 3; },
                                                      [](Membership m) { return m == 1; },
                                                      [](Membership m) { return (m & 4) != 0; }},
                                  allowed_mm);
    REQUIRE(results.has_value());
    CHECK((*results)[0].contours == plate);
    CHECK((*results)[1].contours.empty());
    CHECK((*results)[2].contours.empty());
}

TEST_CASE("overlaid: too many operands and numbers that are not finite have no result") {
    const Contours plate{rectangle(0, 0, 10, 10)}, broken{FullCircle{{0, 0}, NAN, true}};
    const std::vector<Wanted> any{[](Membership m) { return m != 0; }};
    CHECK(!overlaid(std::vector<Region>(most_operands + 1, plate), any, allowed_mm));
    CHECK(!overlaid(std::vector<Region>{plate, broken}, any, allowed_mm));
    CHECK(overlaid({}, any, allowed_mm)->front().contours.empty());
}
