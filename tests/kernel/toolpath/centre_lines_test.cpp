#include "kernel/toolpath/centre_lines.h"

#include <doctest/doctest.h>

#include <limits>

#include "kernel/toolpath/boundary.h"
#include "kernel/toolpath/fills.h"
#include "kernel/toolpath/middle_path.h"
#include "kernel/toolpath/offset.h"
#include "kernel/toolpath/sizes.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

CentreLines lines_in(const Contours& region) {
    return centre_lines(region,
                        {.min_width_mm = 0.2, .max_width_mm = 0.9, .allowed_mm = wall_allowed_mm});
}

Contours moved_region(const Contours& region, const Motion& motion) {
    return lyr::testing::moved(region, motion);
}

Path polygon(std::vector<Point2> corners) {
    Path path{corners[0], {}};
    for (std::size_t i = 1; i < corners.size(); ++i) path.segments.push_back({corners[i]});
    path.segments.push_back({corners[0]});
    return path;
}

struct PrintedPart {
    Point2 start;
    Segment segment;
    double width_mm;
};

std::vector<PrintedPart> parts_of(const Strand& strand) {
    Fill fill;
    fill.strands = {strand};
    std::vector<PrintedPart> parts;
    for (const PrintedLine& line : lines_of(fill)) {
        const double width =
            strand.widths_mm.empty() ? strand.width_mm : strand.widths_mm[parts.size()];
        parts.push_back({line.start, line.segment, width});
    }
    return parts;
}

// With round ends.
double printed_mm2(const CentreLines& made) {
    double area = 0;
    for (const Strand& strand : made.strands) {
        const std::vector<PrintedPart> parts = parts_of(strand);
        for (const PrintedPart& part : parts)
            area += lyr::length_mm(part.start, part.segment) * part.width_mm;
        if (is_closed(strand)) continue;
        for (const double width : {parts.front().width_mm, parts.back().width_mm})
            area += pi / 8 * width * width;
    }
    return area;
}

// By how much discs of the strands' widths stick out of the region.
double outside_mm(const Contours& region, const CentreLines& made) {
    double most = -1;
    const Boundary boundary(region);
    for (const Strand& strand : made.strands)
        for (const PrintedPart& part : parts_of(strand))
            for (int i = 0; i <= 8; ++i) {
                const Point2 point = point_at(part.start, part.segment, i / 8.0);
                const double distance = boundary.distance_mm(point, 1);
                const double depth = boundary.winding(point) == 1 ? distance : -distance;
                most = std::max(most, part.width_mm / 2 - depth);
            }
    return most;
}

double distance_mm(const PrintedPart& part, const Point2& point) {
    return lyr::distance_mm(part.start, part.segment, point);
}

// What strands cover of a region, on a grid.
double covered_share(const Contours& region, const CentreLines& made) {
    constexpr double grid_mm = 0.06;
    std::vector<PrintedPart> parts;
    for (const Strand& strand : made.strands)
        for (const PrintedPart& part : parts_of(strand)) parts.push_back(part);
    const Boundary boundary(region);
    const auto box = box_of(region);
    double all = 0, covered = 0;
    for (double y = box.min().y() + grid_mm / 3; y < box.max().y(); y += grid_mm)
        for (double x = box.min().x() + grid_mm / 3; x < box.max().x(); x += grid_mm) {
            const Point2 point(x, y);
            if (boundary.winding(point) != 1) continue;
            ++all;
            covered += std::any_of(parts.begin(), parts.end(), [&](const PrintedPart& part) {
                return distance_mm(part, point) <= part.width_mm / 2 + wall_allowed_mm;
            });
        }
    return covered / all;
}

void check_fills(const Contours& region, double least_share) {
    const CentreLines made = lines_in(region);
    CHECK(made.unresolved == 0);
    const double area = total_area(region);
    CHECK(printed_mm2(made) + made.left_out_mm2 + made.beside_mm2 ==
          doctest::Approx(area).epsilon(0.03));
    CHECK(outside_mm(region, made) <= wall_allowed_mm + width_step_mm / 2);
    CHECK(covered_share(region, made) + made.left_out_mm2 / area >= least_share);
}

// A rib of which one end lies at the origin.
Contours rib(double angle_rad, double length_mm, double width_mm) {
    return lyr::testing::moved(
        Contours{rectangle(-width_mm / 2, -width_mm / 2, length_mm, width_mm / 2)},
        Motion{angle_rad});
}

Contours star(std::span<const double> angles_rad, double width_mm) {
    std::vector<Contours> ribs;
    for (const double angle : angles_rad) ribs.push_back(rib(angle, 8, width_mm));
    return unite_all(ribs, wall_allowed_mm).contours;
}

}  // namespace

