// Supports by what must hold for every point of them, and of what they hold.

#include "slicer/support.h"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "format/reader.h"
#include "kernel/brep/assembly.h"
#include "kernel/brep/placement.h"
#include "kernel/solids.h"
#include "kernel/toolpath/boundary.h"
#include "slicer/bounds.h"
#include "slicer/layers.h"
#include "slicer/scene.h"

using namespace lyr;
using namespace lyr::slicer;
using namespace lyr::testing;

namespace {

Model together(Model a, Model b) {
    append(a, std::move(b));
    return a;
}

Model upright(double radius, double low, double high) {
    return at(frustum(radius, radius, high - low, Side::seam), 0, 0, (low + high) / 2);
}

// A funnel that widens upwards at an angle from the vertical, on a foot.
Model funnel(double degrees) {
    const double top = 2 + 6 * std::tan(degrees * pi / 180);
    return together(upright(2.01, 0, 3), at(frustum(2, top, 6, Side::halves), 0, 0, 6));
}

// A plate on a post: a flat underside all round.
Model table() {
    return together(upright(2, 0, 8), at(box(14, 10, 2), 0, 0, 8.9));
}

// A plate on two walls, `span_mm` apart.
Model bridge(double span_mm) {
    Model walls =
        together(at(box(2, 8, 6), -1 - span_mm / 2, 0, 3), at(box(2, 8, 6), 1 + span_mm / 2, 0, 3));
    return together(std::move(walls), at(box(span_mm + 4, 8, 2), 0, 0, 6.9));
}

// A plate on a post, over a plate that lies on the bed.
Model shelf() {
    return together(table(), at(box(12, 10, 2), 0, 0, 1));
}

Options grid(double layer_mm = 0.2) {
    Options options;
    options.threads = 1;
    options.profile.layer.height_mm = options.profile.layer.first_height_mm = layer_mm;
    options.profile.support.kind = profile::SupportKind::grid;
    return options;
}

Options tree() {
    Options options = grid();
    options.profile.support.kind = profile::SupportKind::tree;
    return options;
}

struct Supported {
    Options options;
    std::vector<LayerSpan> spans;
    std::vector<OutlinedLayer> layers{};
    SupportPlan plan{};
    Diagnostics diagnostics{};
    std::vector<Boundary> parts{}, supports{};

    // `thicknesses_mm` by turns, instead of layers as the options have them.
    explicit Supported(const Model& part, const Options& asked = grid(),
                       const std::vector<double>& thicknesses_mm = {})
        : options(asked) {
        Model model = part;
        const double low_mm = bounding_box(model, options.tolerance()).min().z();
        model = at(std::move(model), 0, 0, -low_mm);
        const Eigen::AlignedBox3d box = bounding_box(model, options.tolerance());
        spans = layer_spans(box.sizes().z(), options.profile.layer);
        if (!thicknesses_mm.empty()) spans = by_turns(thicknesses_mm, box.sizes().z());
        const Cutter cutter(model, options.tolerance());
        for (std::size_t i = 0; i < spans.size(); ++i)
            layers.push_back(outline_layer(cutter, i, spans[i], box, options));
        const auto blocked = blocked_faces(model, options.profile.support);
        REQUIRE(blocked);
        plan = SupportPlan(layers, spans);
        plan.find_overhangs(model, cutter, *blocked, options);
        plan.find_areas(options, diagnostics);
        for (std::size_t i = 0; i < spans.size(); ++i) {
            parts.emplace_back(layers[i].outline);
            supports.emplace_back(plan.area(i));
        }
    }
    Supported(const Supported&) = delete;

    static std::vector<LayerSpan> by_turns(const std::vector<double>& thicknesses_mm,
                                           double height_mm) {
        std::vector<LayerSpan> spans;
        double top_mm = 0;
        for (std::size_t i = 0; top_mm < height_mm - 0.05; ++i) {
            const double bottom_mm = top_mm;
            top_mm += thicknesses_mm[i % thicknesses_mm.size()];
            spans.push_back({bottom_mm, top_mm});
        }
        return spans;
    }

