// What a file asks at a point of its path beside motion, of heaters, fans and of whoever tends the printer, and how
// it gets there: the planning thread puts a mark into the events and the order into a queue; the real-time thread
// counts the marks that it reaches; the thermal thread carries out as many orders. A mark may be a gate, at which the
// motion waits until its order is done.
//
// Contract
//  1. The n-th mark belongs to the n-th order.
//  2. Reaching a mark is one store, waiting at a gate one load now and then: nothing here blocks the real-time
//     thread.
//  3. A tick of HeatAttendant carries out the orders that were reached, in order; one that waits holds those
//     after it up until its heaters have reached their targets. After longest_wait_s all heaters go off instead:
//     what has not come by then never will, and nobody may be there. Before that it carries out what is asked at the
//     desk, and afterwards it tells there how warm it is.
//  4. An order with a pause is done when the desk says that the pause is over.

#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>

#include "format/operation.h"
#include "target/config/printer.h"
#include "target/run/heat_desk.h"
#include "target/thermal/control.h"

namespace lyr::run {

inline constexpr double longest_wait_s = 3'600;

struct HeatOrder {
    // By config's number; none: as before.
    std::array<std::optional<double>, config::heater_count> targets_c;
    std::array<bool, config::heater_count> waits{};
    std::optional<double> fan_duty;
    std::optional<format::PauseReason> pause;

    bool is_gate() const { return waits[0] || waits[1] || waits[2] || pause; }
};

// To be carried out after `order` at the same place, put into it. False: it must stay apart, since `order` waits.
bool join(HeatOrder& order, const HeatOrder& next);

// None: no printer has this heater.
std::optional<std::size_t> heater_number(const format::Heater& heater);

// From operations to orders; only what changes is ordered, but for waits.
class HeatOrders {
public:
    std::optional<HeatOrder> take(const format::Operation& operation,
                                  const format::LayerState& layer);

private:
    void set(HeatOrder& order, const format::Heater& heater, double target_c, bool wait);
    void set(HeatOrder& order, const format::Fan& fan);

    std::array<double, config::heater_count> targets_c_{};
    double fan_duty_ = 0;
    bool begun_ = false;
};

class OrderQueue {
public:
    // What of the orders is heeded; the rest is passed by.
    struct Heeded {
        bool heat = true, pauses = false;
    };

    OrderQueue() = default;
    explicit OrderQueue(Heeded heeded) : heeded_(heeded) {}

    // None: nothing of the order is heeded.
    std::optional<HeatOrder> heed(const HeatOrder& order) const;
    void push(const HeatOrder& order);
    std::optional<HeatOrder> pop();

private:
    Heeded heeded_;
    std::mutex mutex_;
    std::deque<HeatOrder> orders_;
};

struct Marks {
    std::atomic<std::uint32_t> reached{0};  // by the motion
    std::atomic<std::uint32_t> done{0};     // orders carried out
};
static_assert(std::atomic<std::uint32_t>::is_always_lock_free);

class HeatAttendant {
public:
    // `control` may be null: nothing is heated. So may the desk.
    HeatAttendant(OrderQueue& orders, Marks& marks, thermal::HeatControl* control,
                  HeatDesk* desk = nullptr)
        : orders_(orders), marks_(marks), control_(control), desk_(desk) {}

    void tick();
    bool waits() const { return waiting_.has_value(); }

private:
    bool on_standby() const { return standby_[0] || standby_[1] || standby_[2]; }
    bool reached(std::size_t heater) const { return !control_ || control_->reached(heater); }
    bool is_done(const HeatOrder& order) const;
    void give_up(const HeatOrder& order);
    void heed(const HeatWish& wish);
    void carry_out(const HeatOrder& order);
    void set(std::size_t heater, double target_c);
    void tell() const;

    OrderQueue& orders_;
    Marks& marks_;
    thermal::HeatControl* control_;
    HeatDesk* desk_;
    std::optional<HeatOrder> waiting_;
    int waited_ticks_ = 0;
    std::array<double, config::heater_count> wanted_c_{};
    std::array<bool, config::heater_count> standby_{};
    double fan_ = 0;
    bool pause_is_over_ = false;
};

}  // namespace lyr::run
