// Motions that follow each other with one role and width are one group of strokes. A group is
// defined once and stroked twice: at its true width, and narrower and lighter on top, so that
// strands show.

#include "format/export/svg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "format/arc.h"
#include "format/export/svg_page.h"
#include "format/export/svg_text.h"

namespace lyr::format {
namespace {

// The lighter stroke's share of the width.
constexpr double core_share = 0.7;
// Of a travel's line: wipes lie upon what was printed.
constexpr double wipe_width = 2;
// Of the groups of a picture of one layer.
const std::string single_prefix = "s";

struct Group {
    Role role = Role::other;
    double width_mm = 0;
    std::string path, circles;  // a path's data; <circle> elements
};

class Strokes {
public:
    explicit Strokes(Quantum quantum) : quantum_(quantum) {}

    void add(const Operation& operation, const PathStyle& style) {
        if (const auto* line = std::get_if<Line>(&operation)) {
            Group& group = group_of(style);
            reach(line->from, group);
            group.path += 'L';
            append_point(group.path, line->to.x, line->to.y);
            moved(line->to, segment_mm(line->from, line->to), style);
        } else if (const auto* arc = std::get_if<Arc>(&operation)) {
            add_arc(*arc, style);
        } else if (const auto* circle = std::get_if<Circle>(&operation)) {
            add_circle(*circle, style);
        } else if (const auto* travel = std::get_if<Travel>(&operation)) {
            append_move(travels_, travel->from);
            travels_ += 'L';
            append_point(travels_, travel->to.x, travel->to.y);
            travel_mm_ += segment_mm(travel->from, travel->to);
        } else if (const auto* wipe = std::get_if<Wipe>(&operation)) {
            add_wipe(*wipe);
        }
    }

    const std::vector<Group>& groups() const { return groups_; }
    const std::string& travels() const { return travels_; }
    const std::string& wipes() const { return wipes_; }
    double travel_mm() const { return travel_mm_; }
    double wipe_mm() const { return wipe_mm_; }
    const std::array<double, role_count>& length_mm() const { return length_mm_; }

private:
    Group& group_of(const PathStyle& style) {
        if (groups_.empty() || groups_.back().role != style.role ||
            groups_.back().width_mm != style.width_mm) {
            groups_.push_back({style.role, style.width_mm, {}, {}});
            drawing_ = false;
        }
        return groups_.back();
    }

    void append_point(std::string& out, std::int64_t x, std::int64_t y) const {
        append_mm(out, x, quantum_);
        out += ' ';
        append_mm(out, y, quantum_);
    }

    void append_move(std::string& out, const Point& point) const {
        out += 'M';
        append_point(out, point.x, point.y);
    }

    // The pen goes to a point without drawing, unless it is there.
    void reach(const Point& point, Group& group) {
        if (drawing_ && point.x == at_.x && point.y == at_.y) return;
        append_move(group.path, point);
    }

    void moved(const Point& to, double length_mm, const PathStyle& style) {
        drawing_ = true;
        at_ = to;
        length_mm_[static_cast<std::size_t>(style.role)] += length_mm;
    }

    double segment_mm(const Point& from, const Point& to) const {
        return std::hypot(static_cast<double>(to.x - from.x), static_cast<double>(to.y - from.y)) *
               quantum_.mm(1);
    }

    void add_arc(const Arc& arc, const PathStyle& style) {
        Group& group = group_of(style);
        reach(arc.from, group);
        moved(arc.to, append_arc(group.path, arc), style);
    }

    // Its length in mm.
    double append_arc(std::string& out, const Arc& arc) const {
        const ArcShape shape = arc_shape(arc);
        std::string radius;
        append_number(radius, shape.radius * quantum_.mm(1));
        const bool large = std::abs(shape.sweep_rad) > std::numbers::pi;
        out += 'A' + radius + ' ' + radius + " 0 ";
        out += large ? '1' : '0';
        // The drawing's y points up, so that a positive angle is counter-clockwise.
        out += shape.sweep_rad > 0 ? " 1 " : " 0 ";
        append_point(out, arc.to.x, arc.to.y);
        return shape.length() * quantum_.mm(1);
    }

