// One pass over the operations. The bytes of an operation are those that the reader took to give it
// out: the head of a run of lines or arcs counts to its first one.

#include "format/export/statistics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "format/arc.h"

namespace lyr::format {
namespace {

double climb(const Point& from, const Point& to) {
    return static_cast<double>(to.z - from.z);
}

double straight(const Point& from, const Point& to) {
    return std::hypot(static_cast<double>(to.x - from.x), static_cast<double>(to.y - from.y),
                      climb(from, to));
}

class Counter {
public:
    Counter(const Reader& reader, Statistics& out)
        : reader_(reader), out_(out), mm_(reader.header().quantum.mm(1)) {}

    void take(const Operation& operation) {
        const ReadPosition position = reader_.position();
        bytes_ = position.end - position.offset;
        std::visit([&](const auto& one) { count(one); }, operation);
    }

private:
    void add(KindStatistics& kind) {
        ++kind.count;
        kind.bytes += bytes_;
    }

    RoleStatistics& role() { return out_.roles[static_cast<std::size_t>(reader_.path().role)]; }

    void extrude(double length_quanta) {
        const PathStyle& style = reader_.path();
        const double length_mm = length_quanta * mm_;
        role().length_mm += length_mm;
        role().volume_mm3 += length_mm * cross_section_mm2(style);
        if (!(style.speed_mm_s > 0)) return;
        role().moving_time_s += length_mm / style.speed_mm_s;
        out_.moving_time_s += length_mm / style.speed_mm_s;
    }

    void travel(double length_quanta) {
        const double length_mm = length_quanta * mm_;
        out_.travel_mm += length_mm;
        if (travel_speed_mm_s_ > 0) out_.moving_time_s += length_mm / travel_speed_mm_s_;
    }

    // A retraction may come in parts.
    void draw_back(double depth_mm) {
        if (depth_mm > 0 && !drawn_back_) ++out_.retractions;
        drawn_back_ = depth_mm > 0;
    }

    void count(const LayerStart&) {
        add(out_.layer_heads);
        const Layer& layer = reader_.layer();
        const double z_mm = layer.state.z_mm, height_mm = layer.state.height_mm;
        const bool first = out_.layers == 0;
        out_.lowest_layer_mm = first ? z_mm : std::min(out_.lowest_layer_mm, z_mm);
        out_.highest_layer_mm = first ? z_mm : std::max(out_.highest_layer_mm, z_mm);
        out_.least_height_mm = first ? height_mm : std::min(out_.least_height_mm, height_mm);
        out_.most_height_mm = first ? height_mm : std::max(out_.most_height_mm, height_mm);
        ++out_.layers;
        out_.chunks += layer.totals.chunks;
        out_.operations += layer.totals.operations;
        travel_speed_mm_s_ = layer.state.travel_speed_mm_s;
        drawn_back_ = layer.state.retracted_mm > 0;
        for (const HeaterTarget& target : layer.state.temperatures)
            heat(target.heater, target.target_c);
    }
    void heat(const Heater& heater, double target_c) {
        if (heater.kind == HeaterKind::tool)
            out_.hottest_tool_c = std::max(out_.hottest_tool_c, target_c);
        if (heater.kind == HeaterKind::bed)
            out_.hottest_bed_c = std::max(out_.hottest_bed_c, target_c);
    }

    void count(const PathStart&) {
        add(out_.paths);
        ++role().paths;
    }
    void count(const Line& line) {
        add(line.hatch ? out_.hatch_lines : out_.lines);
        ++(line.hatch ? role().hatch_lines : role().lines);
        extrude(straight(line.from, line.to));
    }
    void count(const Arc& arc) {
        add(out_.arcs);
        ++role().arcs;
        extrude(std::hypot(arc_shape(arc).length(), climb(arc.from, arc.to)));
    }
    void count(const Circle& circle) {
        add(out_.circles);
        ++role().circles;
        const double radius = std::hypot(static_cast<double>(circle.from.x - circle.center_x),
                                         static_cast<double>(circle.from.y - circle.center_y));
        extrude(std::hypot(2 * std::numbers::pi * radius, climb(circle.from, circle.to)));
    }
    void count(const Travel& travel) {
        if (travel.hatch) {
            ++out_.hatch_travels;
            out_.hatch_lines.bytes += bytes_;
        } else {
            add(out_.travels);
        }
        this->travel(straight(travel.from, travel.to));
    }
    void count(const Wipe& wipe) {
        add(out_.wipes);
        draw_back(wipe.depth_mm);
        travel(wipe.sagitta == 0 ? straight(wipe.from, wipe.to)
                                 : arc_shape(Arc{wipe.from, wipe.to, wipe.sagitta}).length());
    }
    void count(const HatchStart&) {
        ++out_.hatch_runs;
        out_.hatch_lines.bytes += bytes_;
    }
    void count(const Width&) { add(out_.settings); }
    void count(const Speed&) { add(out_.settings); }
    void count(const Acceleration&) { add(out_.settings); }
    void count(const TravelSpeed& speed) {
        add(out_.settings);
        travel_speed_mm_s_ = speed.speed_mm_s;
    }
    void count(const TravelAcceleration&) { add(out_.settings); }
    void count(const Retract& retract) {
        add(out_.rest);
        draw_back(retract.depth_mm);
    }
    void count(const Temperature& temperature) {
        add(out_.rest);
        heat(temperature.heater, temperature.target_c);
    }
    void count(const Dwell& dwell) {
        add(out_.rest);
        out_.dwell_time_s += dwell.time_ms / 1e3;
    }
    void count(const Fan&) { add(out_.rest); }
    void count(const Tool&) { add(out_.rest); }
    void count(const Pause&) { add(out_.rest); }
    void count(const Object&) { add(out_.rest); }

    const Reader& reader_;
    Statistics& out_;
    double mm_;
    double travel_speed_mm_s_ = 0;
    bool drawn_back_ = false;
    std::uint64_t bytes_ = 0;
};

}  // namespace

Result<Statistics> statistics_of(Reader& reader) {
    Statistics out;
    out.header = reader.header();
    Counter counter(reader, out);
    for (;;) {
        const Result<std::optional<Operation>> next = reader.next();
        if (!next) return next.error();
        if (!*next) break;
        counter.take(**next);
    }
    out.bytes = reader.position().end;
    std::uint64_t counted = 0;
    for (const KindStatistics* kind :
         {&out.lines, &out.arcs, &out.circles, &out.hatch_lines, &out.travels, &out.wipes,
          &out.paths, &out.settings, &out.layer_heads})
        counted += kind->bytes;
    // The file's frame: prologue, metadata, heads of chunks, index, end.
    out.rest.bytes = out.bytes - counted;
    return out;
}

}  // namespace lyr::format
