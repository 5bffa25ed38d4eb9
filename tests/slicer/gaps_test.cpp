// What strands cover of layers that are to be solid, and how much they lay down, where walls leave little room.

#include <doctest/doctest.h>

#include <map>

#include "kernel/toolpath/fills.h"
#include "slicer/balance.h"
#include "slicer/fill.h"
#include "slicer/scene.h"

using namespace lyr;
using namespace lyr::slicer;
using namespace lyr::testing;

namespace {

const Motion part_motions[] = {{}, {0.3, {1, 2}}, {2.1, {-40, 7}, true}, {pi / 4, {0, 0}}};

struct FilledLayer {
    OutlinedLayer layer;
    LayerFill fill;
};

FilledLayer printed(const Contours& outline, const Options& options) {
    FilledLayer print{.layer = {.outline = outline}, .fill = {}};
    add_walls(print.layer, span, options);
    const LayerSpan spans[] = {span};
    std::vector<SkinOutline> outlines;
    outlines.emplace_back(outline, options.profile.skin.width_mm);
    const LayerSkins skins[] = {skins_of_layer(0, print.layer.walls, outlines, options)};
    print.fill = fill_layer(0, print.layer.walls, {spans, outlines, skins}, options);
    CHECK(print.layer.walls.unresolved + print.fill.unresolved == 0);
    return print;
}

FilledLayer printed_solid(const Contours& outline) {
    Options options;
    options.profile.infill.density = 1;
    return printed(outline, options);
}

// Calls take(strand, flow): of runs, for each row and link.
template <class Take>
void for_strands(const FilledLayer& print, Take take) {
    for (const Strand& wall : print.layer.walls.strands) take(wall, 1);
    for (const Piece& piece : print.fill.pieces) {
        if (const auto* strand = std::get_if<Strand>(&piece.way)) {
            take(*strand, piece.flow);
            continue;
        }
        Fill run;
        run.runs = {std::get<HatchRun>(piece.way)};
        for (const PrintedLine& line : lines_of(run))
            take(Strand{Path{line.start, {line.segment}}, profile::Skin{}.width_mm}, piece.flow);
    }
}

// Calls take(line, width) for all that a strand consists of.
template <class Take>
void for_lines(const Strand& strand, Take take) {
    Fill one;
    one.strands = {strand};
    std::size_t segment = 0;
    for (const PrintedLine& line : lines_of(one))
        take(line, strand.widths_mm.empty() ? strand.width_mm : strand.widths_mm[segment++]);
}

// Of a region's area, in lines 20 um apart.
double covered_share_of(const FilledLayer& print, const Contours& region) {
    constexpr double line_mm = 0.02, chord_mm = 0.1;
    std::map<long, Intervals> rows;
    for_strands(print, [&](const Strand& strand, double) {
        for_lines(strand, [&](const PrintedLine& line, double width_mm) {
            const int chords =
                1 + static_cast<int>(lyr::length_mm(line.start, line.segment) / chord_mm);
            for (int i = 0; i < chords; ++i) {
                const Point2 a =
                    point_at(line.start, line.segment, static_cast<double>(i) / chords);
                const Point2 b =
                    point_at(line.start, line.segment, static_cast<double>(i + 1) / chords);
                const double low = std::min(a.y(), b.y()) - width_mm / 2;
                const double high = std::max(a.y(), b.y()) + width_mm / 2;
                for (long row = std::lround(low / line_mm); row <= std::lround(high / line_mm);
                     ++row)
                    add_covered(a, b, width_mm / 2, (static_cast<double>(row) + 0.5) * line_mm,
                                rows[row]);
            }
        });
    });
    const Hatch scan = hatch(region, 0, line_mm);
    const long first = std::lround(scan.first_offset_mm / line_mm - 0.5);
    double all = 0, covered = 0;
    for (std::size_t k = 0; k < scan.row_count(); ++k) {
        Intervals& intervals = rows[first + static_cast<long>(k)];
        std::sort(intervals.begin(), intervals.end());
        for (std::uint32_t s = scan.row_start[k]; s < scan.row_start[k + 1]; ++s) {
            double at = scan.spans[s].start_mm;
            all += scan.spans[s].end_mm - at;
            for (const auto& [low, high] : intervals) {
                const double from = std::max(at, low), to = std::min(scan.spans[s].end_mm, high);
                covered += std::max(0.0, to - from);
                at = std::max(at, high);
            }
        }
    }
    return covered / all;
}

// What is laid down, as a share of what the outline asks for: its strands' flanks are round.
double laid_share_of(const FilledLayer& print) {
    const double round_mm = span.height_mm() * (1 - pi / 4);
    double laid = 0;
    for_strands(print, [&](const Strand& strand, double flow) {
        laid += flow * (flat_area_mm2(strand) - round_mm * lyr::length_mm(strand.path));
    });
    const Contours& outline = print.layer.outline;
    return laid / (total_area(outline) - round_mm / 2 * total_length(outline));
}

// How far strands of walls reach out of the outline.
double outside_mm(const FilledLayer& print) {
    const Boundary outline(print.layer.outline);
    double most = 0;
    for (const Strand& wall : print.layer.walls.strands) {
        for_lines(wall, [&](const PrintedLine& line, double width_mm) {
            for (int k = 0; k <= 4; ++k) {
                const Point2 point = point_at(line.start, line.segment, k / 4.0);
                most = std::max(most, width_mm / 2 - outline.distance_mm(point, 1));
            }
        });
    }
    return most;
}

}  // namespace

