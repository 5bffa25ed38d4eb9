// Where ribs and gaps go over into walls: what fills them reaches these.

#include <doctest/doctest.h>

#include "kernel/toolpath/boundary.h"
#include "kernel/toolpath/centre_lines.h"
#include "kernel/toolpath/fills.h"
#include "kernel/toolpath/sizes.h"
#include "kernel/toolpath/walls.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

constexpr double min_width_mm = 0.2;

Contours sum(const Contours& a, const Contours& b) {
    return combined(a, b, Operation::unite, wall_allowed_mm).contours;
}

// Along the x-axis, from its middle at x = 0, leaning by an angle.
Contours bar(double from_mm, double to_mm, double rib_mm, double angle_rad = 0) {
    return lyr::testing::moved(Contours{rectangle(from_mm, -rib_mm / 2, to_mm, rib_mm / 2)},
                               Motion{angle_rad, {0, 0}});
}

// To the left of the y-axis.
Contours plate_on_left() {
    return {rectangle(-10, -10, 0, 10)};
}

struct Printed {
    Walls made;
    std::vector<Strand> thin;
};

Printed printed(const Contours& region) {
    Printed result{walls(region, {.count = 2,
                                  .width_mm = width_mm,
                                  .height_mm = height_mm,
                                  .min_width_mm = min_width_mm,
                                  .allowed_mm = wall_allowed_mm}),
                   {}};
    CHECK(result.made.unresolved == 0);
    const CentreLines lines = centre_lines(
        result.made.thin,
        {.min_width_mm = min_width_mm, .max_width_mm = 0.9, .allowed_mm = wall_allowed_mm},
        result.made.thin_joints);
    CHECK(lines.unresolved == 0);
    result.thin = lines.strands;
    return result;
}

// The bodies' outer walls, without those that fit where ribs meet.
Contours wall_of(const Walls& made) {
    constexpr double least_mm = 10;
    Contours wall;
    for (std::size_t i = 0; i < made.strands.size(); ++i)
        if (made.depths[i] == 0 && length_mm(made.strands[i].path) > least_mm)
            wall.push_back(made.strands[i].path);
    return wall;
}

std::pair<Point2, Point2> ends_of(const Strand& strand) {
    const Path& path = std::get<Path>(strand.path);
    return {path.start, path.segments.back().end};
}

// How far within a wall's flank strands end.
constexpr double overlap_mm = 0.1 * width_mm;

// How many ends lie just within the flank of a wall, and how many half a width before the outline.
struct Ends {
    int joined = 0, free = 0;
};

Ends ends_in(const Contours& region, const Printed& print) {
    const Contours wall = wall_of(print.made);
    const Boundary middle(wall), outline(region);
    Ends ends;
    constexpr double within_mm = 0.003;
    for (const Strand& strand : print.thin) {
        const auto [first, last] = ends_of(strand);
        for (const Point2& end : {first, last}) {
            if (std::abs(middle.distance_mm(end, 1) - (width_mm / 2 - overlap_mm)) <= within_mm) {
                ++ends.joined;
                continue;
            }
            // Ahead of a free end there is nothing of the part.
            const Point2& other = end == first ? last : first;
            const Point2 ahead =
                end + (strand.width_mm / 2 + within_mm) * (end - other).normalized();
            ends.free += outline.winding(ahead) == 0;
        }
    }
    return ends;
}