    bool in_part(std::size_t i, const Point2& point) const { return parts[i].winding(point) > 0; }
    bool in_support(std::size_t i, const Point2& point) const {
        return supports[i].winding(point) > 0;
    }
    double volume_mm3() const {
        double volume = 0;
        for (std::size_t i = 0; i < spans.size(); ++i)
            volume += area_mm2(plan.area(i)) * spans[i].height_mm();
        return volume;
    }
    bool keeps_clear_of(std::size_t i, std::size_t k) const {
        const double gap_mm = options.profile.support.gap_z_mm;
        return spans[k].top_mm > spans[i].bottom_mm - gap_mm + 1e-6 &&
               spans[k].bottom_mm < spans[i].top_mm + gap_mm - 1e-6;
    }
};

// Points all over a region's box.
template <class Take>
void over(Region region, double pitch_mm, Take take) {
    lyr::region::Box2 box;
    for (const Contour& contour : region) box.extend(lyr::region::box_of(contour));
    if (box.isEmpty()) return;
    const Boundary boundary(region);
    for (double y = box.min().y() + 0.37 * pitch_mm; y < box.max().y(); y += pitch_mm)
        for (double x = box.min().x() + 0.61 * pitch_mm; x < box.max().x(); x += pitch_mm)
            if (boundary.winding({x, y}) > 0) take(Point2(x, y));
}

constexpr double pitch_mm = 0.6;
constexpr double round_off_mm = 2e-3;

// `lean_mm`: how far support may reach over that of the layer below.
void check_gaps_and_standing(const Supported& s, double lean_mm = 0) {
    const profile::Support& support = s.options.profile.support;
    std::size_t points = 0;
    for (std::size_t i = 0; i < s.spans.size(); ++i) {
        over(s.plan.area(i), pitch_mm, [&](const Point2& p) {
            ++points;
            if (s.in_part(i, p) || s.parts[i].is_near(p, support.gap_xy_mm - round_off_mm))
                FAIL_CHECK("support within gap_xy in layer ", i);
            for (std::size_t k = 0; k < s.spans.size(); ++k)
                if (s.keeps_clear_of(i, k) && s.in_part(k, p) &&
                    !s.parts[k].is_near(p, round_off_mm))
                    FAIL_CHECK("support of layer ", i, " is too near to the part in layer ", k);
            if (i == 0 || s.in_support(i - 1, p) || s.supports[i - 1].is_near(p, lean_mm)) return;
            // Else the part is below, or so near in the layer below that there is no support.
            bool stands = false;
            for (std::size_t k = 0; k < i; ++k) stands = stands || s.in_part(k, p);
            stands = stands ||
                     s.parts[i - 1].is_near(p, support.gap_xy_mm + s.options.profile.skin.width_mm);
            if (!stands) FAIL_CHECK("support of layer ", i, " stands on air");
            if (support.on_bed_only) FAIL_CHECK("support of layer ", i, " is not on the bed");
        });
    }
    CHECK(points > 0);
}

// The share of what hangs over air, by the test's own account, that has support right below the gap. `leans` says whether
// the surface there is to be held.
template <class Leans>
double held_share(const Supported& s, Leans leans) {
    const double gap_mm = s.options.profile.support.gap_z_mm,
                 xy_mm = s.options.profile.support.gap_xy_mm;
    std::size_t all = 0, held = 0;
    for (std::size_t i = 2; i < s.spans.size(); ++i) {
        std::size_t t = i;
        while (t-- > 0 && s.spans[t].top_mm > s.spans[i].bottom_mm - gap_mm + 1e-6) {
        }
        if (t >= i) continue;
        over(s.layers[i].outline, pitch_mm / 2, [&](const Point2& p) {
            if (s.in_part(i - 1, p) || !leans(Point3(p.x(), p.y(), s.spans[i].bottom_mm))) return;
            for (std::size_t k = t; k < i; ++k)
                if (s.in_part(k, p)) return;
            if (s.parts[t].is_near(p, xy_mm)) return;
            ++all;
            held += s.in_support(t, p);
        });
    }
    REQUIRE(all > 0);
    return static_cast<double>(held) / static_cast<double>(all);
}

const auto anywhere = [](const Point3&) { return true; };

}  // namespace

TEST_CASE("support: none under what does not hang over") {
    for (const Model& model : {box(7, 5, 3), frustum(3, 3, 5, Side::seam),
                               frustum(6, 2, 5, Side::halves), funnel(40), funnel(49.9)}) {
        const Supported s(model);
        CHECK(s.volume_mm3() == 0);
        CHECK(s.diagnostics.empty());
    }
}

TEST_CASE(
    "support 1: a funnel is held if it leans out by a tenth of a degree more than the limit") {
    CHECK(Supported(funnel(50.1)).volume_mm3() > 0);
    Options options = grid();
    options.profile.support.angle_deg = 30;
    CHECK(Supported(funnel(29.9), options).volume_mm3() == 0);
    CHECK(Supported(funnel(30.1), options).volume_mm3() > 0);
}

