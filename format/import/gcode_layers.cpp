#include "format/import/gcode_layers.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/constants.h"
#include "format/import/gcode_import.h"
#include "format/import/gcode_strand.h"

namespace lyr::format {
namespace {

// A print may not go on at a height that is no finer stated than this.
constexpr double same_z_mm = 1e-6;
constexpr double widest_arc_rad = 1.5 * std::numbers::pi;
// Of a layer whose file says nothing of it and that lies on no other.
constexpr double usual_height_mm = 0.2;
// No strand is thicker: what is pushed on so short a way is pushed aside.
constexpr double largest_strand_mm2 = 1e4;

bool is_same_height(double a_mm, double b_mm) {
    return std::abs(a_mm - b_mm) < same_z_mm;
}

GcodePoint on_arc(const GcodeGo& go, double share) {
    const double angle = share * go.sweep_rad;
    const double dx = go.from.x - go.center_x, dy = go.from.y - go.center_y;
    return {go.center_x + dx * std::cos(angle) - dy * std::sin(angle),
            go.center_y + dx * std::sin(angle) + dy * std::cos(angle),
            go.from.z + share * (go.to.z - go.from.z)};
}

// Of a part of the arc, in its sense.
double sagitta_mm(const GcodeGo& go, double share) {
    const double radius = std::hypot(go.from.x - go.center_x, go.from.y - go.center_y);
    const double height = radius * (1 - std::cos(share * go.sweep_rad / 2));
    return go.sweep_rad > 0 ? height : -height;
}

template <class Take>
void in_parts(const GcodeGo& go, double widest_rad, Take&& take) {
    const auto count =
        static_cast<int>(std::max(1.0, std::ceil(std::abs(go.sweep_rad) / widest_rad)));
    for (int i = 1; i <= count; ++i)
        take(i == count ? go.to : on_arc(go, static_cast<double>(i) / count), 1.0 / count);
}

const GcodeGo* first_extrusion(const GcodeLayer& layer) {
    for (const GcodeItem& item : layer.items)
        if (const auto* go = std::get_if<GcodeGo>(&item); go && go->extrudes()) return go;
    return nullptr;
}

}  // namespace

GcodeLayers::GcodeLayers(Writer& writer, Quantum quantum, double filament_diameter_mm)
    : writer_(writer),
      quantum_(quantum),
      filament_area_mm2_(std::numbers::pi / 4 * filament_diameter_mm * filament_diameter_mm) {}

void GcodeLayers::set(const Operation& operation) {
    if (const auto* heat = std::get_if<Temperature>(&operation)) {
        Bounded<HeaterTarget, 16> targets;
        bool known = false;
        for (HeaterTarget target : machine_.temperatures) {
            if (target.heater == heat->heater) {
                target.target_c = heat->target_c;
                known = true;
            }
            targets.push_back(target);
        }
        if (!known && !targets.push_back({heat->heater, heat->target_c})) left_out_ = true;
        machine_.temperatures = targets;
    } else if (const auto* fan = std::get_if<Fan>(&operation)) {
        const auto known = std::find_if(machine_.fans.begin(), machine_.fans.end(),
                                        [&](const Fan& other) { return other.fan == fan->fan; });
        if (known != machine_.fans.end())
            known->duty = fan->duty;
        else
            machine_.fans.push_back(*fan);
    } else if (const auto* tool = std::get_if<Tool>(&operation)) {
        machine_.tool = tool->tool;
    } else if (const auto* object = std::get_if<Object>(&operation)) {
        machine_.object = object->object;
    }
}

// A layer has one speed for either way.
void GcodeLayers::note_speeds(const std::vector<GcodeItem>& items) {
    double before_mm = machine_.drawn_back_mm;
    bool retracts = false, unretracts = false;
    for (const GcodeItem& item : items) {
        if (const auto* go = std::get_if<GcodeGo>(&item)) before_mm = go->drawn_back_mm;
        const auto* draw = std::get_if<GcodeDraw>(&item);
        if (!draw) continue;
        const bool back = draw->depth_mm > before_mm;
        machine_.retract_length_mm = std::max(machine_.retract_length_mm, draw->depth_mm);
        double& speed_mm_s = back ? machine_.retract_mm_s : machine_.unretract_mm_s;
        if (draw->depth_mm == before_mm) continue;
        if (std::exchange(back ? retracts : unretracts, true))
            speeds_differ_ = speeds_differ_ || speed_mm_s != draw->speed_mm_s;
        else
            speed_mm_s = draw->speed_mm_s;
        before_mm = draw->depth_mm;
    }
}

double GcodeLayers::layer_z_mm(const GcodeLayer& layer) const {
    if (const GcodeGo* extrusion = first_extrusion(layer)) return extrusion->from.z;
    return layer.stated_z_mm.value_or(layer.begin.z);
}

// The first items of a layer lead to its height. Those before go to the layer below; a way that a layer's start implies
// is left out; settings are of the state. What is left to do in the layer.
std::vector<GcodeItem> GcodeLayers::begin_items(GcodeLayer& layer, double z_mm, LayerState& state) {
    GcodePoint at = layer.begin;
    std::vector<GcodeItem> below, left;
    std::size_t i = 0;
    const auto is_wait = [](const Operation& operation) {
        const auto* heat = std::get_if<Temperature>(&operation);
        return std::holds_alternative<Dwell>(operation) ||
               std::holds_alternative<Pause>(operation) || (heat && heat->wait);
    };
    double travel_mm_s = 0, travel_mm_s2 = 0;
    bool arrives = is_same_height(at.z, z_mm), moved = false;
    for (; i < layer.items.size(); ++i) {
        const GcodeItem& item = layer.items[i];
        if (const auto* operation = std::get_if<Operation>(&item)) {
            if (is_wait(*operation) && waits_) {
                if (arrives) break;
                below.push_back(item);
            } else if (std::holds_alternative<Dwell>(*operation) ||
                       std::holds_alternative<Pause>(*operation)) {
                left.push_back(item);  // there is no layer below
            }
            set(*operation);
        } else if (const auto* draw = std::get_if<GcodeDraw>(&item)) {
            if (moved && arrives) break;
            if (!arrives) below.push_back(item);
            machine_.drawn_back_mm = draw->depth_mm;
        } else {
            const GcodeGo& go = std::get<GcodeGo>(item);
            if (go.extrudes() || (arrives && !go.travels())) break;
            moved = true;
            const bool upright = go.from.x == go.to.x && go.from.y == go.to.y;
            if (go.travels()) travel_mm_s = go.speed_mm_s, travel_mm_s2 = go.acceleration_mm_s2;
            // From a lower place the start is reached by going up, then across.
            if (arrives) {
                const bool across = is_same_height(go.to.z, z_mm);
                if (across) at = go.to, ++i;
                break;
            }
            arrives = is_same_height(go.to.z, z_mm);
            if (!arrives || !upright || !go.travels()) below.push_back(item);
            at = go.to;
            machine_.drawn_back_mm = go.drawn_back_mm;
        }
    }
    if (waits_) waits_->items.insert(waits_->items.end(), below.begin(), below.end());
    state.start_x_mm = at.x;
    state.start_y_mm = at.y;
    if (travel_mm_s > 0) state.travel_speed_mm_s = travel_mm_s;
    state.travel_acceleration_mm_s2 = std::round(travel_mm_s2);
    left.insert(left.end(), layer.items.begin() + static_cast<std::ptrdiff_t>(i),
                layer.items.end());
    return left;
}

GcodeLayers::Begun GcodeLayers::begin(GcodeLayer layer) {
    Begun begun;
    const double z_mm = layer_z_mm(layer);
    LayerState& state = begun.state;
    if (waits_) state.travel_speed_mm_s = waits_->state.travel_speed_mm_s;
    begun.items = begin_items(layer, z_mm, state);
    note_speeds(begun.items);
    state.z_mm = z_mm;
    const double above_mm = z_mm - below_z_mm_ > same_z_mm ? z_mm - below_z_mm_ : z_mm;
    state.height_mm =
        layer.stated_height_mm.value_or(above_mm >= thinnest_mm ? above_mm : usual_height_mm);
    below_z_mm_ = z_mm;
    state.tool = machine_.tool;
    state.object = machine_.object;
    state.retracted_mm = machine_.drawn_back_mm;
    state.retract_length_mm = machine_.retract_length_mm;
    state.retract_speed_mm_s = machine_.retract_mm_s;
    state.unretract_speed_mm_s = machine_.unretract_mm_s;
    state.temperatures = machine_.temperatures;
    for (const Fan& fan : machine_.fans) left_out_ = !state.fans.push_back(fan) || left_out_;
    begun.travel_mm_s = state.travel_speed_mm_s;
    begun.travel_mm_s2 = state.travel_acceleration_mm_s2;
    begun.at = {state.start_x_mm, state.start_y_mm, z_mm};
    // As the machine is behind this layer.
    for (const GcodeItem& item : begun.items) {
        if (const auto* operation = std::get_if<Operation>(&item)) set(*operation);
        if (const auto* draw = std::get_if<GcodeDraw>(&item))
            machine_.drawn_back_mm = draw->depth_mm;
        if (const auto* go = std::get_if<GcodeGo>(&item))
            machine_.drawn_back_mm = go->drawn_back_mm;
    }
    return begun;
}

Status GcodeLayers::add(GcodeLayer layer) {
    Begun begun = begin(std::move(layer));
    std::optional<Begun> below = std::exchange(waits_, std::nullopt);
    waits_ = std::move(begun);
    return below ? write(std::move(*below)) : Status(Done{});
}

Status GcodeLayers::finish() {
    if (!waits_) return Done{};
    Begun last = std::move(*waits_);
    waits_.reset();
    return write(std::move(last));
}

Status GcodeLayers::write(Begun layer) {
    LayerEncoder encoder(quantum_, layer.state);
    wiped_ = false;
    for (std::size_t i = 0; i < layer.items.size(); ++i) {
        encode(layer.items[i], encoder, layer);
        const auto* next =
            i + 1 < layer.items.size() ? std::get_if<GcodeGo>(&layer.items[i + 1]) : nullptr;
        if (wipe_.empty() || (next && next->wipes())) continue;
        encoder.wipe(wipe_, wipe_depth_mm_);
        encoder.retract_to(wipe_depth_mm_);
        wipe_.clear();
        wiped_ = true;
    }
    auto encoded = encoder.finish();
    if (!encoded) return encoded.error();
    return writer_.append(*encoded);
}

void GcodeLayers::encode(const GcodeItem& item, LayerEncoder& encoder, Begun& layer) {
    if (const auto* go = std::get_if<GcodeGo>(&item)) {
        if (go->extrudes())
            encode_extrusion(*go, encoder, layer);
        else if (go->wipes())
            encode_wipe(*go, encoder, layer);
        else
            encode_travel(*go, encoder, layer);
        layer.at = go->to;
    } else if (const auto* draw = std::get_if<GcodeDraw>(&item)) {
        encoder.retract_to(draw->depth_mm);
    } else {
        const Operation& operation = std::get<Operation>(item);
        if (const auto* heat = std::get_if<Temperature>(&operation))
            encoder.temperature(heat->heater, heat->target_c, heat->wait);
        if (const auto* fan = std::get_if<Fan>(&operation)) encoder.fan(fan->fan, fan->duty);
        if (const auto* dwell = std::get_if<Dwell>(&operation)) encoder.dwell(dwell->time_ms);
        if (const auto* tool = std::get_if<Tool>(&operation)) encoder.tool(tool->tool);
        if (const auto* pause = std::get_if<Pause>(&operation)) encoder.pause(pause->reason);
        if (const auto* object = std::get_if<Object>(&operation)) encoder.object(object->object);
    }
}

void GcodeLayers::set_travel(const GcodeGo& go, LayerEncoder& encoder, Begun& layer) {
    if (go.speed_mm_s > 0 && go.speed_mm_s != layer.travel_mm_s) {
        layer.travel_mm_s = go.speed_mm_s;
        encoder.travel_speed(go.speed_mm_s);
    }
    const double mm_s2 = std::round(go.acceleration_mm_s2);
    if (mm_s2 == layer.travel_mm_s2) return;
    layer.travel_mm_s2 = mm_s2;
    encoder.travel_acceleration(mm_s2);
}

void GcodeLayers::encode_travel(const GcodeGo& go, LayerEncoder& encoder, Begun& layer) {
    set_travel(go, encoder, layer);
    wiped_ = false;
    if (go.sweep_rad == 0) {
        encoder.travel_to(go.to.x, go.to.y, go.to.z);
        return;
    }
    const double radius = std::hypot(go.from.x - go.center_x, go.from.y - go.center_y);
    in_parts(go, 2 * std::acos(std::max(0.0, 1 - arc_travel_mm / radius)),
             [&](const GcodePoint& to, double) { encoder.travel_to(to.x, to.y, to.z); });
}

// The pieces of a wipe go into one operation. It is as fast as travels, or slower where the filament says so.
void GcodeLayers::encode_wipe(const GcodeGo& go, LayerEncoder& encoder, Begun& layer) {
    constexpr double same_speed = 0.01;
    const double own_mm_s = layer.state.retract_speed_mm_s * length_mm(go) / -go.filament_mm;
    const double by_filament_mm_s =
        own_mm_s > 0 ? std::min(layer.travel_mm_s, own_mm_s) : layer.travel_mm_s;
    if (wipe_.empty() && std::abs(go.speed_mm_s - by_filament_mm_s) > same_speed * go.speed_mm_s)
        set_travel(go, encoder, layer);
    if (go.sweep_rad == 0)
        wipe_.push_back({go.to.x, go.to.y, 0});
    else
        in_parts(go, widest_arc_rad, [&](const GcodePoint& to, double share) {
            wipe_.push_back({to.x, to.y, sagitta_mm(go, share)});
        });
    wipe_depth_mm_ = go.drawn_back_mm;
}

void GcodeLayers::encode_extrusion(const GcodeGo& go, LayerEncoder& encoder, Begun& layer) {
    // The format asks for a travel behind a wipe, of no way if need be.
    if (std::exchange(wiped_, false)) encoder.travel_to(layer.at.x, layer.at.y, layer.at.z);
    const Point before = encoder.position();
    const double way_mm = length_mm(go);
    if (go.filament_mm * filament_area_mm2_ > largest_strand_mm2 * way_mm) {
        lost_filament_mm_ += go.filament_mm;
        encode_travel(go, encoder, layer);
        return;
    }
    const PathStyle style =
        style_of(go, way_mm, layer.state.height_mm, filament_area_mm2_, layer.style);
    if (style != layer.style) {
        PathStyle slower = style;
        slower.speed_mm_s = layer.style.speed_mm_s;
        PathStyle wider = style;
        wider.width_mm = layer.style.width_mm;
        if (slower == layer.style)
            encoder.speed(style.speed_mm_s);
        else if (wider == layer.style)
            encoder.width(style.width_mm);
        else
            encoder.begin_path(style);
        layer.style = style;
    }
    if (go.sweep_rad != 0)
        encode_arc(go, encoder);
    else
        encoder.line_to(go.to.x, go.to.y, go.to.z);
    const bool is_whole = std::abs(go.sweep_rad) > widest_arc_rad;
    if (encoder.position() == before && !is_whole) lost_filament_mm_ += go.filament_mm;
}

void GcodeLayers::encode_arc(const GcodeGo& go, LayerEncoder& encoder) {
    const bool is_circle = std::abs(go.sweep_rad) > full_turn_rad - same_z_mm &&
                           go.from.x == go.to.x && go.from.y == go.to.y && go.from.z == go.to.z;
    if (is_circle) {
        encoder.circle(go.center_x, go.center_y, go.sweep_rad > 0);
        return;
    }
    in_parts(go, widest_arc_rad, [&](const GcodePoint& to, double share) {
        encoder.arc_to(to.x, to.y, to.z, sagitta_mm(go, share));
    });
}

}  // namespace lyr::format