// What walls, the strands of thin parts and what fills gaps and the inside cover of a region around the origin, and by how much discs
// of those strands stick out of it.
void check_covered(const Contours& region, const Printed& print, double least_share = 0.99) {
    const Boundary outline(region), inside(print.made.inside), gaps(print.made.gaps);
    std::vector<std::pair<PrintedLine, double>> lines;
    double most_outside_mm = -1;
    const auto add = [&](const Strand& strand, bool is_thin) {
        Fill fill;
        fill.strands = {strand};
        std::size_t i = 0;
        for (const PrintedLine& line : lines_of(fill)) {
            const double width = strand.widths_mm.empty() ? strand.width_mm : strand.widths_mm[i++];
            lines.push_back({line, width});
            for (int k = 0; is_thin && k <= 8; ++k) {
                const Point2 point = point_at(line.start, line.segment, k / 8.0);
                most_outside_mm =
                    std::max(most_outside_mm, width / 2 - outline.distance_mm(point, 1));
                CHECK(outline.winding(point) == 1);
            }
        }
    };
    for (const Strand& strand : print.made.strands) add(strand, false);
    for (const Strand& strand : print.thin) add(strand, true);
    CHECK(most_outside_mm <= wall_allowed_mm + width_step_mm / 2);
    constexpr double grid_mm = 0.04;
    const auto box = box_of(region);
    double all = 0, covered = 0;
    for (double y = box.min().y() + grid_mm / 3; y < box.max().y(); y += grid_mm)
        for (double x = box.min().x() + grid_mm / 3; x < box.max().x(); x += grid_mm) {
            const Point2 point(x, y);
            if (point.norm() > 1 || outline.winding(point) != 1) continue;
            ++all;
            covered += inside.winding(point) == 1 || gaps.winding(point) == 1 ||
                       std::any_of(lines.begin(), lines.end(), [&](const auto& line) {
                           return distance_mm(line.first.start, line.first.segment, point) <=
                                  line.second / 2 + wall_allowed_mm;
                       });
        }
    CHECK(covered / all >= least_share);
}

// Of all thin strands, with flat ends.
double flat_mm2(const std::vector<Strand>& strands) {
    double area = 0;
    for (const Strand& strand : strands) area += length_mm(strand.path) * strand.width_mm;
    return area;
}

// A web that is as thin as that in the origin: between two round holes, a hole and the side of the plate, and two bodies.
std::vector<Contours> with_web(double web_mm) {
    constexpr double radius_mm = 1.5;
    const double y_mm = radius_mm + web_mm / 2;
    const Contours plate{rectangle(-6, -5, 6, 5)};
    const Contours above{FullCircle{{0, y_mm}, radius_mm, true}};
    const Contours below{FullCircle{{0, -y_mm}, radius_mm, true}};
    const auto less = [](const Contours& from, const Contours& part) {
        return combined(from, part, Operation::subtract, wall_allowed_mm).contours;
    };
    return {less(less(plate, above), below),
            less(Contours{rectangle(-6, -web_mm / 2, 6, 5)}, above),
            less(less(Contours{rectangle(-6, -y_mm, 6, y_mm)}, above), below)};
}

// Strands' round ends leave notches beside them, which are as much of the square millimetre or two around a crossing.
constexpr double around_ends = 0.98;

// A frame around ribs that cross, and what lies between two crossings.
struct Grille {
    Contours region;
    int ribs;
};

Grille grille(double rib_mm, double hole_mm) {
    constexpr int holes = 4;  // so that the middle is a crossing
    const double pitch_mm = rib_mm + hole_mm, first_mm = (rib_mm - holes * pitch_mm) / 2;
    const double half_mm = holes * pitch_mm / 2 + 2;
    Contours region{rectangle(-half_mm, -half_mm, half_mm, half_mm)};
    for (int i = 0; i < holes; ++i)
        for (int j = 0; j < holes; ++j) {
            const Point2 from(first_mm + i * pitch_mm, first_mm + j * pitch_mm);
            region.push_back(reversed(
                Contour(rectangle(from.x(), from.y(), from.x() + hole_mm, from.y() + hole_mm))));
        }
    return {region, 2 * holes * (holes - 1)};
}

}  // namespace

TEST_CASE(
    "joints: a thin rib on a plate is one strand from the plate's wall to half a width before its "
    "tip") {
    for (const double rib_mm : {0.25, 0.3, 0.4, 0.5, 0.55, 0.6, 0.65, 0.7})
        for (const double lean_rad : {0.0, 0.4, -0.7}) {
            CAPTURE(rib_mm);
            CAPTURE(lean_rad);
            for (const Motion& motion : rib_motions) {
                const Contours region =
                    lyr::testing::moved(sum(plate_on_left(), bar(-2, 8, rib_mm, lean_rad)), motion);
                const Printed print = printed(region);
                REQUIRE(print.thin.size() == 1);
                CHECK(std::get<Path>(print.thin[0].path).segments.size() <= 2);
                CHECK(print.thin[0].width_mm == doctest::Approx(rib_mm).epsilon(0.01));
                const Ends ends = ends_in(region, print);
                CHECK(ends.joined == 1);
                CHECK(ends.free == 1);
                CHECK(print.made.too_thin_mm2 < 0.0625);
            }
        }
}