    void add_wipe(const Wipe& wipe) {
        append_move(wipes_, wipe.from);
        if (wipe.sagitta != 0) {
            wipe_mm_ += append_arc(wipes_, Arc{wipe.from, wipe.to, wipe.sagitta});
        } else {
            wipes_ += 'L';
            append_point(wipes_, wipe.to.x, wipe.to.y);
            wipe_mm_ += segment_mm(wipe.from, wipe.to);
        }
    }

    void add_circle(const Circle& circle, const PathStyle& style) {
        Group& group = group_of(style);
        const double radius_mm = segment_mm({circle.center_x, circle.center_y, 0}, circle.from);
        group.circles += "<circle cx=\"";
        append_mm(group.circles, circle.center_x, quantum_);
        group.circles += "\" cy=\"";
        append_mm(group.circles, circle.center_y, quantum_);
        group.circles += "\" r=\"";
        append_number(group.circles, radius_mm);
        group.circles += "\"/>";
        const double length_mm = 2 * std::numbers::pi * radius_mm;
        length_mm_[static_cast<std::size_t>(style.role)] += length_mm;
    }

    Quantum quantum_;
    std::vector<Group> groups_;
    std::string travels_, wipes_;
    double travel_mm_ = 0, wipe_mm_ = 0;
    std::array<double, role_count> length_mm_{};
    Point at_;
    bool drawing_ = false;
};

void append_stroke(std::string& out, const std::string& group, const std::string& color,
                   double width_mm) {
    out += "<use xlink:href=\"#" + group + "\" stroke=\"" + color + "\" stroke-width=\"";
    append_number(out, width_mm);
    out += "\"/>\n";
}

// Walls are what one looks for, and a fill that reaches under them would hide them.
std::vector<std::size_t> walls_last(const std::vector<Group>& groups) {
    std::vector<std::size_t> order(groups.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_partition(order.begin(), order.end(), [&](std::size_t i) {
        return groups[i].role != Role::outer_wall && groups[i].role != Role::inner_wall &&
               groups[i].role != Role::overhang_wall && groups[i].role != Role::thin_wall;
    });
    return order;
}

// `prefix` tells groups of one layer from those of others.
std::string strokes_text(const Strokes& strokes, const SvgOptions& options, double thin_mm,
                         const std::string& prefix) {
    std::string out = "<defs>\n";
    for (std::size_t i = 0; i < strokes.groups().size(); ++i) {
        const Group& group = strokes.groups()[i];
        out += "<g id=\"" + prefix + std::to_string(i) + "\">";
        if (!group.path.empty()) out += "<path d=\"" + group.path + "\"/>";
        out += group.circles + "</g>\n";
    }
    out +=
        "</defs>\n<g transform=\"scale(1 -1)\" fill=\"none\" stroke-linecap=\"round\" "
        "stroke-linejoin=\"round\">\n";
    for (const std::size_t i : walls_last(strokes.groups())) {
        const Group& group = strokes.groups()[i];
        out += "<g><title>" + std::string(name_of(group.role)) + "</title>\n";
        append_stroke(out, prefix + std::to_string(i), darker(color_of(group.role)),
                      group.width_mm);
        append_stroke(out, prefix + std::to_string(i), std::string(color_of(group.role)),
                      core_share * group.width_mm);
        out += "</g>\n";
    }
    if (options.travels && !strokes.travels().empty()) {
        std::string width, dash;
        append_number(width, thin_mm);
        append_number(dash, 4 * thin_mm);
        out += "<path id=\"" + (prefix == single_prefix ? "" : prefix) + "travels\" d=\"" +
               strokes.travels() + "\" stroke=\"" + std::string(travel_color) +
               "\" stroke-width=\"" + width + "\" stroke-dasharray=\"" + dash +
               "\" stroke-linecap=\"butt\"/>\n";
    }
    if (options.travels && !strokes.wipes().empty()) {
        std::string width;
        append_number(width, wipe_width * thin_mm);
        out += "<path id=\"" + (prefix == single_prefix ? "" : prefix) + "wipes\" d=\"" +
               strokes.wipes() + "\" stroke=\"" + std::string(wipe_color) + "\" stroke-width=\"" +
               width + "\"/>\n";
    }
    return out + "</g>\n";
}

// Of an object, if it has a name, else of the file's source.
std::string name_of(const Metadata& metadata, std::uint32_t object) {
    const bool is_named = object > 0 && object <= metadata.objects.size();
    return is_named ? metadata.objects[object - 1] : metadata.source_name;
}

PageFrame frame_of(const Reader& reader) {
    const Quantum quantum = reader.header().quantum;
    const Summary& summary = reader.header().summary;
    const Bounds& motion = reader.layer().totals.motion;
    return {std::min(summary.low_x_mm, quantum.mm(motion.low.x)),
            std::min(summary.low_y_mm, quantum.mm(motion.low.y)),
            std::max(summary.high_x_mm, quantum.mm(motion.high.x)),
            std::max(summary.high_y_mm, quantum.mm(motion.high.y))};
}

}  // namespace

Result<std::string> layer_svg(Reader& reader, std::uint32_t layer, const SvgOptions& options) {
    if (Status sought = reader.seek_layer(layer); !sought) return sought.error();
    Strokes strokes(reader.header().quantum);
    Layer shown;
    bool of_several = false;
    for (bool begun = false;;) {
        const Result<std::optional<Operation>> next = reader.next();
        if (!next) return next.error();
        if (!*next) break;
        if (std::holds_alternative<LayerStart>(**next)) {
            if (begun) break;
            begun = true;
            shown = reader.layer();
        }
        if (const auto* object = std::get_if<Object>(&**next))
            of_several = of_several || object->object != shown.state.object;
        strokes.add(**next, reader.path());
    }
    const std::string name = name_of(reader.header().metadata, of_several ? 0 : shown.state.object);
    PageContent content{shown.index, reader.header(), shown, name, {}, {}};
    for (std::size_t i = 0; i < role_count; ++i)
        if (strokes.length_mm()[i] > 0)
            content.legend.push_back({std::string(name_of(static_cast<Role>(i))),
                                      std::string(color_of(static_cast<Role>(i))),
                                      strokes.length_mm()[i], false});
    if (options.travels && strokes.travel_mm() > 0)
        content.legend.push_back({"travel", std::string(travel_color), strokes.travel_mm(), true});
    if (options.travels && strokes.wipe_mm() > 0)
        content.legend.push_back({"wipe", std::string(wipe_color), strokes.wipe_mm(), false});
    const PageFrame frame = frame_of(reader);
    content.drawing = strokes_text(strokes, options, thin_line_mm(frame), single_prefix);
    return page_text(frame, content);
}

Status print_svg(Reader& reader, const SvgOptions& options, const Sink& take) {
    const Summary& sum = reader.header().summary;
    const PageFrame frame{sum.low_x_mm, sum.low_y_mm, sum.high_x_mm, sum.high_y_mm};
    take(page_head(frame, escaped_xml(reader.header().metadata.source_name)));
    std::optional<Layer> layer;
    Strokes strokes(reader.header().quantum);
    const auto end_layer = [&] {
        if (!layer) return;
        std::string z, text = "<g inkscape:groupmode=\"layer\" inkscape:label=\"";
        append_number(z, layer->state.z_mm);
        text += std::to_string(layer->index + 1) + ", z = " + z + " mm\" id=\"layer" +
                std::to_string(layer->index + 1) + '"' +
                (layer->index > 0 ? " style=\"display:none\">\n" : ">\n");
        take(text +
             strokes_text(strokes, options, thin_line_mm(frame),
                          'l' + std::to_string(layer->index + 1) + '-') +
             "</g>\n");
        strokes = Strokes(reader.header().quantum);
    };
    while (const Operation* operation = reader.read()) {
        if (std::holds_alternative<LayerStart>(*operation)) {
            end_layer();
            layer = reader.layer();
        }
        strokes.add(*operation, reader.path());
    }
    if (reader.error()) return *reader.error();
    end_layer();
    take("</svg>\n");
    return Done{};
}

}  // namespace lyr::format
