// Open paths clipped to regions, by what must hold for all of them.

#include "kernel/toolpath/clip.h"

#include <doctest/doctest.h>

#include "kernel/region/regions.h"

using namespace lyr;
using namespace lyr::testing;

namespace {

// Across the square of this half size, and out of it on either side: lines and arcs of both turns.
Path random_path(Random& random, double size) {
    Path path{{-1.2 * size, random.within(-0.5, 0.5) * size}, {}};
    Point2 from = path.start;
    const int count = random.whole(1, 9);
    for (int i = 1; i <= count; ++i) {
        const double x = (2.4 * i / count - 1.2) * size;
        const Point2 to(x, random.within(-1, 1) * size);
        const double bend = random.coin() ? 0 : random.within(-0.7, 0.7);
        path.segments.push_back({to, bend * (to - from).norm()});
        from = to;
    }
    return path;
}

double distance_to_path(const Path& path, const Point2& point) {
    double least = 1e300;
    Point2 from = path.start;
    for (const Segment& segment : path.segments) {
        least = std::min(least, distance_mm(from, segment, point));
        from = segment.end;
    }
    return least;
}

Point2 end_of(const Path& path) {
    return path.segments.back().end;
}

}  // namespace

TEST_CASE("clipped 1: what is in the region is in a part, what is not is in none") {
    Random random(5);
    for (int i = 0; i < 300; ++i) {
        CAPTURE(i);
        const double size = random.within(2, 30);
        const Contours region = random_region(random, {0, 0}, size);
        const Path path = random_path(random, size);
        const auto parts = clipped(path, Boundary(region));
        double in_parts = 0;
        for (const PathPart& part : parts) {
            in_parts += length_mm(Contour(part.path));
            Point2 from = part.path.start;
            for (const Segment& segment : part.path.segments) {
                for (const double share : {0.1, 0.5, 0.9}) {
                    const Point2 at = point_at(from, segment, share);
                    CHECK(distance_to_path(path, at) < 1e-6);
                    CHECK((winding(region, at) > 0 || distance_to(region, at) < 1e-6));
                }
                from = segment.end;
            }
        }
        // The share of inner points, counted, is that of the length.
        int in = 0, all = 0;
        Point2 from = path.start;
        for (const Segment& segment : path.segments) {
            const int steps = 1 + static_cast<int>(100 * length_mm(from, segment) / size);
            for (int k = 0; k < steps; ++k, ++all)
                in += winding(region, point_at(from, segment, (k + 0.5) / steps)) > 0;
            from = segment.end;
        }
        CHECK(in_parts / length_mm(Contour(path)) ==
              doctest::Approx(double(in) / all).epsilon(0.05));
    }
}

TEST_CASE("clipped 2: parts end on the boundary where their places say") {
    Random random(6);
    for (int i = 0; i < 100; ++i) {
        const Contours region = random_region(random, {3, -4}, 10);
        const Motion motion{.angle_rad = random.within(0, 6), .shift = {3, -4}};
        const Boundary boundary(region);
        const Contour moved_path = moved(Contour(random_path(random, 10)), motion);
        for (const PathPart& part : clipped(std::get<Path>(moved_path), boundary)) {
            REQUIRE(part.start);
            REQUIRE(part.end);
            CHECK(part.start->point == part.path.start);
            CHECK(part.end->point == end_of(part.path));
            for (const BoundaryPlace& place : {*part.start, *part.end}) {
                const BoundaryPiece& piece = boundary.pieces()[place.piece];
                CHECK(piece.distance_mm(place.point) < 1e-6);
                const BoundaryPlace same = place_on(boundary.pieces(), place.piece, place.point);
                CHECK(std::abs(same.along_mm - place.along_mm) < 1e-6);
            }
        }
    }
}

TEST_CASE("clipped: a path that is wholly inside is itself, one outside is nothing") {
    const Boundary region(Contours{rectangle(-5, -5, 5, 5)});
    Path path{{-1, -1}, {{{2, 0}, 0.3}, {{3, 3}}}};
    const auto parts = clipped(path, region);
    REQUIRE(parts.size() == 1);
    CHECK(!parts[0].start);
    CHECK(!parts[0].end);
    CHECK(Contour(parts[0].path) == Contour(path));
    CHECK(clipped(Path{{-9, -9}, {{{9, -9}}}}, region).empty());
    CHECK(clipped(Path{{0, 0}, {}}, region).empty());
    CHECK(clipped(path, Boundary(Contours{})).empty());
}