TEST_CASE("joints: a plate with a thin rib is covered up to where they meet") {
    for (const double rib_mm : {0.3, 0.5, 0.6, 0.7})
        for (const double lean_rad : {0.0, 0.5}) {
            CAPTURE(rib_mm);
            CAPTURE(lean_rad);
            const Contours body{rectangle(-3, -2, 0, 2)};
            const Contours region = sum(body, bar(-1, 2.5, rib_mm, lean_rad));
            check_covered(region, printed(region));
        }
}

TEST_CASE("joints: a thin rib between two bodies reaches both walls") {
    const Contours bodies{rectangle(-4, -4, 0, 4), rectangle(3, -4, 7, 4)};
    for (const double rib_mm : {0.25, 0.4, 0.6, 0.7})
        for (const Motion& motion : rib_motions) {
            CAPTURE(rib_mm);
            const Contours region = lyr::testing::moved(sum(bodies, bar(-1, 4, rib_mm)), motion);
            const Printed print = printed(region);
            REQUIRE(print.thin.size() == 1);
            CHECK(ends_in(region, print).joined == 2);
            // It is no more than what the walls leave of the rib, and their corners that point into it.
            CHECK(flat_mm2(print.thin) <= (3 + overlap_mm) * rib_mm);
            CHECK(flat_mm2(print.thin) >= (3 - 2 * rib_mm - 0.1) * rib_mm);
            CHECK(std::get<Path>(print.thin[0].path).segments.size() == 1);
        }
}

TEST_CASE("joints: thin ribs that meet in a T or a cross between bodies reach their walls") {
    const Contours frame{rectangle(-6, -6, 6, 6), reversed(Contour(rectangle(-4, -4, 4, 4)))};
    for (const double rib_mm : {0.3, 0.4, 0.5, 0.65})
        for (const bool crossed : {false, true})
            for (const Motion& motion : rib_motions) {
                CAPTURE(rib_mm);
                CAPTURE(crossed);
                const Contours second = bar(crossed ? -5 : 0, 5, rib_mm, pi / 2);
                const Contours region =
                    lyr::testing::moved(sum(frame, sum(bar(-5, 5, rib_mm), second)), motion);
                const Printed print = printed(region);
                const int ribs = crossed ? 4 : 3;
                CHECK(print.thin.size() <= static_cast<std::size_t>(ribs));
                CHECK(ends_in(region, print).joined == ribs);
                CHECK(flat_mm2(print.thin) <= (4 + overlap_mm) * ribs * rib_mm);
            }
}

TEST_CASE("joints: a gap between walls that widens is filled up to the walls inside of it") {
    // Between the walls of the neck there is a gap, in the bodies there are walls.
    const double spacing_mm = width_mm - height_mm * (1 - pi / 4);
    const Contours bodies{rectangle(-6, -4, 0, 4), rectangle(5, -4, 11, 4)};
    for (const double gap_mm : {0.15, 0.3, 0.5})
        for (const Motion& motion : rib_motions) {
            CAPTURE(gap_mm);
            const Contours region = lyr::testing::moved(
                sum(bodies, bar(-1, 6, width_mm + spacing_mm + gap_mm)), motion);
            const Printed print = printed(region);
            CHECK(print.thin.empty());
            REQUIRE(!print.made.gaps.empty());
            const CentreLines lines = centre_lines(
                print.made.gaps,
                {.min_width_mm = 0.1, .max_width_mm = 0.9, .allowed_mm = wall_allowed_mm},
                print.made.gap_joints);
            REQUIRE(lines.strands.size() == 1);
            Contours inner;
            for (std::size_t i = 0; i < print.made.strands.size(); ++i)
                if (print.made.depths[i] == 1) inner.push_back(print.made.strands[i].path);
            REQUIRE(inner.size() == 2);
            const auto [first, last] = ends_of(lines.strands[0]);
            for (const Point2& end : {first, last})
                CHECK(Boundary(inner).distance_mm(end, 1) ==
                      doctest::Approx(spacing_mm / 2 - overlap_mm).epsilon(0.02));
        }
}

