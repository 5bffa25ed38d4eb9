// Infill by what must hold for every pattern: its volume, and that it stays inside.

#include "kernel/toolpath/infill.h"

#include <doctest/doctest.h>

#include "kernel/region/regions.h"
#include "kernel/toolpath/fills.h"
#include "kernel/toolpath/offset.h"
#include "kernel/toolpath/sizes.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

constexpr double stray_mm = infill_allowed_mm + width_mm / 20;

constexpr InfillPattern patterns[] = {InfillPattern::rectilinear, InfillPattern::aligned,
                                      InfillPattern::grid,        InfillPattern::triangles,
                                      InfillPattern::cubic,       InfillPattern::concentric};

InfillRequest request(InfillPattern pattern, double density, double angle_rad = pi / 4,
                      std::size_t layer = 0) {
    return {.pattern = pattern,
            .density = density,
            .width_mm = width_mm,
            .height_mm = height_mm,
            .angle_rad = angle_rad,
            .z_mm = (static_cast<double>(layer) + 0.5) * height_mm,
            .layer = layer,
            .allowed_mm = infill_allowed_mm};
}

std::size_t pieces(const Fill& fill) {
    return fill.runs.size() + fill.strands.size();
}

// How far what is printed leaves the region, links and all.
void check_inside(const Contours& region, const Fill& fill, double link_mm = stray_mm) {
    const Boundary boundary(region);
    constexpr double step_mm = 0.3;
    for (const PrintedLine& line : lines_of(fill)) {
        const double length = lyr::length_mm(line.start, line.segment);
        const int steps = 2 + static_cast<int>(length / step_mm);
        const double within = line.is_link ? link_mm : infill_allowed_mm;
        double worst = 0;
        for (int i = 0; i <= steps; ++i) {
            const Point2 at = point_at(line.start, line.segment, static_cast<double>(i) / steps);
            if (boundary.winding(at) <= 0)
                worst = std::max(worst, boundary.distance_mm(at, 10 * stray_mm));
        }
        CHECK(worst <= within);
    }
}

// A plate with arcs, holes, a slit and a neck that is narrower than sparse lines are apart.
Contours plate_with_neck() {
    Path outline{{-20, -10}, {}};
    const auto line = [&](double x, double y) { outline.segments.push_back({{x, y}}); };
    line(12, -10);
    outline.segments.push_back(arc_with_sweep({12, -10}, {20, -2}, pi / 2));
    line(20, 3);
    line(32, 3);
    line(32, -6);
    line(40, -6);
    line(40, 10);
    line(32, 10);
    line(32, 4);
    line(20, 4);
    line(20, 10);
    outline.segments.push_back(arc_with_sweep({20, 10}, {6, 10}, -0.7 * pi));
    line(-20, 10);
    line(-20, -10);
    return {outline, FullCircle{{-12, 1}, 4, false}, FullCircle{{-3, -5}, 1.2, false},
            reversed(slot(4, -4.2, 9, -3.9))};
}

}  // namespace

TEST_CASE("infill 1: the volume is density times area times height, whatever the pattern") {
    const Contours square{rectangle(-200, -200, 200, 200)};
    const double area = total_area(square), spacing = line_spacing_mm(width_mm, height_mm);
    for (const InfillPattern pattern : patterns) {
        // Its layers differ; infill_waves_test.cpp takes the mean of all heights.
        if (pattern == InfillPattern::gyroid) continue;
        for (const double density : {0.35, 0.6}) {
            double sum = 0;
            constexpr int layers = 4;
            for (std::size_t layer = 0; layer < layers; ++layer)
                sum += length_mm(infill(square, request(pattern, density, 0.3, layer)));
            CAPTURE(static_cast<int>(pattern));
            CHECK(sum / layers * spacing == doctest::Approx(density * area).epsilon(0.01));
        }
    }
}

