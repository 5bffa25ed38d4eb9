// From a .lyr file to steps: reader, interpreter, planner and step generator in a row, each pulled by
// the next as it needs more.
//
// Contract
//  1. Steps are in order of time; the first move starts at time 0.
//  2. Memory is bounded: it does not grow with the file.
//  3. After next(), moves() are the planned moves that the batch has begun, in order; they belong to the
//     steps from here on.
//  4. It begins with the layer `first_layer`, from 0, as if nothing had been before.
//  5. With a queue, each order for heaters and fans is put there, and a mark among the steps where the motion has
//     come so far; for one that waits, the motion stops first. Without, orders are left out.

#pragma once

#include <atomic>
#include <deque>
#include <string>
#include <vector>

#include "target/motion/planner.h"
#include "target/run/interpreter.h"
#include "target/run/motor_steps.h"
#include "target/run/pulse_schedule.h"

namespace lyr::run {

// From this time on, of the steps or of the events, the head is in this layer, from 1, and goes at so many times the
// file's speeds; the filament is drawn back so far, or about to be.
struct LayerBegin {
    std::int64_t time_ns = 0;
    std::uint32_t layer = 0;
    float speed_factor = 1;
    float drawn_back_mm = 0;
};

class StepStream {
public:
    static Result<StepStream> open(const std::string& path, const config::Printer& printer,
                                   double filament_diameter_mm, OrderQueue* orders = nullptr,
                                   std::uint32_t first_layer = 0);
    // `path` is for messages.
    static Result<StepStream> open(format::Reader reader, const std::string& path,
                                   const config::Printer& printer, double filament_diameter_mm,
                                   OrderQueue* orders);

    // Appends the next steps; false: these were the last.
    Result<bool> next(std::vector<Step>& steps);

    const std::vector<motion::PlannedMove>& moves() const { return moves_; }
    // Where the move begun last ends, or a rest after it; the last steps may come so late.
    std::int64_t time_ns() const {
        return planner_.time_ns() + generator_.tail_ns() + end_rest_ns_;
    }
    // Of the move begun last, from 1; 0 before the first.
    std::uint32_t layer() const { return layer_; }
    // Multiplies the speeds of moves that are not planned yet.
    void heed_speed(const std::atomic<float>& factor) { speed_factor_ = &factor; }
    // The filament is drawn back so far, and not as the first layer has it. Before the first next().
    void begin_drawn_back(double mm) { interpreter_.begin_drawn_back(mm); }
    // Layers that the batch has begun, and changes of that factor and of how far the filament is drawn back.
    const std::vector<LayerBegin>& begun() const { return begun_; }

private:
    // An order, the number of the move that it stands before, and how long after the end of the one before that.
    struct Waiting {
        std::uint64_t before_move;
        HeatOrder order;
        std::int64_t rested_ns;
    };

    // How moves are made, and the number of the one from which that holds.
    struct Manner {
        std::uint64_t before_move = 0;
        float factor = 1;
        float drawn_back_mm = 0;
    };

    StepStream(std::string path, Interpreter interpreter, motion::Planner planner,
               MotorSteps generator, OrderQueue* orders);

    Status plan();
    Status plan(motion::Move move);
    void note_begin(const motion::PlannedMove& move);
    Status plan(const HeatOrder& asked);
    Status rest(double time_s);
    Diagnostic refused(const char* why) const;
    // Appends the next steps of what is known, at most so many; how many events they were.
    std::size_t take(std::size_t most, std::vector<Step>& steps);
    bool finish(std::vector<Step>& steps);
    // The orders that stand before the move that begins, of a plan that has come to `ended_ns` before.
    void give_orders(std::int64_t ended_ns, std::vector<Step>& steps);

    std::string path_;  // for messages
    Interpreter interpreter_;
    motion::Planner planner_;
    MotorSteps generator_;
    std::optional<Instruction> held_;  // for when the planner has room again
    bool read_all_ = false;
    OrderQueue* orders_;
    std::deque<Waiting> waiting_;
    std::uint64_t pushed_ = 0, popped_ = 0;  // moves
    std::vector<motion::PlannedMove> moves_;
    std::vector<motion::StepEvent> events_;
    std::uint32_t layer_ = 0;
    Manner manner_, planned_;  // of the move begun last, and of that planned last
    const std::atomic<float>* speed_factor_ = nullptr;
    std::deque<Manner> manners_;
    std::vector<LayerBegin> begun_;
    std::int64_t last_ns_ = 0;    // of the steps so far
    std::int64_t rested_ns_ = 0;  // since the move planned last
    std::int64_t end_rest_ns_ = 0;
};

}  // namespace lyr::run