TEST_CASE("support 2: gaps are kept, and support stands on the bed, the part or support") {
    struct Case {
        std::string name;
        Model model;
    };
    const Model lying =
        turned(frustum(3, 3, 12, Side::seam), pi / 2, Vector3(1, 0.3, 0).normalized());
    for (const Case& part :
         {Case{"funnel", funnel(65)}, Case{"table", table()}, Case{"shelf", shelf()},
          Case{"ball", at(sphere(5, true), 0, 0, 5)}, Case{"lying", lying},
          Case{"torus", turned(torus(6, 2, true), 1.1, Vector3::UnitX())}}) {
        CAPTURE(part.name);
        for (const bool on_bed_only : {false, true}) {
            CAPTURE(on_bed_only);
            Options options = grid();
            options.profile.support.on_bed_only = on_bed_only;
            check_gaps_and_standing(Supported(part.model, options));
        }
        Options thin = grid(0.15);
        thin.profile.layer.first_height_mm = 0.3;
        thin.profile.support.gap_xy_mm = 0.7;
        check_gaps_and_standing(Supported(part.model, thin));
    }
}

TEST_CASE("support_tree 1, 3: gaps are kept, and branches lean by no more than their angle") {
    const Model lying =
        turned(frustum(3, 3, 12, Side::seam), pi / 2, Vector3(1, 0.3, 0).normalized());
    for (const Model& model : {funnel(65), table(), shelf(), at(sphere(5, true), 0, 0, 5), lying,
                               turned(torus(6, 2, true), 1.1, Vector3::UnitX())}) {
        for (const bool on_bed_only : {false, true}) {
            CAPTURE(on_bed_only);
            Options options = tree();
            options.profile.support.interface_layers = 0;
            options.profile.support.on_bed_only = on_bed_only;
            const Supported s(model, options);
            check_gaps_and_standing(s, 0.2 * std::tan(40 * pi / 180) + round_off_mm);
            CHECK(s.diagnostics.empty());
        }
    }
}

TEST_CASE(
    "support_tree 3: over layers of unequal thickness no branch that can reach the bed is taken "
    "back") {
    for (const Model& model : {funnel(65), shelf(), table()}) {
        Options options = tree();
        options.profile.support.interface_layers = 0;
        options.profile.support.on_bed_only = true;
        const Supported s(model, options, {0.2, 0.05, 0.3, 0.1});
        check_gaps_and_standing(s, 0.3 * std::tan(40 * pi / 180) + round_off_mm);
        CHECK(s.diagnostics.empty());
    }
}

TEST_CASE("support_tree: roofs of trees that stand on the bed anyway were cut down to their tips") {
    for (const Model& model : {table(), funnel(65)}) {
        Options options = tree();
        const double volume = Supported(model, options).volume_mm3();
        options.profile.support.on_bed_only = true;
        const Supported s(model, options);
        CHECK(s.volume_mm3() == doctest::Approx(volume).epsilon(0.01));
        CHECK(s.diagnostics.empty());
        options.profile.support.interface_layers = 0;
        CHECK(Supported(model, options).volume_mm3() < 0.9 * volume);
    }
}

TEST_CASE("support_tree 2, 4: tips are near to all that hangs over, and branches are circles") {
    for (const Model& model : {table(), shelf(), funnel(65)}) {
        Options options = tree();
        options.profile.support.interface_layers = 0;
        const Supported s(model, options), columns(model);
        std::size_t circles = 0, contours = 0;
        for (std::size_t i = 0; i < s.spans.size(); ++i) {
            for (const Contour& contour : s.plan.area(i)) {
                ++contours;
                circles += std::holds_alternative<FullCircle>(contour);
            }
            over(columns.plan.area(i), pitch_mm, [&](const Point2& p) {
                const bool begins = i + 1 == s.spans.size() || !columns.in_support(i + 1, p);
                if (!begins || columns.supports[i].is_near(p, 0.225)) return;
                // A tip's own circle is nearer than its middle.
                bool near = false;
                for (std::size_t k = i - std::min<std::size_t>(i, 10);
                     k < std::min(s.spans.size(), i + 10); ++k)
                    near = near || s.in_support(k, p) || s.supports[k].is_near(p, 1.25 * 3);
                if (!near) FAIL_CHECK("no tip near ", p.x(), ' ', p.y(), " in layer ", i);
            });
        }
        CHECK(circles > contours / 2);
        CHECK(s.volume_mm3() < 0.7 * columns.volume_mm3());
        CHECK(s.volume_mm3() > 0);
    }
}

