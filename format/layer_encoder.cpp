// The public face of the encoder, and how a layer begins and ends.

#include <cmath>

#include "format/encoder_state.h"
#include "format/layer_record.h"
#include "format/layout.h"

namespace lyr::format {

LayerEncoder::Implementation::Implementation(Quantum quantum, const LayerState& state)
    : quantum_(quantum), state_(state) {
    if (quantum.nm == 0 || quantum.nm > coarsest_quantum_nm) {
        quantum_ = {};
        mistake("the quantum is not within 1 nm to 1 mm");
    }
    depth_mm_ = state.retracted_mm;
    if (const auto start = point(state.start_x_mm, state.start_y_mm, &state.z_mm)) at_ = *start;
    out_.totals.motion = {at_, at_};
    checked(state.height_mm, scale::width, "a layer's height");
    checked(state.travel_speed_mm_s, scale::speed, "a travel speed");
    checked(state.travel_acceleration_mm_s2, scale::acceleration, "a travel acceleration");
    checked(state.retracted_mm, scale::filament, "a retraction");
    checked(state.retract_length_mm, scale::filament, "a retraction");
    checked(state.retract_speed_mm_s, scale::speed, "a retraction's speed");
    checked(state.unretract_speed_mm_s, scale::speed, "a retraction's speed");
    for (const HeaterTarget& target : state.temperatures)
        checked(target.target_c, scale::temperature, "a temperature");
    for (const Fan& fan : state.fans) {
        checked(fan.duty, scale::duty, "a fan's duty");
        if (fan.duty > 1) mistake("a fan's duty is above 1");
    }
}

Result<EncodedLayer> LayerEncoder::Implementation::finish() {
    if (error_) return *error_;
    flush_motions();
    close_chunk();
    LayerTotals& totals = out_.totals;
    totals.chunks = static_cast<std::uint32_t>(out_.chunks.size());
    totals.extruded_quanta = std::llround(extruded_);
    totals.travel_quanta = std::llround(travelled_);
    out_.state = state_;
    out_.quantum = quantum_;
    return std::move(out_);
}

LayerEncoder::LayerEncoder(Quantum quantum, const LayerState& state)
    : implementation_(std::make_unique<Implementation>(quantum, state)) {}
LayerEncoder::LayerEncoder(LayerEncoder&&) noexcept = default;
LayerEncoder& LayerEncoder::operator=(LayerEncoder&&) noexcept = default;
LayerEncoder::~LayerEncoder() = default;

void LayerEncoder::begin_path(const PathStyle& style) {
    implementation_->begin_path(style);
}

void LayerEncoder::travel_to(double x_mm, double y_mm) {
    implementation_->travel_to(x_mm, y_mm, nullptr);
}

void LayerEncoder::travel_to(double x_mm, double y_mm, double z_mm) {
    implementation_->travel_to(x_mm, y_mm, &z_mm);
}

void LayerEncoder::line_to(double x_mm, double y_mm) {
    implementation_->line_to(x_mm, y_mm, nullptr);
}

void LayerEncoder::line_to(double x_mm, double y_mm, double z_mm) {
    implementation_->line_to(x_mm, y_mm, &z_mm);
}

void LayerEncoder::arc_to(double x_mm, double y_mm, double sagitta_mm) {
    implementation_->arc_to(x_mm, y_mm, nullptr, sagitta_mm);
}

void LayerEncoder::arc_to(double x_mm, double y_mm, double z_mm, double sagitta_mm) {
    implementation_->arc_to(x_mm, y_mm, &z_mm, sagitta_mm);
}

void LayerEncoder::circle(double center_x_mm, double center_y_mm, bool counter_clockwise) {
    implementation_->circle(center_x_mm, center_y_mm, counter_clockwise);
}

void LayerEncoder::hatch(const HatchRun& run) {
    implementation_->hatch(run);
}

void LayerEncoder::width(double width_mm) {
    implementation_->put_setting(opcode::width, width_mm, scale::width,
                                 &implementation_->style().width_mm);
}

void LayerEncoder::speed(double speed_mm_s) {
    implementation_->put_setting(opcode::speed, speed_mm_s, scale::speed,
                                 &implementation_->style().speed_mm_s);
}

void LayerEncoder::acceleration(double acceleration_mm_s2) {
    implementation_->put_setting(opcode::acceleration, acceleration_mm_s2, scale::acceleration,
                                 &implementation_->style().acceleration_mm_s2);
}

void LayerEncoder::travel_speed(double speed_mm_s) {
    implementation_->put_setting(opcode::travel_speed, speed_mm_s, scale::speed);
}

void LayerEncoder::travel_acceleration(double acceleration_mm_s2) {
    implementation_->put_setting(opcode::travel_acceleration, acceleration_mm_s2,
                                 scale::acceleration);
}

void LayerEncoder::retract() {
    retract_to(implementation_->state().retract_length_mm);
}

void LayerEncoder::retract_to(double depth_mm) {
    implementation_->retract_to(depth_mm);
}

void LayerEncoder::unretract() {
    retract_to(0);
}

void LayerEncoder::wipe(std::span<const WipePiece> pieces, double depth_mm) {
    implementation_->wipe(pieces, depth_mm);
}

void LayerEncoder::temperature(Heater heater, double target_c, bool wait) {
    implementation_->temperature(heater, target_c, wait);
}

void LayerEncoder::fan(std::uint32_t fan, double duty) {
    implementation_->fan(fan, duty);
}

void LayerEncoder::dwell(std::uint32_t time_ms) {
    implementation_->put_number(opcode::dwell, time_ms);
}

void LayerEncoder::tool(std::uint32_t tool) {
    implementation_->put_number(opcode::tool, tool);
}

void LayerEncoder::pause(PauseReason reason) {
    implementation_->pause(reason);
}

void LayerEncoder::object(std::uint32_t object) {
    implementation_->put_number(opcode::object, object);
}

Point LayerEncoder::position() const {
    return implementation_->position();
}

Result<EncodedLayer> LayerEncoder::finish() {
    return implementation_->finish();
}

}  // namespace lyr::format