TEST_CASE("centre lines 2: a rib with parallel sides is one line of its width") {
    for (const Motion& motion : rib_motions)
        for (const double width : {0.25, 0.6, 0.85}) {
            const Contours region = moved_region({rectangle(0, 0, 20, width)}, motion);
            const CentreLines made = lines_in(region);
            CHECK(made.unresolved == 0);
            CHECK(made.left_out_mm2 == doctest::Approx(0));
            REQUIRE(made.strands.size() == 1);
            CHECK(made.strands[0].widths_mm.empty());
            CHECK(made.strands[0].width_mm == doctest::Approx(width));
            const Path& path = std::get<Path>(made.strands[0].path);
            REQUIRE(path.segments.size() == 1);
            CHECK(path.segments[0].sagitta_mm == 0);
            CHECK((path.segments[0].end - path.start).norm() == doctest::Approx(20 - width));
        }
}

TEST_CASE("centre lines 2: a rib is one line also where its sides are cut into many segments") {
    std::vector<Point2> corners;
    for (int i = 0; i <= 10; ++i) corners.push_back({2.0 * i, 0});
    for (int i = 10; i >= 0; --i)
        corners.push_back({i == 0 || i == 10 ? 2.0 * i : 2 * i + 0.3, 0.6});
    for (const Motion& motion : rib_motions) {
        const CentreLines made = lines_in(moved_region({polygon(corners)}, motion));
        CHECK(made.unresolved == 0);
        REQUIRE(made.strands.size() == 1);
        CHECK(std::get<Path>(made.strands[0].path).segments.size() == 1);
        CHECK(made.strands[0].width_mm == doctest::Approx(0.6));
    }
}

TEST_CASE("centre lines 2: between two circles about one centre runs a third") {
    for (const auto& [outer, inner] : {std::pair(10.0, 9.4), {1.0, 0.45}, {0.5, 0.1}}) {
        const Contours region{FullCircle{{3, 4}, outer, true}, FullCircle{{3, 4}, inner, false}};
        for (const Contours& tube : {region, Contours{region[1], region[0]}}) {
            const CentreLines made = lines_in(tube);
            CHECK(made.unresolved == 0);
            REQUIRE(made.strands.size() == 1);
            const auto* circle = std::get_if<FullCircle>(&made.strands[0].path);
            REQUIRE(circle);
            CHECK((circle->centre - Point2(3, 4)).norm() < 1e-9);
            CHECK(circle->radius_mm == doctest::Approx((outer + inner) / 2).epsilon(1e-10));
            CHECK(made.strands[0].widths_mm.empty());
            CHECK(made.strands[0].width_mm == doctest::Approx(outer - inner));
        }
    }
}

TEST_CASE("centre lines 2: a bent rib is lines and an arc about the bend's centre") {
    Path bent{{0, 0}, {}};
    bent.segments = {
        {{10, 0}},   arc_with_sweep({10, 0}, {13, 3}, pi / 2),      {{13, 9}},  {{12.4, 9}},
        {{12.4, 3}}, arc_with_sweep({12.4, 3}, {10, 0.6}, -pi / 2), {{0, 0.6}}, {{0, 0}}};
    for (const Motion& motion : rib_motions) {
        const Contours region = moved_region({bent}, motion);
        const CentreLines made = lines_in(region);
        CHECK(made.unresolved == 0);
        REQUIRE(made.strands.size() == 1);
        CHECK(made.strands[0].widths_mm.empty());
        CHECK(made.strands[0].width_mm == doctest::Approx(0.6));
        const Path& path = std::get<Path>(made.strands[0].path);
        REQUIRE(path.segments.size() == 3);
        const auto circle = circle_of(path.segments[0].end, path.segments[1]);
        REQUIRE(circle);
        CHECK(circle->radius_mm == doctest::Approx(2.7));
        CHECK((circle->centre - motion({10, 3})).norm() < 1e-6);
    }
}

TEST_CASE("centre lines 3: a slot's line ends in the centres of its round ends") {
    const CentreLines made = lines_in({slot(0, 0, 10, 0.6)});
    REQUIRE(made.strands.size() == 1);
    const Path& path = std::get<Path>(made.strands[0].path);
    REQUIRE(path.segments.size() == 1);
    const double first = std::min(path.start.x(), path.segments[0].end.x());
    CHECK(first == doctest::Approx(0));
    CHECK(printed_mm2(made) == doctest::Approx(total_area({slot(0, 0, 10, 0.6)})));
}