TEST_CASE("gaps: at 100 % fill, necks between the walls that no line fits into were left empty") {
    const double spacing_mm = line_spacing_mm(0.45, 0.2);
    const double walls_mm = 0.45 + 3 * spacing_mm;
    for (const double neck_mm : {0.12, 0.2, 0.3, 0.45, 0.6, 0.8}) {
        CAPTURE(neck_mm);
        const double half_mm = 2 + walls_mm + neck_mm;
        const Contours plate{rectangle(-4.5, -half_mm, 4.5, half_mm), FullCircle{{0, 0}, 2, false}};
        for (const Motion& motion : part_motions) {
            const FilledLayer print = printed_solid(lyr::testing::moved(plate, motion));
            CHECK(covered_share_of(print, print.layer.outline) >= 0.993);
            CHECK(laid_share_of(print) == doctest::Approx(1).epsilon(0.006));
        }
    }
}

TEST_CASE(
    "gaps: tips of corners of 20 to 40 degrees were left out, at the outline and between walls") {
    for (const double tip_rad : {0.35, 0.4, 0.45, 0.5, 0.55, 0.6, 0.65, 0.7}) {
        CAPTURE(tip_rad);
        const auto wedge = [&](double length_mm) {
            const double half_mm = length_mm * std::tan(tip_rad / 2);
            return Contours{
                Path{{0, 0}, {{{length_mm, -half_mm}}, {{length_mm, half_mm}}, {{0, 0}}}}};
        };
        // As far as there are walls only. What is thinner than 0.2 mm is left out, 1.6 % of it.
        const Contours tip = wedge(0.8 / std::tan(tip_rad / 2));
        for (const Motion& motion : part_motions) {
            const FilledLayer print = printed_solid(lyr::testing::moved(wedge(10), motion));
            CHECK(covered_share_of(print, lyr::testing::moved(tip, motion)) >= 0.98);
            CHECK(laid_share_of(print) == doctest::Approx(1).epsilon(0.01));
        }
    }
}