TEST_CASE("support_tree 5: a roof of as many layers as asked for lies under an overhang") {
    Options options = tree();
    options.profile.support.interface_layers = 3;
    const Supported s(table(), options), columns(table());
    // The underside is at 7.9: its first layer begins at 7.8, over one of air.
    const std::size_t top = 37;
    CHECK(s.plan.area(top + 1).empty());
    for (std::size_t i = top - 2; i <= top; ++i)
        CHECK(area_mm2(s.plan.area(i)) >= doctest::Approx(area_mm2(columns.plan.area(i))));
    CHECK(area_mm2(s.plan.area(top - 3)) < 0.5 * area_mm2(columns.plan.area(top - 3)));
}

TEST_CASE("support 1: what hangs over lies over support") {
    CHECK(held_share(Supported(table()), anywhere) > 0.995);
    CHECK(held_share(Supported(shelf()), anywhere) > 0.995);
    CHECK(held_share(Supported(funnel(65)), anywhere) > 0.995);
    // Of a ball, what is below the circle of the limit; the layer through it may count to either side.
    const Supported ball(at(sphere(5, true), 0, 0, 5));
    const double division_mm = 5 - 5 * std::sin(50 * pi / 180);
    CHECK(held_share(ball, [&](const Point3& p) { return p.z() < division_mm - 0.3; }) > 0.995);
}

TEST_CASE("support 1: under a lying cylinder it is as wide as the arc beyond the limit") {
    const double radius = 6;
    const Supported s(turned(frustum(radius, radius, 15, Side::seam), pi / 2, Vector3::UnitX()));
    const double edge_mm = radius * std::cos(50 * pi / 180);
    double widest_mm = 0;
    for (std::size_t i = 0; i < s.spans.size(); ++i)
        for (const Contour& contour : s.plan.area(i))
            widest_mm = std::max(widest_mm, lyr::region::box_of(contour).max().x());
    // By how far support reaches out beside the part, within what the surface of the limit leans out in a layer.
    const double reach_mm = s.options.profile.skin.width_mm;
    CHECK(std::abs(widest_mm - edge_mm - reach_mm) < 0.2 * std::tan(50 * pi / 180));
}

TEST_CASE("support: the same wherever the part lies, and for its mirror image") {
    const Model part = together(funnel(60), at(table(), 20, 3, 0));
    const double volume = Supported(part).volume_mm3();
    CHECK(volume > 100);
    for (const double angle : {0.3, 2.0})
        CHECK(Supported(turned(part, angle, Vector3::UnitZ())).volume_mm3() ==
              doctest::Approx(volume).epsilon(2e-3));
    const Model mirrored = transformed(part, Eigen::Affine3d(Eigen::Scaling(-1.0, 1.0, 1.0)));
    CHECK(Supported(mirrored).volume_mm3() == doctest::Approx(volume).epsilon(2e-3));
}

TEST_CASE("support 1: bridges need none, unless they are long") {
    CHECK(Supported(bridge(8)).volume_mm3() == 0);
    CHECK(Supported(bridge(12)).volume_mm3() > 100);
}

TEST_CASE("support 1: none under a face that is blocked by its name or its instance") {
    Model part = table();
    SourceId underside = 0;
    for (std::size_t f = 0; f < part.faces.size(); ++f) {
        part.faces[f].source = 500 + f;
        const auto* plane = std::get_if<Plane>(&part.faces[f].surface);
        if (!plane || std::abs(plane->frame.origin.z() - 7.9) > 1e-9 ||
            plane->frame.z.head<2>().norm() > 0.5)
            continue;
        underside = part.faces[f].source;
        part.face_names[underside] = "under the table";
    }
    REQUIRE(underside > 0);
    Options options = grid();
    CHECK(Supported(part, options).volume_mm3() > 100);
    for (const std::string& name :
         {std::string("under the table"), '#' + std::to_string(underside)}) {
        options.profile.support.blockers = {name};
        CHECK(Supported(part, options).volume_mm3() == 0);
    }
    options.profile.support.blockers = {"under teh table"};
    const auto refused = blocked_faces(part, options.profile.support);
    REQUIRE(!refused);
    CHECK(refused.error().message.find("did you mean \"under the table\"?") != std::string::npos);
    CHECK(refused.error().status == ExitStatus::usage);
    // A funnel that is of two faces is held under the one that is not blocked.
    Model half = funnel(65);
    for (std::size_t f = 0; f < half.faces.size(); ++f) half.faces[f].source = 500 + f;
    const double whole_mm3 = Supported(half, grid()).volume_mm3();
    for (std::size_t f = 0; f < half.faces.size(); ++f) {
        if (!std::holds_alternative<Cone>(half.faces[f].surface)) continue;
        options.profile.support.blockers = {"#" + std::to_string(500 + f)};
        const double volume = Supported(half, options).volume_mm3();
        CHECK(volume > 0.45 * whole_mm3);
        CHECK(volume < 0.55 * whole_mm3);
    }
}