TEST_CASE("centre lines 2: along a wedge widths are right within the step") {
    const Contours wedge{polygon({{0, 0}, {20, 0.15}, {20, 0.45}, {0, 0.6}})};
    for (const Motion& motion : rib_motions) {
        const Contours region = moved_region(wedge, motion);
        const CentreLines made = lines_in(region);
        REQUIRE(made.strands.size() == 1);
        REQUIRE(made.strands[0].widths_mm.size() ==
                std::get<Path>(made.strands[0].path).segments.size());
        const Boundary boundary(region);
        for (const PrintedPart& part : parts_of(made.strands[0]))
            for (const double at : {0.0, 0.5, 1.0}) {
                const double width =
                    2 * boundary.distance_mm(point_at(part.start, part.segment, at), 1);
                CHECK(std::abs(part.width_mm - width) <= width_step_mm / 2 + wall_allowed_mm);
            }
        CHECK(printed_mm2(made) == doctest::Approx(9).epsilon(0.02));
    }
}

TEST_CASE("centre lines: ribs, rings and what they meet in are filled and not left") {
    const Contours shapes[] = {
        {polygon({{0, 0}, {20, 0.15}, {20, 0.45}, {0, 0.6}})},
        {FullCircle{{0, 0}, 8, true}, FullCircle{{0.1, 0.05}, 7.4, false}},
        {rectangle(0, 0, 14, 9), reversed(Contour(rectangle(0.6, 0.6, 13.4, 8.4)))},
        {slot(0, 0, 12, 5), reversed(Contour(slot(0, 0.5, 12, 4.5)))},
        star(std::array{0.0, pi / 2, pi}, 0.6),
        star(std::array{0.0, 2 * pi / 3, 4 * pi / 3}, 0.6),
        star(std::array{0.0, pi / 2, pi, 3 * pi / 2}, 0.6),
        star(std::array{0.2, 1.5, 2.5, 4.0, 5.1}, 0.45),
    };
    for (const Contours& shape : shapes)
        for (const Motion& motion : {rib_motions[0], rib_motions[2]})
            check_fills(moved_region(shape, motion), 0.97);
}

TEST_CASE("centre lines: a C of arcs and a gap between an arc and a line are filled") {
    const Point2 a(8, 0), b(0, -8), c(0, -7.5), d(7.5, 0);
    Path c_shape{a,
                 {arc_with_sweep(a, b, 3 * pi / 2), {c}, arc_with_sweep(c, d, -3 * pi / 2), {a}}};
    Path cap{{-5, 0}, {{{5, 0}}, {{5, 0.3}}, {{-5, 0.3}, 0.4}, {{-5, 0}}}};
    for (const Motion& motion : rib_motions) {
        const Contours region = moved_region({c_shape}, motion);
        check_fills(region, 0.97);
        const CentreLines made = lines_in(region);
        REQUIRE(made.strands.size() == 1);
        CHECK(std::get<Path>(made.strands[0].path).segments.size() == 1);
        check_fills(moved_region({cap}, motion), 0.95);
    }
}

TEST_CASE("centre lines 3: where three ribs meet one strand runs through and one ends beside it") {
    const CentreLines made = lines_in(star(std::array{0.0, pi / 2, pi}, 0.6));
    REQUIRE(made.strands.size() == 2);
    double lengths[] = {length_mm(made.strands[0].path), length_mm(made.strands[1].path)};
    std::sort(std::begin(lengths), std::end(lengths));
    CHECK(lengths[0] == doctest::Approx(8 - 0.3 - 0.3).epsilon(0.02));
    CHECK(lengths[1] == doctest::Approx(16 - 0.6).epsilon(0.02));
}

TEST_CASE("centre lines: random ribs that meet, and random frames") {
    for (unsigned seed = 0; seed < 60; ++seed) {
        CAPTURE(seed);
        Random random(seed);
        std::vector<Contours> ribs;
        const int count = random.whole(2, 6);
        for (int i = 0; i < count; ++i)
            ribs.push_back(rib(2 * pi * (i + random.within(0, 0.4)) / count, random.within(3, 6),
                               random.within(0.3, 0.7)));
        check_fills(unite_all(ribs, wall_allowed_mm).contours, 0.96);
    }
    for (unsigned seed = 0; seed < 40; ++seed) {
        CAPTURE(seed);
        Random random(seed);
        const Path ring = random_ring(random, {0, 0}, 5);
        const OffsetResult inner = offset(Contours{ring}, {.distance_mm = -random.within(0.3, 0.8),
                                                           .allowed_mm = wall_allowed_mm});
        Contours frame{ring};
        for (const Contour& contour : inner.contours) frame.push_back(reversed(contour));
        check_fills(frame, 0.97);
    }
}

