// What prints cover of the sections they are made of, in lines 10 um apart, and how much they extrude.

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <numbers>

#include "format/reader.h"
#include "kernel/brep/placement.h"
#include "kernel/toolpath/fills.h"
#include "scratch.h"
#include "slicer/bounds.h"
#include "slicer/layers.h"
#include "slicer/slicer.h"

using namespace lyr;
using namespace lyr::slicer;
using lyr::testing::Intervals;

namespace {

constexpr double line_mm = 0.01;

// What strands cover of horizontal lines; row k is at (k + 1/2) line_mm, as those of hatch() are.
class Coverage {
public:
    void add(Point2 from, const Segment& segment, double width_mm) {
        constexpr double chord_mm = 0.1;
        const int chords =
            segment.sagitta_mm == 0 ? 1 : 1 + static_cast<int>(length_mm(from, segment) / chord_mm);
        Point2 a = from;
        for (int i = 1; i <= chords; ++i) {
            const Point2 b = point_at(from, segment, static_cast<double>(i) / chords);
            const double low = std::min(a.y(), b.y()) - width_mm / 2;
            const double high = std::max(a.y(), b.y()) + width_mm / 2;
            for (long row = std::lround(low / line_mm - 0.5);
                 row <= std::lround(high / line_mm - 0.5); ++row)
                testing::add_covered(a, b, width_mm / 2, (static_cast<double>(row) + 0.5) * line_mm,
                                     rows_[row]);
            a = b;
        }
    }

    // Of the region's area: what is covered, and what is covered beside it.
    std::pair<double, double> shares(Region region) {
        double within = 0, all = 0, area = 0;
        for (auto& [row, intervals] : rows_) all += joined(intervals);
        const Hatch scan = hatch(region, 0, line_mm);
        const long first = std::lround(scan.first_offset_mm / line_mm - 0.5);
        for (std::size_t k = 0; k < scan.row_count(); ++k) {
            const Intervals& covered = rows_[first + static_cast<long>(k)];
            for (std::uint32_t s = scan.row_start[k]; s < scan.row_start[k + 1]; ++s) {
                area += scan.spans[s].end_mm - scan.spans[s].start_mm;
                for (const auto& [low, high] : covered)
                    within += std::max(0.0, std::min(high, scan.spans[s].end_mm) -
                                                std::max(low, scan.spans[s].start_mm));
            }
        }
        return {within / area, (all - within) / area};
    }

private:
    // Makes intervals that overlap one, and gives the length of all.
    static double joined(Intervals& intervals) {
        std::sort(intervals.begin(), intervals.end());
        Intervals apart;
        double length = 0;
        for (const auto& [low, high] : intervals) {
            if (!apart.empty() && low <= apart.back().second) {
                apart.back().second = std::max(apart.back().second, high);
            } else {
                apart.push_back({low, high});
            }
        }
        for (const auto& [low, high] : apart) length += high - low;
        intervals = std::move(apart);
        return length;
    }

    std::map<long, Intervals> rows_;
};

// Follows a print; calls take(layer, coverage) at the end of every `stride`th layer.
class PrintedStrands {
public:
    PrintedStrands(format::Quantum quantum, std::uint32_t stride)
        : quantum_(quantum), stride_(stride) {}

    bool operator()(const format::Operation& operation) {
        bool is_new = false;
        if (const auto* layer = std::get_if<format::LayerStart>(&operation)) {
            layer_ = layer->index;
            is_new = true;
        } else if (const auto* path = std::get_if<format::PathStart>(&operation)) {
            style_ = path->style;
        } else if (const auto* width = std::get_if<format::Width>(&operation)) {
            style_.width_mm = width->width_mm;
        } else if (const auto* line = std::get_if<format::Line>(&operation)) {
            add(at(line->from), {at(line->to), 0});
        } else if (const auto* arc = std::get_if<format::Arc>(&operation)) {
            add(at(arc->from), {at(arc->to), quantum_.mm(arc->sagitta)});
        } else if (const auto* circle = std::get_if<format::Circle>(&operation)) {
            const Point2 from = at(circle->from);
            const Point2 centre(quantum_.mm(circle->center_x), quantum_.mm(circle->center_y));
            const double turn = circle->counter_clockwise ? testing::pi : -testing::pi;
            add(from, arc_with_sweep(from, 2 * centre - from, turn));
            add(2 * centre - from, arc_with_sweep(2 * centre - from, from, turn));
        }
        return is_new;
    }