TEST_CASE("support 4: an overhang with no room under it is warned of") {
    // The plate is so near to the post's foot that support does not fit between.
    const Model part = together(upright(4, 0, 3), at(frustum(1, 1, 8, Side::seam), 0, 0, 4));
    const Model over_foot = together(part, upright(3.5, 3.25, 5));
    const Supported s(over_foot);
    REQUIRE(s.diagnostics.size() == 1);
    CHECK(s.diagnostics[0].message.find("no room for support") != std::string::npos);
    CHECK(s.diagnostics[0].where.layer > 0);
}

TEST_CASE("support 2: over a foot as large as the roof it reaches out no farther than the foot") {
    const Model part = together(table(), at(box(14, 10, 2), 0, 0, 1));
    // A smaller gap leaves room for support on the bed beside the foot.
    for (const double gap_xy_mm : {0.4, 0.8, 2.0})
        for (const double turn_rad : {0.0, 0.6}) {
            Options options = grid();
            options.profile.support.gap_xy_mm = gap_xy_mm;
            const Supported s(turned(part, turn_rad, Vector3::UnitZ()), options);
            CHECK(s.volume_mm3() > 100);
            // Where the foot is, no line fits beside it.
            for (std::size_t i = 0; i < s.spans.size(); ++i)
                over(s.spans[i].bottom_mm < 2 ? Region() : s.plan.area(i), 0.1,
                     [&](const Point2& p) {
                         if (!s.in_part(2, p) && !s.parts[2].is_near(p, round_off_mm))
                             FAIL_CHECK("support of layer ", i, " is beside the foot");
                     });
        }
}

TEST_CASE("support 2: the uppermost layers of a slope have room for a line under them") {
    for (const double degrees : {35.0, 45.0, 60.0})
        for (const double gap_mm : {0.2, 0.4, 0.8, 2.0}) {
            CAPTURE(degrees);
            CAPTURE(gap_mm);
            Options options = grid();
            options.profile.support.angle_deg = 30;
            options.profile.support.gap_xy_mm = gap_mm;
            const Supported s(funnel(degrees), options);
            CHECK(s.diagnostics.empty());
            std::size_t highest = 0;
            for (std::size_t i = 0; i < s.spans.size(); ++i)
                if (!s.plan.area(i).empty()) highest = i;
            // Two layers below the top one, for the gap.
            CHECK(highest + 3 == s.spans.size());
        }
}

TEST_CASE("support: between its parts the head goes around the part") {
    const std::string lyr = scratch("table.lyr");
    Diagnostics diagnostics;
    REQUIRE(print(
        table(), "table", lyr, "", grid(), [](const char*, std::size_t, std::size_t) {},
        diagnostics));
    auto reader = format::Reader::open(lyr);
    REQUIRE(reader);
    const double quantum_mm = reader->header().quantum.nm * 1e-6;
    // The post's middle is that of the plate, whose corner is at the origin.
    const auto from_post = [&](const format::Point& point) {
        return Point2(quantum_mm * static_cast<double>(point.x) - 7,
                      quantum_mm * static_cast<double>(point.y) - 5);
    };
    std::size_t around = 0;
    bool in_support = false;
    for (;;) {
        const auto next = reader->next();
        REQUIRE(next);
        if (!*next) break;
        if (std::holds_alternative<format::LayerStart>(**next)) in_support = false;
        if (const auto* start = std::get_if<format::PathStart>(&**next))
            in_support = start->style.role == format::Role::support;
        const auto* travel = std::get_if<format::Travel>(&**next);
        if (!travel || !in_support || travel->hatch) continue;
        const Point2 from = from_post(travel->from), to = from_post(travel->to);
        if (to.norm() < 2 || from == to) continue;  // to the part's own wall
        const Vector2 way = to - from;
        const double share = std::clamp(-from.dot(way) / way.squaredNorm(), 0.0, 1.0);
        const double reach_mm = (from + share * way).norm();
        CHECK(reach_mm > 2 - 0.01);
        around += reach_mm < 2.3;
    }
    CHECK(around > 10);
}