TEST_CASE(
    "gaps: walls beside each other in ribs were not fitted to these where the part is wide "
    "elsewhere") {
    for (const double rib_mm : {0.76, 0.8, 0.86, 0.9, 0.94, 1.6, 1.7}) {
        CAPTURE(rib_mm);
        Contours comb{rectangle(0, 0, 12, 3)};
        for (int tooth = 0; tooth < 5; ++tooth)
            comb = combined(comb, Contours{rectangle(2.5 * tooth, 2, 2.5 * tooth + rib_mm, 10)},
                            Operation::unite, 1e-3)
                       .contours;
        for (const Motion& motion : part_motions) {
            const FilledLayer print = printed_solid(lyr::testing::moved(comb, motion));
            CHECK(covered_share_of(print, print.layer.outline) >= 0.99);
            CHECK(laid_share_of(print) == doctest::Approx(1).epsilon(0.01));
        }
    }
}

TEST_CASE("gaps: two walls that go through a short neck lay over each other there") {
    constexpr double radius_mm = 1.2;
    for (const double neck_mm : {0.58, 0.62, 0.66, 0.7, 0.74, 0.78}) {
        CAPTURE(neck_mm);
        const double half_mm = 1.5 * neck_mm + 2 * radius_mm, at_mm = radius_mm + neck_mm / 2;
        Contours plate{rectangle(-half_mm, -half_mm, half_mm, half_mm)};
        for (const double x : {-at_mm, at_mm})
            for (const double y : {-at_mm, at_mm})
                plate.push_back(FullCircle{{x, y}, radius_mm, false});
        for (const Motion& motion : part_motions) {
            const FilledLayer print = printed_solid(lyr::testing::moved(plate, motion));
            // All of it are necks and gaps, into whose walls strands reach a little.
            CHECK(laid_share_of(print) >= 0.985);
            CHECK(laid_share_of(print) <= 1.02);
            CHECK(outside_mm(print) < 0.02);
        }
    }
}

TEST_CASE("gaps: rings of solid fill left their middle open") {
    Options options;
    options.profile.infill.density = 1;
    options.profile.skin.pattern = profile::SkinPattern::concentric;
    const Contours shapes[] = {{rectangle(0, 0, 12, 9.1)},
                               {FullCircle{{0, 0}, 5, true}},
                               {FullCircle{{0, 0}, 6, true}, FullCircle{{1, 0}, 1.7, false}},
                               {Path{{0, 0}, {{{12, 0}}, {{3, 9}}, {{0, 0}}}}},
                               combined(Contours{rectangle(0, 0, 12, 4)},
                                        Contours{rectangle(3, 0, 8.3, 11)}, Operation::unite, 1e-3)
                                   .contours};
    for (const Contours& shape : shapes)
        for (const Motion& motion : part_motions) {
            FilledLayer print = printed(lyr::testing::moved(shape, motion), options);
            print.layer.printed = figures_of(print.layer.outline);
            CHECK(covered_share_of(print, print.layer.outline) >= 0.99);
            CHECK(laid_share_of(print) == doctest::Approx(1).epsilon(0.01));
            CHECK(!imbalance_of(print.layer, print.fill, span, options.profile));
        }
}

TEST_CASE("a perforated plate took a minute for the middles of the net between its holes") {
    Contours plate{rectangle(0, 0, 120, 120)};
    for (int i = 0; i < 13; ++i)
        for (int k = 0; k < 13; ++k)
            plate.push_back(FullCircle{{9.2 * i + 4.8, 9.2 * k + 4.8}, 3.2, false});
    for (const auto pattern :
         {profile::SkinPattern::rectilinear, profile::SkinPattern::concentric}) {
        Options options;
        options.profile.infill.density = 1;
        options.profile.skin.pattern = pattern;
        const FilledLayer print = printed(plate, options);
        std::size_t lines = 0;
        for (const Piece& piece : print.fill.pieces)
            lines += piece.role != format::Role::gap_fill && piece.role != format::Role::thin_wall;
        CHECK(lines > 0);
        CHECK(laid_share_of(print) > 0.9);
    }
}