TEST_CASE("infill 1: solid fill reaches half a spacing beyond the middles of its lines") {
    const Contours square{rectangle(-30, -30, 30, 30)};
    const double spacing = line_spacing_mm(width_mm, height_mm);
    const double area = std::pow(60 + spacing, 2);
    for (const InfillPattern pattern : patterns) {
        const double covered = spacing * length_mm(infill(square, request(pattern, 1)));
        CHECK(covered == doctest::Approx(area).epsilon(0.01));
    }
}

TEST_CASE("infill 2: no line leaves the region") {
    for (const InfillPattern pattern : patterns) {
        for (const double density : {0.05, 0.15, 0.4, 0.8, 1.0}) {
            for (std::size_t layer = 0; layer < 2; ++layer) {
                const Motion motion{.angle_rad = 1.1 * static_cast<double>(layer),
                                    .shift = {3, -40},
                                    .mirrored = layer == 1};
                const Contours region = moved(plate_with_neck(), motion);
                CAPTURE(static_cast<int>(pattern));
                CAPTURE(density);
                const Fill fill = infill(region, request(pattern, density, 0.8, layer));
                CHECK(fill.unresolved == 0);
                CHECK(pieces(fill) > 0);
                check_inside(region, fill);
            }
        }
    }
}

TEST_CASE("infill 2: no line leaves random regions") {
    Random random(11);
    for (int i = 0; i < 40; ++i) {
        const Contours region = random_region(random, {0, 0}, random.within(3, 25));
        CAPTURE(i);
        const InfillPattern pattern = patterns[random.whole(0, std::size(patterns) - 1)];
        const double density = random.coin() ? 1 : random.within(0.1, 0.9);
        const Fill fill = infill(region, request(pattern, density, random.within(0, 3)));
        check_inside(region, fill);
    }
}

TEST_CASE("infill 2: no line leaves regions whose edges and corners lie on rows") {
    // Lines half a millimetre apart, corners on multiples of a quarter.
    const double wide_mm = 0.5 + height_mm * (1 - pi / 4);
    Random random(21);
    const auto coordinate = [&] { return 0.25 * random.whole(-24, 24); };
    for (int i = 0; i < 60; ++i) {
        CAPTURE(i);
        std::vector<Contours> shapes;
        for (int k = random.whole(1, 5); k > 0; --k) {
            const double x = coordinate(), y = coordinate();
            if (random.whole(0, 2) == 0) {
                shapes.push_back({FullCircle{{x, y}, 0.25 * random.whole(1, 12), true}});
            } else {
                shapes.push_back({rectangle(x, y, x + 0.25 * random.whole(1, 20),
                                            y + 0.25 * random.whole(1, 20))});
            }
        }
        Contours region = unite_all(shapes, 1e-4).contours;
        const Contours cut{slot(-2, -0.5, 2, 0.5), FullCircle{{0, 3}, 1, true}};
        region = combined(region, cut, Operation::subtract, 1e-4).contours;
        const InfillPattern pattern = patterns[random.whole(0, std::size(patterns) - 1)];
        InfillRequest asked =
            request(pattern, random.coin() ? 1 : 0.25, pi / 4 * random.whole(0, 7),
                    static_cast<std::size_t>(random.whole(0, 3)));
        asked.width_mm = wide_mm;
        const Fill fill = infill(region, asked);
        CHECK(fill.unresolved == 0);
        check_inside(region, fill, infill_allowed_mm + wide_mm / 20);
    }
}

TEST_CASE("infill 3: lines are in register whatever the region is") {
    const Contours large{rectangle(-40, -40, 40, 40)}, small{rectangle(-3, 1, 7, 9)};
    for (const InfillPattern pattern : patterns) {
        if (pattern == InfillPattern::concentric) continue;  // follows the region
        const auto all = lines_of(infill(large, request(pattern, 0.2)));
        const auto some = lines_of(infill(small, request(pattern, 0.2)));
        CHECK(some.size() > 3);
        for (const PrintedLine& line : some) {
            const Point2 middle = point_at(line.start, line.segment, 0.5);
            if (distance_to(small, middle) < 1e-6) continue;  // a link
            const bool found = std::any_of(all.begin(), all.end(), [&](const PrintedLine& other) {
                return distance_mm(other.start, other.segment, middle) < 1e-9;
            });
            CHECK(found);
        }
    }
}