TEST_CASE("joints: ribs hardly longer than wide are joined to the body that they are on") {
    for (const double rib_mm : {0.25, 0.3, 0.4}) {
        CAPTURE(rib_mm);
        Contours comb = plate_on_left();
        constexpr int teeth = 7;
        for (int i = 0; i < teeth; ++i)
            comb = sum(comb, lyr::testing::moved(bar(-1, 0.7, rib_mm), {0, {0, 2.5 * i - 8}}));
        for (const Motion& motion : rib_motions) {
            const Contours region = lyr::testing::moved(comb, motion);
            const Printed print = printed(region);
            CHECK(print.thin.size() == teeth);
            CHECK(ends_in(region, print).joined == teeth);
        }
    }
}

TEST_CASE("joints: webs of 0.2 to 0.45 mm were lost where the walls run around both holes") {
    for (const double web_mm : {0.2, 0.22, 0.3, 0.35, 0.4, 0.43})
        for (const Motion& motion : rib_motions) {
            CAPTURE(web_mm);
            for (const Contours& shape : with_web(web_mm)) {
                const Contours region = lyr::testing::moved(shape, motion);
                const Printed print = printed(region);
                REQUIRE(print.thin.size() == 1);
                CHECK(ends_in(region, print).joined == 2);
                CHECK(!print.made.lost_web);
            }
        }
    for (const double web_mm : {0.22, 0.3, 0.4})
        for (const Contours& region : with_web(web_mm))
            check_covered(region, printed(region), around_ends);
}

TEST_CASE("joints: webs of a line to two, whose walls are cut off each other, had open ends") {
    for (const double web_mm :
         {0.46, 0.47, 0.49, 0.52, 0.56, 0.6, 0.64, 0.66, 0.68, 0.69, 0.7, 0.72, 0.74, 0.76})
        for (const Motion& motion : rib_motions) {
            CAPTURE(web_mm);
            for (const Contours& shape : with_web(web_mm)) {
                const Printed print = printed(lyr::testing::moved(shape, motion));
                std::vector<Strand> strands = print.made.strands;
                strands.insert(strands.end(), print.thin.begin(), print.thin.end());
                // Along its middle, as far as the web is no wider than two lines.
                for (double x_mm = -0.4; x_mm < 0.41; x_mm += 0.05) {
                    CAPTURE(x_mm);
                    const Point2 point = motion({x_mm, 0});
                    CHECK(std::any_of(strands.begin(), strands.end(), [&](const Strand& strand) {
                        const double width =
                            strand.widths_mm.empty() ? strand.width_mm : strand.widths_mm.front();
                        return Boundary({&strand.path, 1}).is_near(point, width / 2);
                    }));
                }
            }
        }
}

TEST_CASE("joints: webs thinner than the least width were lost without a word") {
    for (const double web_mm : {0.05, 0.1, 0.15, 0.18})
        for (const Motion& motion : rib_motions) {
            CAPTURE(web_mm);
            for (const Contours& shape : with_web(web_mm)) {
                const Printed print = printed(lyr::testing::moved(shape, motion));
                REQUIRE(print.made.lost_web);
                CHECK((*print.made.lost_web - motion({0, 0})).norm() < 0.4);
            }
        }
}

TEST_CASE("joints: ribs of grilles were crumbs where the corners of walls shot into them") {
    for (const double rib_mm : {0.5, 0.6, 0.65, 0.7, 0.75})
        for (const double hole_mm : {1.0, 1.7, 3.0}) {
            CAPTURE(rib_mm);
            CAPTURE(hole_mm);
            const Grille shape = grille(rib_mm, hole_mm);
            // Walls around a crossing reach so far into its ribs.
            constexpr double most_mm = 0.35;
            for (const Motion& motion : {Motion{}, Motion{0.3, {1, 2}, true}}) {
                const Printed print = printed(lyr::testing::moved(shape.region, motion));
                // A strand runs through a crossing, or one ends on each side of it.
                CHECK(print.thin.size() <= static_cast<std::size_t>(shape.ribs));
                double length = 0;
                for (const Strand& strand : print.thin) {
                    length += length_mm(strand.path);
                    CHECK(length_mm(strand.path) > hole_mm - 2 * most_mm);
                    CHECK(strand.width_mm <= 1.1 * rib_mm);
                }
                CHECK(length > shape.ribs * (hole_mm - 2 * most_mm));
                CHECK(print.made.too_thin_mm2 < 0.0625);
                CHECK(!print.made.lost_web);
            }
            check_covered(shape.region, printed(shape.region), around_ends);
        }
}
