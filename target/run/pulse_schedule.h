// Turns steps into edges: each step becomes a pulse on the axis's step line, and a change of direction
// an edge on the direction line before it, all with the times that the motor driver needs.
//
// Contract
//  1. A step at time t becomes a rising edge at t + shift and a falling one high_ns later. The order of
//     steps is kept, and no step is dropped or doubled.
//  2. On one axis a step line stays low for at least low_ns between pulses; a direction line is steady
//     from direction_setup_ns before a rising edge to direction_hold_ns after it.
//  3. The shift grows by what a step must be delayed for 2 and then delays everything after it, on all
//     axes alike, so that the path keeps its shape. It never shrinks. Every growth is listed.
//  4. A mark stands at its time, later than every edge of steps before it if it is a gate, and no two at the same
//     nanosecond.
//  5. Events come out in order of time, one for all edges of the same nanosecond. Each carries the
//     levels of all lines.

#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "target/config/printer.h"
#include "target/gpio/gpio_chip.h"
#include "target/run/line_layout.h"

namespace lyr::run {

// In place of an axis: no step but a mark; `positive` then says whether it is a gate.
inline constexpr std::uint8_t mark_axis = 255;

struct Step {
    std::int64_t time_ns = 0;
    std::uint8_t axis = 0;
    bool positive = true;
};

// At its time all lines have these levels.
struct LineEvent {
    std::int64_t time_ns = 0;
    gpio::LineMask levels = 0;
};

// From here on (in time of the events) events are so much later than the steps were asked for.
struct Shift {
    std::int64_t from_ns = 0;
    std::int64_t shift_ns = 0;
};

// Follows the shifts of a schedule along its events, from one to a later one.
class ShiftLog {
public:
    void append(std::span<const Shift> shifts) {
        coming_.insert(coming_.end(), shifts.begin(), shifts.end());
    }
    // When the step was asked for whose event comes then.
    std::int64_t asked_ns(std::int64_t event_ns) {
        for (; !coming_.empty() && coming_.front().from_ns <= event_ns; coming_.pop_front())
            shift_ns_ = coming_.front().shift_ns;
        return event_ns - shift_ns_;
    }

private:
    std::deque<Shift> coming_;
    std::int64_t shift_ns_ = 0;
};

class PulseSchedule {
public:
    // `idle` are the levels of all other lines, such as enable, and of the direction lines before the first step.
    PulseSchedule(const config::PulseTiming& timing, gpio::LineMask idle);

    // An event at time 0 that sets the idle lines; steps come `delay_ns` later than they say.
    void begin(std::int64_t delay_ns, std::vector<LineEvent>& events);
    // Steps in order of time, from all axes together. What is certain by then is appended to `events`.
    void append(std::span<const Step> steps, std::vector<LineEvent>& events);
    // What is still open, and at `end_ns` (in time of the steps), or as soon after the last edges as
    // drivers allow, an event that makes all lines inactive.
    void finish(std::int64_t end_ns, std::vector<LineEvent>& events);
    // Instead: all lines are again as they were at the begin, and direction lines steady for long enough.
    void finish_as_begun(std::vector<LineEvent>& events);

    std::int64_t shift_ns() const { return shift_ns_; }
    // Growths of the shift since the last call.
    std::vector<Shift> take_shifts();

private:
    struct Edge {
        std::int64_t time_ns;
        gpio::LineMask toggled;
    };
    struct AxisState {
        std::int64_t rise_ns, fall_ns;
        bool positive;
    };

    // Edges that wait, in order of time, and where the events go that they become. A copy of what is kept between calls,
    // which stays in registers: there are hundreds of millions in a print.
    struct Open {
        Edge* edges;
        std::size_t count;
        gpio::LineMask levels;
        LineEvent* events;

        void insert(std::int64_t time_ns, gpio::LineMask toggled) {
            if (count == 0 || edges[count - 1].time_ns < time_ns)
                edges[count++] = {time_ns, toggled};
            else
                count = insert_between(edges, count, {time_ns, toggled});
        }
        void emit_before(std::int64_t time_ns);
    };
    // The new count.
    static std::size_t insert_between(Edge* edges, std::size_t count, Edge edge);

    // With room for the edges of so many steps and marks; close() appends the events that there are.
    Open open(std::size_t steps);
    void close(const Open& open, std::vector<LineEvent>& events);
    void step(const Step& step, Open& open);
    Open mark(const Step& step, Open open);
    void delay(std::int64_t wanted_ns, std::int64_t due_ns);
    // When all edges of the steps so far are over and drivers have taken them.
    std::int64_t quiet_ns(std::int64_t from_ns) const;
    void emit_before(std::int64_t time_ns, std::vector<LineEvent>& events);

    config::PulseTiming timing_;
    gpio::LineMask idle_, levels_;
    std::int64_t shift_ns_ = 0;
    std::int64_t last_mark_ns_ = -1;
    std::array<AxisState, config::axis_count> axes_;
    std::vector<Edge> edges_;
    std::size_t open_count_ = 0;  // of them; a few edges an axis at most
    std::vector<LineEvent> events_;
    std::vector<Shift> shifts_;
};

}  // namespace lyr::run
