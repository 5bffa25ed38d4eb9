#include "kernel/region/winding_count.h"

namespace lyr::region {
namespace {

std::vector<Box2> boxes_of(std::span<const Source> sources) {
    std::vector<Box2> boxes;
    for (const Source& source : sources) boxes.push_back(bounds_of(source.curve));
    return boxes;
}

// For a point in the height of a curve that rises or falls: the curve's end is above it, the start not, or the reverse.
bool is_left_of(const Point2& point, const Curve& curve) {
    const bool rises = curve.end.y() > curve.start.y();
    const Point2 &low = rises ? curve.start : curve.end, &high = rises ? curve.end : curve.start;
    const bool right_of_chord = cross(point - low, high - low) > 0;
    const bool bends_right = (curve.curvature_per_mm > 0) == rises;
    if (curve.curvature_per_mm == 0 || right_of_chord != bends_right) return !right_of_chord;
    return (across_mm(curve, point) > 0) != rises;
}

}  // namespace

WindingCount::WindingCount(std::span<const Input> inputs, std::span<const Source> sources)
    : inputs_(inputs), sources_(sources), tree_(boxes_of(sources), BoxOrder::along_contours) {}

Winding WindingCount::at(const Point2& point) const {
    Winding sum;
    const Point2 far(tree_.bounds().max().x() + 1, point.y());
    if (!(far.x() > point.x())) return sum;
    tree_.meeting({point, far}, [&](std::uint32_t s) {
        const Curve& curve = sources_[s].curve;
        const bool starts_above = curve.start.y() > point.y();
        if (starts_above == (curve.end.y() > point.y())) return;
        const Winding& inside = inputs_[sources_[s].contour].weight;
        if (is_left_of(point, curve)) sum = starts_above ? sum - inside : sum + inside;
    });
    return sum;
}

bool WindingCount::is_near(const Point2& point, double within_mm) const {
    const Vector2 margin(within_mm, within_mm);
    return tree_.any({point - margin, point + margin},
                     [&](std::uint32_t s) { return passes(sources_[s].curve, point, within_mm); });
}

}  // namespace lyr::region
