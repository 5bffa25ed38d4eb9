#include "slicer/estimate.h"

#include <cmath>
#include <numbers>
#include <span>

#include "format/chunk_decoder.h"
#include "target/motion/planner.h"

namespace lyr::slicer {
namespace {

// Tag of moves that do not extrude; smaller ones are roles.
constexpr std::uint32_t no_role = format::role_count;

// Room for what leads to a layer's start.
constexpr std::size_t approach_moves = 4;

bool extrudes(const format::Operation& operation) {
    return std::holds_alternative<format::Line>(operation) ||
           std::holds_alternative<format::Arc>(operation) ||
           std::holds_alternative<format::Circle>(operation);
}

format::Point start_of(const format::EncodedLayer& layer) {
    const format::Quantum& quantum = layer.quantum;
    return {quantum.quanta(layer.state.start_x_mm), quantum.quanta(layer.state.start_y_mm),
            quantum.quanta(layer.state.z_mm)};
}

// Operations go in, and what they take adds up.
class Plan {
public:
    Plan(motion::Planner planner, moves::MoveMaker maker, double diameter_mm)
        : planner_(std::move(planner)),
          maker_(std::move(maker)),
          filament_area_mm2_(std::numbers::pi / 4 * diameter_mm * diameter_mm) {}

    Status take(const format::Operation& operation, const format::LayerState& state,
                const format::PathStyle& path) {
        const std::uint32_t tag =
            extrudes(operation) ? static_cast<std::uint32_t>(path.role) : no_role;
        for (const moves::Instruction& instruction : maker_.take(operation, state, path)) {
            if (const auto* rest = std::get_if<moves::Rest>(&instruction)) {
                planner_.dwell(rest->time_s);
                estimate_.travel_time_s += rest->time_s;
                continue;
            }
            motion::Move move = std::get<motion::Move>(instruction);
            move.tag = tag;
            if (planner_.full()) count_planned();
            if (Status pushed = planner_.push(move); !pushed) return pushed;
        }
        return Done{};
    }

    LayerEstimate finish() {
        planner_.flush();
        count_planned();
        return {estimate_, maker_.head()};
    }

private:
    void count_planned() {
        while (planner_.pop(planned_)) {
            const motion::Path& path = planned_.path;
            const double length_mm = planned_.profile.length_mm;
            const double time_s = planned_.profile.duration_s;
            if (planned_.tag == no_role) {
                const bool goes = !(motion::start_of(path) == motion::end_of(path));
                estimate_.travel_mm += goes ? length_mm : 0;
                estimate_.travel_time_s += time_s;
            } else {
                RoleEstimate& role = estimate_.roles[planned_.tag];
                role.length_mm += length_mm;
                role.volume_mm3 += motion::advance_of(path) * filament_area_mm2_;
                role.time_s += time_s;
            }
        }
    }

    motion::Planner planner_;
    moves::MoveMaker maker_;
    double filament_area_mm2_;
    motion::PlannedMove planned_;
    Estimate estimate_;
};

Result<Plan> plan_from(const moves::Head& head, const config::Printer& printer, double diameter_mm,
                       format::Quantum quantum, std::size_t capacity) {
    auto planner = motion::Planner::create(moves::motion_limits(printer), capacity);
    if (!planner) return planner.error();
    return Plan(std::move(*planner), moves::MoveMaker(printer, quantum, diameter_mm, head),
                diameter_mm);
}

Diagnostic in_layer(Diagnostic error, std::uint32_t index) {
    error.where.layer = static_cast<int>(index) + 1;
    return error;
}

Status take_operations(const format::EncodedLayer& layer, Plan& plan) {
    format::MotionHistory history;
    format::ChunkDecoder decoder(history);
    decoder.begin_layer(start_of(layer), layer.quantum);
    format::Operation operation;
    for (const format::EncodedLayer::Chunk& chunk : layer.chunks) {
        const std::span<const std::byte> bytes(layer.bytes);
        decoder.begin_chunk(bytes.subspan(chunk.begin, chunk.end - chunk.begin), chunk.operations);
        for (;;) {
            const auto step = decoder.next(operation);
            if (step == format::ChunkDecoder::Step::end) break;
            if (step == format::ChunkDecoder::Step::error)
                return Diagnostic{Severity::error, ExitStatus::internal, decoder.error(), {}};
            if (Status taken = plan.take(operation, layer.state, decoder.style()); !taken)
                return taken;
        }
    }
    return Done{};
}

}  // namespace

double Estimate::time_s() const {
    double sum_s = travel_time_s;
    for (const RoleEstimate& role : roles) sum_s += role.time_s;
    return sum_s;
}

Estimate& Estimate::operator+=(const Estimate& other) {
    for (std::size_t i = 0; i < roles.size(); ++i) {
        roles[i].length_mm += other.roles[i].length_mm;
        roles[i].volume_mm3 += other.roles[i].volume_mm3;
        roles[i].time_s += other.roles[i].time_s;
    }
    travel_mm += other.travel_mm;
    travel_time_s += other.travel_time_s;
    return *this;
}

Estimator::Estimator(const config::Printer& printer, double file_diameter_mm)
    : printer_(printer), diameter_mm_(moves::filament_diameter_mm(printer, file_diameter_mm)) {}

Result<LayerEstimate> Estimator::layer(const format::EncodedLayer& layer,
                                       std::uint32_t index) const {
    const format::Point start = start_of(layer);
    const moves::Head head{moves::position(layer.quantum, start), layer.state.retracted_mm};
    auto plan =
        plan_from(head, printer_, diameter_mm_, layer.quantum, motion::Planner::default_capacity);
    if (!plan) return plan.error();
    Status taken = plan->take(format::LayerStart{index, start}, layer.state, {});
    if (taken) taken = take_operations(layer, *plan);
    if (!taken) return in_layer(taken.error(), index);
    return plan->finish();
}

Result<Estimate> Estimator::approach(const moves::Head& from, const format::EncodedLayer& layer,
                                     std::uint32_t index) const {
    auto plan = plan_from(from, printer_, diameter_mm_, layer.quantum, approach_moves);
    if (!plan) return plan.error();
    const format::LayerStart start{index, start_of(layer)};
    if (const Status taken = plan->take(start, layer.state, {}); !taken)
        return in_layer(taken.error(), index);
    return plan->finish().estimate;
}

}  // namespace lyr::slicer
