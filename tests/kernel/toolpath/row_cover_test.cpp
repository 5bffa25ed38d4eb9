#include "kernel/toolpath/row_cover.h"

#include <doctest/doctest.h>

#include "kernel/region/regions.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

constexpr double pitch_mm = 0.01;

double area_of(const RowCover& rows) {
    return rows.length_mm() * pitch_mm;
}

}  // namespace

TEST_CASE(
    "row cover 2: differences, unions and intersections have the areas that those of regions "
    "have") {
    Random random(5);
    for (int i = 0; i < 30; ++i) {
        const Contours a = random_region(random, {random.within(-3, 3), random.within(-3, 3)}, 5);
        const Contours b = random_region(random, {random.within(-3, 3), random.within(-8, 8)}, 5);
        const RowCover rows_a(a, pitch_mm), rows_b(b, pitch_mm);
        const auto area = [&](Operation operation) {
            return total_area(combined(a, b, operation, 1e-4).contours);
        };
        CHECK(area_of(rows_a.without(rows_b)) ==
              doctest::Approx(area(Operation::subtract)).epsilon(1e-3));
        CHECK(area_of(rows_a.with(rows_b)) ==
              doctest::Approx(area(Operation::unite)).epsilon(1e-3));
        CHECK(area_of(rows_a.common(rows_b)) ==
              doctest::Approx(area(Operation::intersect)).epsilon(1e-3));
        CHECK(rows_a.common(RowCover()).empty());
        CHECK(rows_a.without(rows_a).empty());
        CHECK(rows_a.without(RowCover()).length_mm() == rows_a.length_mm());
        CHECK(rows_a.with(rows_a).length_mm() == doctest::Approx(rows_a.length_mm()));
    }
}

TEST_CASE("row cover 3: a disc has an interval as long as stated wherever it lies") {
    Random random(6);
    for (int i = 0; i < 1000; ++i) {
        const double pitch = random.within(0.1, 1), diameter = pitch * random.within(1, 4);
        const Contours disc{
            FullCircle{{random.within(-5, 5), random.within(-5, 5)}, diameter / 2, true}};
        const double least = std::sqrt(diameter * diameter - pitch * pitch);
        CHECK(RowCover(disc, pitch).longest_mm() >= least * (1 - 1e-9));
    }
}

TEST_CASE(
    "row cover 4: neighbouring rows share an interval in a wide disc, and none in a narrow strip") {
    Random random(7);
    for (int i = 0; i < 1000; ++i) {
        const double pitch = random.within(0.1, 1), diameter = pitch * random.within(2, 4);
        const Contours disc{
            FullCircle{{random.within(-5, 5), random.within(-5, 5)}, diameter / 2, true}};
        const double least = std::sqrt(diameter * diameter - 4 * pitch * pitch);
        CHECK(RowCover(disc, pitch).longest_pair_mm() >= least * (1 - 1e-9) - 1e-12);
        const double y = random.within(-5, 5);
        const Contours strip{rectangle(-9, y, 9, y + 0.99 * pitch)};
        CHECK(RowCover(strip, pitch).longest_pair_mm() == 0);
    }
}