TEST_CASE("centre lines 4: what is narrower than the least width is left out and counted") {
    const CentreLines thin = lines_in({rectangle(0, 0, 10, 0.15)});
    CHECK(thin.strands.empty());
    CHECK(thin.left_out_mm2 == doctest::Approx(1.5).epsilon(0.03));
    const Contours spike{polygon({{0, 0}, {10, 0}, {0, 0.6}})};
    const CentreLines made = lines_in(spike);
    CHECK(made.strands.size() == 1);
    CHECK(made.left_out_mm2 == doctest::Approx(10.0 / 3 * 0.2 / 2).epsilon(0.05));
    for (const PrintedPart& part : parts_of(made.strands[0])) CHECK(part.width_mm >= 0.19);
}

TEST_CASE("centre lines 4: what is wider than the greatest width is filled in the middle") {
    const CentreLines made = lines_in({rectangle(0, 0, 20, 1.5)});
    REQUIRE(made.strands.size() == 1);
    CHECK(made.strands[0].width_mm == doctest::Approx(0.9));
    CHECK(made.beside_mm2 == doctest::Approx(18.5 * 0.6));
}

TEST_CASE("centre lines 4: nothing of a region is lost without a count") {
    for (unsigned seed = 0; seed < 20; ++seed) {
        Random random(seed);
        const Contours region{random_ring(random, {0, 0}, random.within(0.2, 0.6))};
        const CentreLines made = lines_in(region);
        CHECK(made.unresolved == 0);
        CHECK(printed_mm2(made) + made.left_out_mm2 + made.beside_mm2 + made.corners_mm2 ==
              doctest::Approx(total_area(region)).epsilon(0.03));
    }
}

TEST_CASE("centre lines 5: a part that is no longer than wide gets a short strand") {
    for (const Contours& region :
         {Contours{FullCircle{{1, 2}, 0.3, true}}, Contours{rectangle(0, 0, 0.6, 0.6)},
          Contours{slot(0, 0, 1e-7, 0.6)}}) {
        const CentreLines made = lines_in(region);
        REQUIRE(made.strands.size() == 1);
        CHECK(made.strands[0].width_mm == doctest::Approx(0.3));
        CHECK(outside_mm(region, made) <= wall_allowed_mm);
    }
    const CentreLines small = lines_in({FullCircle{{1, 2}, 0.109, true}});
    CHECK(small.strands.empty());
    CHECK(small.left_out_mm2 == doctest::Approx(pi * 0.109 * 0.109));
    const CentreLines least = lines_in({FullCircle{{1, 2}, 0.111, true}});
    REQUIRE(least.strands.size() == 1);
    CHECK(least.strands[0].width_mm == 0.2);
}

TEST_CASE("centre lines 6: nothing comes of nothing, and what is invalid is counted") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(centre_lines({}, {.allowed_mm = wall_allowed_mm}).strands.empty());
    CHECK(centre_lines({}, {.allowed_mm = wall_allowed_mm}).unresolved == 0);
    CHECK(lines_in({rectangle(0, 0, nan, 1)}).unresolved == 1);
    CHECK(lines_in({FullCircle{{0, 0}, -1, true}}).unresolved == 1);
    const Contours plate{rectangle(0, 0, 10, 0.5)};
    CHECK(centre_lines(plate, {.min_width_mm = 0}).unresolved == 1);
    CHECK(centre_lines(plate, {.min_width_mm = 1, .max_width_mm = 0.5}).unresolved == 1);
    CHECK(centre_lines(plate, {.allowed_mm = nan}).unresolved == 1);
    CHECK(lines_in({Path{{0, 0}, {}}}).strands.empty());
    CHECK(lines_in({Path{{1, 1}, {{{1, 1}}}}}).strands.empty());
}

TEST_CASE("centre lines 6: contours that cross themselves come to an end and are counted") {
    std::size_t unresolved = 0;
    for (unsigned seed = 500; seed < 520; ++seed) {
        Random random(seed);
        Path path{{random.within(0, 2), random.within(0, 2)}, {}};
        for (int i = 0; i < 7; ++i)
            path.segments.push_back({{random.within(0, 2), random.within(0, 2)},
                                     random.coin() ? 0 : random.within(-1, 1)});
        path.segments.push_back({path.start});
        const CentreLines made = lines_in({path});
        unresolved += made.unresolved;
        for (const Strand& strand : made.strands) CHECK(std::isfinite(strand.width_mm));
    }
    CHECK(unresolved > 10);
}

