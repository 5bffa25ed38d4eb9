// Reads the layer block's fields in their order; the numbers are checked once, at the end.

#include "format/layer_record.h"
#include "format/layout.h"

namespace lyr::format {
namespace {

// Takes fields and remembers whether one was out of range.
class Fields {
public:
    explicit Fields(std::span<const std::byte> payload) : cursor_(payload) {}

    bool cut_short() const { return cursor_.bad(); }
    bool out_of_range() const { return out_of_range_; }

    std::uint64_t count() { return cursor_.varint(); }
    std::uint32_t number() { return static_cast<std::uint32_t>(limited(largest_setting)); }
    double setting(double per_unit) {
        return static_cast<double>(limited(largest_setting)) / per_unit;
    }
    double large_setting(double per_unit) {
        return static_cast<double>(cursor_.varint()) / per_unit;
    }
    std::int64_t coordinate(std::int64_t from) {
        const std::int64_t step = cursor_.signed_varint();
        if (step < -2 * coordinate_limit || step > 2 * coordinate_limit) return refuse();
        const std::int64_t value = from + step;
        return value < -coordinate_limit || value > coordinate_limit ? refuse() : value;
    }
    Point point(const Point& from) {
        Point point;
        point.x = coordinate(from.x);
        point.y = coordinate(from.y);
        point.z = coordinate(from.z);
        return point;
    }
    std::int64_t length() {
        const std::uint64_t value = cursor_.varint();
        return value > INT64_MAX ? refuse() : static_cast<std::int64_t>(value);
    }
    std::int64_t refuse() {
        out_of_range_ = true;
        return 0;
    }

private:
    std::uint64_t limited(std::uint64_t limit) {
        const std::uint64_t value = cursor_.varint();
        return value > limit ? static_cast<std::uint64_t>(refuse()) : value;
    }

    Cursor cursor_;
    bool out_of_range_ = false;
};

void read_heaters(Fields& fields, LayerState& state) {
    const std::uint64_t count = fields.count();
    for (std::uint64_t i = 0; i < count && !fields.cut_short(); ++i) {
        HeaterTarget target;
        const std::uint32_t kind = fields.number();
        if (kind > static_cast<std::uint32_t>(HeaterKind::tool)) fields.refuse();
        target.heater.kind = static_cast<HeaterKind>(kind);
        target.heater.tool = fields.number();
        target.target_c = fields.setting(scale::temperature);
        if (!state.temperatures.push_back(target)) fields.refuse();
    }
}

void read_fans(Fields& fields, LayerState& state) {
    const std::uint64_t count = fields.count();
    for (std::uint64_t i = 0; i < count && !fields.cut_short(); ++i) {
        Fan fan;
        fan.fan = fields.number();
        fan.duty = fields.setting(scale::duty);
        if (fan.duty > 1 || !state.fans.push_back(fan)) fields.refuse();
    }
}

}  // namespace

std::optional<LayerRecord> decode_layer(std::span<const std::byte> payload, Quantum quantum,
                                        const char*& why) {
    Fields fields(payload);
    LayerRecord record;
    Layer& layer = record.layer;
    LayerState& state = layer.state;
    layer.index = fields.number();
    record.start = fields.point({});
    state.z_mm = quantum.mm(record.start.z);
    state.start_x_mm = quantum.mm(record.start.x);
    state.start_y_mm = quantum.mm(record.start.y);
    state.height_mm = fields.setting(scale::width);
    state.travel_speed_mm_s = fields.setting(scale::speed);
    state.travel_acceleration_mm_s2 = fields.setting(scale::acceleration);
    state.tool = fields.number();
    state.object = fields.number();
    state.retracted_mm = fields.setting(scale::filament);
    state.retract_length_mm = fields.setting(scale::filament);
    state.retract_speed_mm_s = fields.setting(scale::speed);
    state.unretract_speed_mm_s = fields.setting(scale::speed);
    read_heaters(fields, state);
    read_fans(fields, state);
    state.estimated_time_s = fields.large_setting(scale::time);
    layer.totals.chunks = fields.number();
    layer.totals.operations = fields.count();
    layer.totals.motion.low = fields.point(record.start);
    layer.totals.motion.high = fields.point(layer.totals.motion.low);
    layer.totals.extruded_quanta = fields.length();
    layer.totals.travel_quanta = fields.length();
    layer.totals.volume_mm3 = fields.large_setting(scale::volume);
    why = fields.cut_short()      ? "it is cut short"
          : fields.out_of_range() ? "a number in it is out of range"
                                  : nullptr;
    if (why) return std::nullopt;
    return record;
}

}  // namespace lyr::format