TEST_CASE(
    "infill: concentric strands are as deep in the region as they should be, and circles stay "
    "circles") {
    const Contours region{rectangle(-10, -10, 10, 10), FullCircle{{1, 2}, 3, false}};
    const double spacing = line_spacing_mm(width_mm, height_mm);
    const Fill fill = infill(region, request(InfillPattern::concentric, 0.25));
    std::size_t circles = 0;
    for (const PrintedLine& line : lines_of(fill)) {
        const double depth = distance_to(region, point_at(line.start, line.segment, 0.3));
        const double loops = (depth - 1.5 * spacing) / (4 * spacing);
        CHECK(std::abs(loops - std::round(loops)) < 0.01);
    }
    for (const Strand& strand : fill.strands) {
        const auto* circle = std::get_if<FullCircle>(&strand.path);
        circles += circle && circle->centre == Point2(1, 2);
    }
    CHECK(circles > 0);
}

TEST_CASE("infill 4: few travels") {
    const Contours square{rectangle(-30, -30, 30, 30)};
    const Contours circle{FullCircle{{1, 2}, 30, true}};
    for (const double angle : {0.0, 0.3, pi / 4}) {
        for (const Contours& region : {square, circle}) {
            const Fill solid = infill(region, request(InfillPattern::rectilinear, 1, angle));
            CHECK(solid.runs.size() == 1);
            CHECK(solid.strands.size() <= 2);  // gaps
            CHECK(pieces(infill(region, request(InfillPattern::rectilinear, 0.15, angle))) <= 3);
            CHECK(pieces(infill(region, request(InfillPattern::grid, 0.15, angle))) <= 5);
            CHECK(pieces(infill(region, request(InfillPattern::triangles, 0.15, angle))) <= 6);
            CHECK(pieces(infill(region, request(InfillPattern::cubic, 0.15, angle))) <= 6);
        }
    }
}

TEST_CASE("infill 7: solid fill covers what it is to fill") {
    const Contours square{rectangle(0, 0, 25, 25)};
    const Contours ring{FullCircle{{0, 0}, 15, true}, FullCircle{{0, 1}, 5, false}};
    for (const double angle : {0.0, 0.1, pi / 4, 2.0}) {
        for (const Contours& region : {square, ring}) {
            const Contours whole = offset(region, {width_mm / 2, 1e-4}).contours;
            const Fill fill = infill(region, request(InfillPattern::rectilinear, 1, angle));
            CAPTURE(angle);
            CHECK(covered_share(whole, fill, width_mm) > 0.987);
        }
    }
}

TEST_CASE(
    "infill 7: no gap beside a row is wider than half a spacing, in all places of the plane") {
    const double spacing = line_spacing_mm(width_mm, height_mm);
    for (int i = 0; i < 20; ++i) {
        // Along the rows lie all sides but two of the notch, whose bottom is a dent, and an island that is narrower than
        // the rows are apart.
        const Motion motion{.angle_rad = 0, .shift = {0, 0.05 * i * spacing}};
        const Contours region = moved({Path{{0, 0},
                                            {{{20, 0}},
                                             {{20, 8}},
                                             {{14, 8}},
                                             {{14, 4}},
                                             {{6, 4}},
                                             {{6, 8}},
                                             {{0, 8}},
                                             {{0, 0}}}},
                                       rectangle(8, 6, 12, 6.2)},
                                      motion);
        const Fill fill = infill(region, request(InfillPattern::aligned, 1, 0));
        check_inside(region, fill);
        for (const Point2& edge :
             {Point2(10, 0), Point2(3, 8), Point2(17, 8), Point2(10, 4), Point2(10, 6.1)}) {
            const Point2 at = motion(edge);
            double nearest = 1e9;
            for (const PrintedLine& line : lines_of(fill))
                nearest = std::min(nearest, distance_mm(line.start, line.segment, at));
            CAPTURE(i);
            CAPTURE(edge.y());
            CHECK(nearest <= spacing / 2 + 1e-9);
        }
    }
}