TEST_CASE("cut_at 4: all of the path, each segment in the region or not") {
    Random random(7);
    for (int i = 0; i < 200; ++i) {
        CAPTURE(i);
        const double size = random.within(2, 30);
        const Contours region = random_region(random, {0, 0}, size);
        const Path path = random_path(random, size);
        const CutPath cut = cut_at(path, Boundary(region));
        REQUIRE(cut.inside.size() == cut.path.segments.size());
        REQUIRE(cut.origin.size() == cut.path.segments.size());
        CHECK(cut.path.start == path.start);
        CHECK(end_of(cut.path) == end_of(path));
        CHECK(length_mm(Contour(cut.path)) == doctest::Approx(length_mm(Contour(path))));
        CHECK(std::is_sorted(cut.origin.begin(), cut.origin.end()));
        Point2 from = cut.path.start;
        for (std::size_t k = 0; k < cut.inside.size(); ++k) {
            const Segment& segment = cut.path.segments[k];
            const Segment& of = path.segments[cut.origin[k]];
            const Point2 begin =
                cut.origin[k] == 0 ? path.start : path.segments[cut.origin[k] - 1].end;
            for (const double share : {0.1, 0.5, 0.9}) {
                const Point2 at = point_at(from, segment, share);
                CHECK(distance_mm(begin, of, at) < 1e-6);
                if (distance_to(region, at) > 1e-6)
                    CHECK(cut.inside[k] == (winding(region, at) > 0));
            }
            from = segment.end;
        }
    }
}

TEST_CASE("cut_at 4: what crosses nothing is as it was, and nothing stays nothing") {
    const Path path{{-1, -1}, {{{2, 0}, 0.3}, {{3, 3}}}};
    for (const double size : {5.0, 0.1}) {
        const CutPath cut = cut_at(
            path, Boundary(Contours{rectangle(-size - 6, -size, size - 6 + 6 * (size > 1), size)}));
        CHECK(Contour(cut.path) == Contour(path));
        CHECK(cut.inside == std::vector<bool>(2, size > 1));
    }
    CHECK(cut_at(Path{{0, 0}, {}}, Boundary(Contours{})).path.segments.empty());
    CHECK(cut_at(Path{{0, 0}, {{{0, 1e-9}}}}, Boundary(Contours{})).path.segments.size() == 1);
}

TEST_CASE("clipped 1: passing corners and touching circles cuts nothing off") {
    const Boundary diamond(Contours{Path{{0, -3}, {{{3, 0}}, {{0, 3}}, {{-3, 0}}, {{0, -3}}}}});
    for (double angle = 0; angle < 6; angle += 0.37) {
        const Motion motion{.angle_rad = angle};
        const Contours region = moved({Path{{0, -3}, {{{3, 0}}, {{0, 3}}, {{-3, 0}}, {{0, -3}}}},
                                       FullCircle{{1, -0.5}, 0.5, false}},
                                      motion);
        // From corner to corner, touching the hole.
        const Path path{motion({-5, 0}), {{motion({5, 0})}}};
        double length = 0;
        for (const PathPart& part : clipped(path, Boundary(region)))
            length += length_mm(Contour(part.path));
        CHECK(length == doctest::Approx(6));
        // Up to the hole's height a semicircle that touches nothing.
        const Path outside{motion({-5, 4}), {{motion({5, 4}), 0.9}}};
        CHECK(clipped(outside, Boundary(region)).empty());
    }
}

TEST_CASE(
    "a boundary's ruler: the way between two places is as long as it says, forwards and "
    "backwards") {
    Random random(8);
    for (int i = 0; i < 100; ++i) {
        const Contours region = random_region(random, {0, 0}, 10);
        const auto pieces = boundary_pieces(region);
        const BoundaryRuler ruler(pieces);
        const auto somewhere = [&](std::uint32_t contour) {
            std::uint32_t piece = 0;
            do {
                piece = static_cast<std::uint32_t>(
                    random.whole(0, static_cast<int>(pieces.size()) - 1));
            } while (pieces[piece].contour != contour);
            const BoundaryPiece& on = pieces[piece];
            const double along = random.within(0, 1) * on.length_mm;
            return place_on(pieces, piece, point_on(on.curve(), along - on.length_mm / 2));
        };
        const auto contour = static_cast<std::uint32_t>(i % static_cast<int>(region.size()));
        const BoundaryPlace a = somewhere(contour), b = somewhere(contour);
        Path forward{a.point, {}}, backward{b.point, {}};
        ruler.append_forward(a, b, forward.segments);
        ruler.append_backward(b, a, backward.segments);
        double length = ruler.position_mm(b) - ruler.position_mm(a);
        if (length < 0) length += ruler.contour_length_mm(contour);
        CHECK(length_mm(Contour(forward)) == doctest::Approx(length));
        CHECK(length_mm(Contour(backward)) == doctest::Approx(length));
        CHECK(end_of(forward) == b.point);
        CHECK(end_of(backward) == a.point);
        for (const Path& path : {forward, backward}) {
            Point2 from = path.start;
            for (const Segment& segment : path.segments) {
                CHECK(distance_to(region, point_at(from, segment, 0.4)) < 1e-9);
                from = segment.end;
            }
        }
    }
}
