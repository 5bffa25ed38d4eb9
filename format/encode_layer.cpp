// Writes the layer block's fields in the order of docs/lyr-format.md.

#include <cmath>

#include "format/layer_record.h"
#include "format/layout.h"

namespace lyr::format {
namespace {

void put_point(Bytes& out, const Point& point, const Point& from) {
    put_signed(out, point.x - from.x);
    put_signed(out, point.y - from.y);
    put_signed(out, point.z - from.z);
}

}  // namespace

std::uint64_t setting(double value, double per_unit) {
    return static_cast<std::uint64_t>(std::llround(value * per_unit));
}

void encode_layer(const LayerRecord& record, Bytes& out) {
    const LayerState& state = record.layer.state;
    const LayerTotals& totals = record.layer.totals;
    put_varint(out, record.layer.index);
    put_point(out, record.start, {});
    put_varint(out, setting(state.height_mm, scale::width));
    put_varint(out, setting(state.travel_speed_mm_s, scale::speed));
    put_varint(out, setting(state.travel_acceleration_mm_s2, scale::acceleration));
    put_varint(out, state.tool);
    put_varint(out, state.object);
    put_varint(out, setting(state.retracted_mm, scale::filament));
    put_varint(out, setting(state.retract_length_mm, scale::filament));
    put_varint(out, setting(state.retract_speed_mm_s, scale::speed));
    put_varint(out, setting(state.unretract_speed_mm_s, scale::speed));
    put_varint(out, state.temperatures.size());
    for (const HeaterTarget& target : state.temperatures) {
        put_varint(out, static_cast<std::uint8_t>(target.heater.kind));
        put_varint(out, target.heater.tool);
        put_varint(out, setting(target.target_c, scale::temperature));
    }
    put_varint(out, state.fans.size());
    for (const Fan& fan : state.fans) {
        put_varint(out, fan.fan);
        put_varint(out, setting(fan.duty, scale::duty));
    }
    put_varint(out, setting(state.estimated_time_s, scale::time));
    put_varint(out, totals.chunks);
    put_varint(out, totals.operations);
    put_point(out, totals.motion.low, record.start);
    put_point(out, totals.motion.high, totals.motion.low);
    put_varint(out, static_cast<std::uint64_t>(totals.extruded_quanta));
    put_varint(out, static_cast<std::uint64_t>(totals.travel_quanta));
    put_varint(out, setting(totals.volume_mm3, scale::volume));
}

}  // namespace lyr::format