TEST_CASE("infill 7: a region that lies between two rows is not empty, whatever its place") {
    for (int i = 0; i < 10; ++i) {
        for (const double angle : {0.0, 0.7}) {
            const Contours thin{rectangle(3, 5 + 0.04 * i, 9, 5.02 + 0.04 * i)};
            const Fill along = infill(thin, request(InfillPattern::aligned, 1, angle));
            CHECK(pieces(along) > 0);
            check_inside(thin, along);
        }
        const Contours point{FullCircle{{1, 5 + 0.04 * i}, 0.01, true}};
        const Fill dot = infill(point, request(InfillPattern::aligned, 1, 0.3));
        CHECK(pieces(dot) + dot.left_out == 1);
    }
}

TEST_CASE("infill 2: no line leaves an island that lies between two rows and is bent") {
    for (int i = 0; i < 48; ++i) {
        // A crescent, less high than rows are apart.
        const Motion motion{.angle_rad = 0, .shift = {1, 0.02 * i}, .mirrored = i % 2 == 1};
        const Contours crescent =
            moved(Contours{Path{{-3, 0}, {{{3, 0}, 0.3}, {{-3, 0}, -0.25}}}}, motion);
        const Fill fill = infill(crescent, request(InfillPattern::aligned, 1, 0));
        CHECK(pieces(fill) > 0);
        check_inside(crescent, fill);
    }
}

TEST_CASE("infill: rectilinear alternates, aligned does not, cubes move with the height") {
    const Contours square{rectangle(-10, -10, 10, 10)};
    const auto direction = [&](InfillPattern pattern, std::size_t layer) {
        return infill(square, request(pattern, 1, 0.3, layer)).runs.front().direction;
    };
    using enum InfillPattern;
    CHECK(std::abs(direction(rectilinear, 0).dot(direction(rectilinear, 1))) < 1e-12);
    CHECK(std::abs(direction(rectilinear, 0).dot(direction(rectilinear, 2))) > 1 - 1e-12);
    CHECK(std::abs(direction(aligned, 0).dot(direction(aligned, 1))) > 1 - 1e-12);
    // Lines of a face of a cube on its corner lie in a plane that leans by 35 degrees.
    InfillRequest low = request(cubic, 0.1, 0), high = low;
    high.z_mm += 1;
    const auto row = [&](const InfillRequest& of) {
        for (const PrintedLine& line : lines_of(infill(square, of))) {
            const Point2& end = line.segment.end;
            if (std::abs(line.start.y() - end.y()) < 1e-9 && std::abs(end.y()) < 9) return end.y();
        }
        return 0.0;
    };
    CHECK(row(high) - row(low) == doctest::Approx(-std::sqrt(0.5)));
}

TEST_CASE("infill 6: what makes no sense is counted") {
    const Contours square{rectangle(0, 0, 10, 10)};
    for (const double density : {0.0, -1.0, 1.5, std::nan("")}) {
        const Fill fill = infill(square, request(InfillPattern::grid, density));
        CHECK(fill.unresolved == 1);
        CHECK(pieces(fill) == 0);
    }
    CHECK(infill({}, request(InfillPattern::grid, 0.2)).unresolved == 0);
    const Contours broken{FullCircle{{0, std::nan("")}, 1, true}};
    CHECK(infill(broken, request(InfillPattern::grid, 0.2)).unresolved == 1);
}