TEST_CASE(
    "centre lines: discs that touch almost along a whole arc, or an almost straight one, find an "
    "end") {
    const Contours almost_disc{
        Path{{2.5137660985885741, 8.687516938256433},
             {{{2.5206935882597326, 8.6881799205693184}, -5.3514086774113067e-06},
              {{2.5206935882597254, 9.1351259449334226}, 0.20373549133446081},
              {{2.5137660985885768, 9.1357889272463062}, -5.3514086773957517e-06},
              {{2.5000000000000009, 9.1371491293772902}},
              {{2.4862339014114254, 9.1357889272463062}},
              {{2.4793064117402781, 9.1351259449334226}, -5.351408677393696e-06},
              {{2.4793064117402785, 8.6881799205693166}, 0.20373549133446114},
              {{2.486233901411397, 8.6875169382564348}, -5.3514086773494749e-06},
              {{2.4999999999999858, 8.686156736125449}},
              {{2.5137660985885741, 8.687516938256433}}}}};
    const Contours flat_side{
        Path{{1.5714601836602546, 0.42853981636606042},
             {{{1.571460183660256, 1.1662178270621029}},
              {{1.3711263675140897, 0.81923009187095208}, 5.7867986694366202e-07},
              {{1.1265611159465698, 0.62407957334490516}, -0.029575868536048482},
              {{1.1560933836621261, 0.42853981636606042}, 0.08506640863496788},
              {{1.5714601836602546, 0.42853981636606042}}}}};
    for (const Contours& shape : {almost_disc, flat_side})
        for (const Motion& motion : rib_motions) {
            const Contours region = moved_region(shape, motion);
            const CentreLines made = lines_in(region);
            CHECK(made.unresolved == 0);
            CHECK(made.strands.size() >= 1);
            CHECK(outside_mm(region, made) <= wall_allowed_mm + width_step_mm / 2);
        }
}

TEST_CASE("centre lines: a ring whose outside steps by nanometres where it starts is a ring") {
    const Contours ring{Path{{43.999886933064261, 18.967193254176603},
                             {{{43.999886933104193, 69.032806733170901}, 25.032270641976272},
                              {{43.999879749557437, 69.032806733324762}},
                              {{43.999872566010673, 69.032806733098099}},
                              {{43.99987256597074, 18.967193254249405}, 25.032016961409841},
                              {{43.999879749517504, 18.96719325402276}},
                              {{43.999886933064261, 18.967193254176603}}}},
                        FullCircle{{43.99999999991843, 44}, 23.354701094848604, false}};
    const CentreLines made =
        centre_lines(ring, {.min_width_mm = 0.5, .max_width_mm = 2, .allowed_mm = wall_allowed_mm});
    CHECK(made.unresolved == 0);
    REQUIRE(made.strands.size() == 1);
    CHECK(is_closed(made.strands[0]));
}

TEST_CASE("centre lines: regions in one call come out as each by itself") {
    const Contours one{rectangle(0, 0, 10, 0.5)}, other{slot(0, 3, 9, 3.7)};
    const CentreLines both = lines_in({one[0], other[0]});
    REQUIRE(both.strands.size() == 2);
    CHECK(both.strands[0].path == lines_in(one).strands[0].path);
    CHECK(both.strands[1].path == lines_in(other).strands[0].path);
}

TEST_CASE("middle path: through points that run to and fro goes no circle of the size of a house") {
    for (const double bend_mm : {0.0, 1e-6, 1e-5, -1e-5, 1e-4}) {
        CAPTURE(bend_mm);
        Stations stations(1);
        const std::vector<Point2> points{{0, 0}, {1, bend_mm}, {0.8, 2 * bend_mm}};
        double at_mm = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (i > 0) at_mm += (points[i] - points[i - 1]).norm();
            const Vector2 tangent = i + 1 < points.size() ? Vector2(points[i + 1] - points[i])
                                                          : Vector2(points[i] - points[i - 1]);
            MedialPoint point{};
            point.centre = points[i];
            point.tangent = tangent.normalized();
            point.radius_mm = 0.2 + 0.05 * static_cast<double>(i);
            stations[0].push_back({point, at_mm, at_mm});
        }
        const Strand strand = strand_along(stations, false, {0.8, 0.02}, wall_allowed_mm);
        CHECK(length_mm(strand.path) < 1.2 * at_mm);
        for (const Segment& segment : std::get<Path>(strand.path).segments)
            CHECK(segment.end.norm() < 1.1);
    }
}
