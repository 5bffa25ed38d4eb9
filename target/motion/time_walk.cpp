#include "target/motion/time_walk.h"

#include <algorithm>
#include <cmath>

namespace lyr::motion {
namespace {

// A stretch in which the motor moves less than this is not worth halving.
constexpr double nothing_steps = TimeWalk::touch_steps / 4;
// Of halvings and of looks for one root; each at least halves what is left, so that this is below any
// rounding.
constexpr int most_looks = 60;

int sign_of(double value) {
    return value > 0 ? 1 : value < 0 ? -1 : 0;
}

}  // namespace

void TimeWalk::start(const MotorFunction& function, std::int64_t count) {
    count_ = count;
    duration_s_ = function.duration_s();
    least_jerk_ = function.least_jerk();
    most_jerk_ = function.most_jerk();
    jerk_ = std::max(std::abs(least_jerk_), std::abs(most_jerk_));
    snap_ = function.most_snap();
    low_s_ = high_s_ = seen_s_ = passed_s_ = 0;
    given_ = found_ = 0;
    seen_ = high_ = function.at(0);
    last_ = function.at(duration_s_);
    begin_ = end_ = seen_.position;
    direction_ = 0;
}

// The stretch after this one; false: the piece ends.
bool TimeWalk::next_stretch(const MotorFunction& function) {
    take_up();
    if (high_s_ >= duration_s_) return false;
    const Sample low = high_;
    low_s_ = high_s_;
    double high_s = duration_s_;
    Sample high = last_;
    for (int look = 0; look < most_looks; ++look) {
        const double h = high_s - low_s_;
        const double slack = jerk_ * h * h / 8;
        const double slowest = std::min(std::abs(low.speed), std::abs(high.speed));
        const double fastest = std::max(std::abs(low.speed), std::abs(high.speed)) + slack;
        const bool same_way = low.speed * high.speed >= 0;
        if ((same_way && slowest >= slack) || fastest * h < nothing_steps) break;
        if (keeps_sign(low, high, h)) {
            if (same_way) break;
            high_s_ = high_s;
            seen_ = low;
            high_s = turning_s(function, high);
            high = function.at(high_s);
            high.speed = 0;
            break;
        }
        high_s = low_s_ + h / 2;
        high = function.at(high_s);
    }
    high_s_ = high_s;
    high_ = high;
    seen_s_ = passed_s_ = low_s_;
    seen_ = low;
    begin_ = low.position;
    end_ = high.position;
    direction_ = sign_of(end_ - begin_);
    return true;
}

// The stretch is done: what the motor is ahead at its end.
void TimeWalk::take_up() {
    play_.ahead = motor_at(end_) - end_;
    begin_ = end_;
}

double TimeWalk::motor_at(double position) const {
    const double ahead = play_.ahead + Play::eagerness * (position - begin_);
    return position + std::clamp(ahead, 0.0, play_.steps);
}

double TimeWalk::function_at(double middle) const {
    if (play_.steps == 0) return middle;
    const double made_up = middle - (direction_ > 0 ? play_.steps : 0);
    const double meanwhile =
        (middle - play_.ahead + Play::eagerness * begin_) / (1 + Play::eagerness);
    return direction_ > 0 ? std::max(made_up, meanwhile) : std::min(made_up, meanwhile);
}

// The acceleration, over a stretch. A wrong sign too small to move the motor does not count.
bool TimeWalk::keeps_sign(const Sample& low, const Sample& high, double h) const {
    const double falls = std::min(0.0, least_jerk_) * h, rises = std::max(0.0, most_jerk_) * h;
    const double least = std::max(low.acceleration + falls, high.acceleration - rises);
    const double most = std::min(low.acceleration + rises, high.acceleration - falls);
    const double nothing = nothing_steps / (h * h);
    return least >= -nothing || most <= nothing;
}

// The one root of the speed in the stretch, by Newton's steps within halvings.
double TimeWalk::turning_s(const MotorFunction& function, const Sample& high) const {
    double low_s = low_s_, high_s = high_s_;
    const int rising = sign_of(high.speed);
    double at_s = low_s + (high_s - low_s) * std::abs(seen_.speed) /
                              (std::abs(seen_.speed) + std::abs(high.speed));
    for (int look = 0; look < most_looks; ++look) {
        const Sample sample = function.at(at_s);
        (sign_of(sample.speed) == rising ? high_s : low_s) = at_s;
        double next_s = at_s - sample.speed / sample.acceleration;
        if (!(next_s > low_s && next_s < high_s)) next_s = (low_s + high_s) / 2;
        const double change_s = std::abs(next_s - at_s);
        at_s = next_s;
        if (change_s < exact_s / 100 || high_s - low_s < exact_s / 100) break;
    }
    return at_s;
}

double TimeWalk::next_s(const MotorFunction& function) {
    for (;;) {
        if (given_ < found_) {
            count_ += direction_;
            return passed_s_ = found_s_[given_++];
        }
        const double middle = static_cast<double>(count_) + direction_ / 2.0;
        if (direction_ != 0 && (motor_at(end_) - middle) * direction_ > touch_steps) {
            if (find_ahead(function, middle)) continue;
            count_ += direction_;
            return passed_s_ = solve_s(function, function_at(middle));
        }
        if (!next_stretch(function)) return no_step_s;
    }
}

// Where the last of some steps is exact the ones before are: all bounds of errors grow with the time. Found together, they
// do not wait for each other's roots and quotients.
bool TimeWalk::find_ahead(const MotorFunction& function, double middle) {
    const double left = std::ceil((end_ - middle) * direction_ - touch_steps);
    if (play_.steps != 0 || left < 2) return false;
    const auto most = static_cast<std::size_t>(std::min(left, static_cast<double>(ahead_)));
    std::size_t count = exact_count(middle, most);
    if (count < most && count < few_ahead && seen_s_ < passed_s_) {
        seen_s_ = passed_s_;
        seen_ = function.at(passed_s_);
        count = exact_count(middle, most);
    }
    ahead_ = std::clamp(2 * count, few_ahead, most_ahead);
    if (count < 2) return false;
    fill(middle, count);
    return true;
}

std::size_t TimeWalk::exact_count(double middle, std::size_t most) const {
    const double way = (middle - seen_.position) * direction_;
    if (way <= 0) return 0;
    std::size_t count = most;
    for (; count >= 2; count /= 2) {
        const Root last = root(way + static_cast<double>(count - 1));
        if (last.is_exact && seen_s_ + last.change_s <= high_s_) break;
    }
    return count;
}

void TimeWalk::fill(double middle, std::size_t count) {
    const double way = (middle - seen_.position) * direction_;
    const double speed = std::max(0.0, seen_.speed * direction_), squared = speed * speed;
    const double twice = 2 * seen_.acceleration * direction_;
    const double sixth = seen_.jerk * direction_ / 6;
    // At a stop there is no jerk, or the parabola would not be exact there.
    constexpr double least_speed = std::numeric_limits<double>::min();
    constexpr std::size_t block = 4;
    static_assert(most_ahead % block == 0);
    for (std::size_t from = 0; from < count; from += block)
        for (std::size_t i = 0; i < block; ++i) {
            const double here = way + static_cast<double>(from + i);
            const double end_speed = std::sqrt(std::max(0.0, squared + twice * here));
            const double t = 2 * here / (speed + end_speed);
            found_s_[from + i] =
                seen_s_ + (t - sixth * t * t * t / std::max(end_speed, least_speed));
        }
    given_ = 0;
    found_ = count;
}

// Of the parabola through the point looked at last or, where that is not exact, by a step of Newton's from there on to the
// cubic's, with the parabola's speed. Half of exact_s is left for the speed, which hardly changes within it.
TimeWalk::Root TimeWalk::root(double way) const {
    const double speed = std::max(0.0, seen_.speed * direction_);
    const double a = seen_.acceleration * direction_, j = seen_.jerk * direction_;
    const double end_speed = std::sqrt(std::max(0.0, speed * speed + 2 * a * way));
    const double change_s = 2 * way / (speed + end_speed);
    const double t = std::abs(change_s), squared = t * t;
    if (jerk_ * squared * t <= 3 * exact_s * end_speed) return {change_s, true};
    if (snap_ == std::numeric_limits<double>::infinity()) return {change_s, false};
    const double shift_s = j / 6 * change_s * squared / end_speed, h = std::abs(shift_s);
    const double reach_s = t + h, faster = std::abs(j) * squared / 2;
    const double off = h * faster + h * h / 2 * (std::abs(a) + std::abs(j) * reach_s) +
                       snap_ / 24 * reach_s * reach_s * reach_s * reach_s;
    return {change_s - shift_s, off <= exact_s / 2 * (end_speed - faster)};
}

double TimeWalk::solve_s(const MotorFunction& function, double middle) {
    double low_s = passed_s_, high_s = high_s_;
    for (int look = 0; look < most_looks; ++look) {
        const double way = (middle - seen_.position) * direction_;
        // Reached already: left open by the stretch before.
        if (way <= 0 && seen_s_ <= low_s) return low_s;
        const Root found = root(way);
        double next_s = seen_s_ + found.change_s;
        if (!(next_s >= low_s && next_s <= high_s))
            next_s = (low_s + high_s) / 2;
        else if (found.is_exact)
            return next_s;
        if (high_s - low_s < exact_s) return next_s;
        seen_s_ = next_s;
        seen_ = function.at(next_s);
        ((middle - seen_.position) * direction_ > 0 ? low_s : high_s) = next_s;
    }
    return high_s;
}

}  // namespace lyr::motion