    std::uint32_t layer() const { return layer_; }
    bool is_looked_at() const { return layer_ % stride_ == stride_ / 2; }
    double volume_mm3 = 0;
    Coverage coverage{};

private:
    Point2 at(const format::Point& p) const { return {quantum_.mm(p.x), quantum_.mm(p.y)}; }
    void add(const Point2& from, const Segment& segment) {
        volume_mm3 += length_mm(from, segment) * format::cross_section_mm2(style_);
        if (is_looked_at()) coverage.add(from, segment, style_.width_mm);
    }

    format::Quantum quantum_;
    std::uint32_t stride_, layer_ = 0;
    format::PathStyle style_{};
};

struct Part {
    const char* file;
    double layer_mm;
    std::uint32_t stride;
};

void check_coverage(const Part& part, Options options) {
    const std::string name = part.file;
    CAPTURE(name);
    options.profile.infill.density = 1;
    options.profile.layer.height_mm = options.profile.layer.first_height_mm = part.layer_mm;
    Diagnostics diagnostics;
    auto model = load(std::string(LYR_FIXTURES) + "/parts/" + part.file, options, diagnostics);
    REQUIRE(model);
    const Eigen::AlignedBox3d box = bounding_box(*model, options.tolerance());
    const Model placed = transformed(*model, Eigen::Affine3d(Eigen::Translation3d(-box.min())));
    const Cutter cutter(placed, options.tolerance());
    const std::string lyr = lyr::tests::scratch(std::string(part.file) + ".lyr");
    REQUIRE(print(
        *model, part.file, lyr, "", options, [](const char*, std::size_t, std::size_t) {},
        diagnostics));
    CHECK(diagnostics.empty());

    auto reader = format::Reader::open(lyr);
    REQUIRE(reader);
    PrintedStrands strands(reader->header().quantum, part.stride);
    double exact_mm3 = 0;
    const auto section = [&](std::uint32_t layer) {
        return region_of(cutter.cut((layer + 0.5) * part.layer_mm), options.tolerance()).contours;
    };
    const auto check_layer = [&] {
        if (!strands.is_looked_at()) return;
        CAPTURE(strands.layer());
        const auto [covered, outside] = strands.coverage.shares(section(strands.layer()));
        CHECK(covered >= 0.99);
        CHECK(outside <= 0.005);
        strands.coverage = {};
    };
    std::uint32_t layers = 0;
    for (;;) {
        const auto operation = reader->next();
        REQUIRE(operation);
        if (!*operation) break;
        if (std::holds_alternative<format::LayerStart>(**operation)) {
            if (layers > 0) check_layer();
            ++layers;
        }
        strands(**operation);
    }
    check_layer();
    for (std::uint32_t layer = 0; layer < layers; ++layer)
        for (const Contour& contour : section(layer))
            exact_mm3 += area_mm2(contour) * part.layer_mm;
    MESSAGE(name << ": " << strands.volume_mm3 / exact_mm3 << " of the volume");
    CHECK(strands.volume_mm3 == doctest::Approx(exact_mm3).epsilon(0.01));
}

}  // namespace

TEST_CASE(
    "prints: at 100 % fill layers are covered, nothing is printed beside them, and the volume is "
    "the part's") {
    check_coverage({"gearbox_base.step", 0.2, 15}, {});
    check_coverage({"lower_teeth.step", 0.1, 20}, {});
}
