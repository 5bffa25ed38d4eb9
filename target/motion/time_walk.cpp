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

double sixth_power(double t) {
    const double cube = t * t * t;
    return cube * cube;
}

// From the series' begin on: rounding is that of the way then, not of the position.
double way_of(const Series& c, double t) {
    return t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5]))));
}

double speed_of(const Series& c, double t) {
    return c[1] + t * (2 * c[2] + t * (3 * c[3] + t * (4 * c[4] + t * 5 * c[5])));
}

// The most that the second derivative of the series can be within that time, halved.
double half_acceleration_of(const Series& c, double t) {
    return std::abs(c[2]) +
           t * (3 * std::abs(c[3]) + t * (6 * std::abs(c[4]) + t * 10 * std::abs(c[5])));
}

}  // namespace

void TimeWalk::start(const MotorFunction& function, std::int64_t count) {
    count_ = count;
    duration_s_ = function.duration_s();
    least_jerk_ = function.least_jerk();
    most_jerk_ = function.most_jerk();
    jerk_ = std::max(std::abs(least_jerk_), std::abs(most_jerk_));
    left_out_ = function.left_out();
    low_s_ = high_s_ = seen_s_ = passed_s_ = 0;
    seen_ = function.series(0);
    high_ = {seen_[0], seen_[1], 2 * seen_[2]};
    last_ = function.at(duration_s_);
    begin_ = end_ = high_.position;
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
            high_s = turning_s(function, low, high);
            high = function.at(high_s);
            high.speed = 0;
            break;
        }
        high_s = low_s_ + h / 2;
        high = function.at(high_s);
    }
    high_s_ = high_s;
    high_ = high;
    if (seen_s_ != low_s_) look(function, low_s_);
    passed_s_ = low_s_;
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
double TimeWalk::turning_s(const MotorFunction& function, const Sample& low,
                           const Sample& high) const {
    double low_s = low_s_, high_s = high_s_;
    const int rising = sign_of(high.speed);
    double at_s = low_s + (high_s - low_s) * std::abs(low.speed) /
                              (std::abs(low.speed) + std::abs(high.speed));
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

std::span<const double> TimeWalk::next_s(const MotorFunction& function) {
    for (;;) {
        const double middle = static_cast<double>(count_) + direction_ / 2.0;
        if (direction_ != 0 && (motor_at(end_) - middle) * direction_ > touch_steps) {
            int found = find_ahead(function, middle);
            if (found == 0) {
                found_s_[0] = solve_s(function, function_at(middle));
                found = 1;
            }
            count_ += direction_ * found;
            const auto times_s = std::span(found_s_).first(static_cast<std::size_t>(found));
            passed_s_ = times_s.back();
            return times_s;
        }
        if (!next_stretch(function)) return {};
    }
}

void TimeWalk::look(const MotorFunction& function, double time_s) {
    seen_s_ = time_s;
    seen_ = function.series(time_s);
}

// Where the last of some steps is not exact, fewer are tried, from the step before on.
int TimeWalk::find_ahead(const MotorFunction& function, double middle) {
    const double left = std::ceil((end_ - middle) * direction_ - touch_steps);
    if (play_.steps != 0 || left < 2) return 0;
    int count = static_cast<int>(std::min(left, static_cast<double>(ahead_)));
    while (count >= 2) {
        const Root last = root(middle + direction_ * (count - 1));
        const double last_s = seen_s_ + last.time_s;
        if (last.is_exact && last_s > passed_s_ && last_s <= high_s_ && fill(middle, count, last))
            break;
        if (seen_s_ < passed_s_)
            look(function, passed_s_);
        else
            count /= 2;
    }
    constexpr int few = 4;
    ahead_ = std::clamp(2 * count, few, most_steps);
    return count >= 2 ? count : 0;
}

// What may be off, in steps, is what the series leaves out and what is left by Newton's step: half the acceleration times
// the square of that, by the speed. The loop has no branch, so that two or more are solved at a time.
bool TimeWalk::fill(double middle, int count, const Root& last) {
    const Series& c = seen_;
    const double from_s = passed_s_ - seen_s_, time_s = last.time_s - from_s;
    const double from = way_of(c, from_s), from_speed = speed_of(c, from_s);
    if (!(from_speed * direction_ > 0)) return false;
    const double first = middle - c[0], way = first + direction_ * (count - 1) - from;
    const double slow_s = way / from_speed, fast_s = way / (last.speed * direction_);
    const double square_s = 3 * time_s - 2 * slow_s - fast_s, cube_s = slow_s + fast_s - 2 * time_s;
    const double left_out =
        left_out_ * sixth_power(std::max(std::abs(from_s), std::abs(last.time_s)));
    const double half = half_acceleration_of(c, std::abs(from_s) + 2 * time_s);
    constexpr double may_be_off_s = 0.75 * exact_s;
    const double per_step = 1 / way;
    constexpr int block = 4;
    static_assert(most_steps % block == 0);
    std::array<double, block> too_far{};
    const auto if_positive = [](double x) { return x + std::abs(x); };
    for (int i = 0; i < count; i += block)
        for (int k = 0; k < block; ++k) {
            const double sought = first + direction_ * std::min(i + k, count - 1);
            const double u = (sought - from) * per_step;
            const double since_s = u * (slow_s + u * (square_s + u * cube_s));
            const double t = from_s + since_s, speed = speed_of(c, t) * direction_;
            const double change_s = (way_of(c, t) - sought) * direction_ / speed;
            found_s_[static_cast<std::size_t>(i + k)] = seen_s_ + (t - change_s);
            const double off = change_s * change_s * half + left_out - may_be_off_s * speed;
            too_far[static_cast<std::size_t>(k)] +=
                if_positive(off) + if_positive(std::abs(since_s) - 2 * time_s);
        }
    for (const double far : too_far)
        if (!(far <= 0)) return false;
    // Left open by the stretch before: reached already.
    found_s_[0] = std::max(found_s_[0], passed_s_);
    return true;
}

TimeWalk::Root TimeWalk::root(double middle) const {
    const Series& c = seen_;
    const double sought = middle - c[0], way = sought * direction_;
    const double speed = std::max(0.0, c[1] * direction_);
    const double end_speed = std::sqrt(std::max(0.0, speed * speed + 4 * c[2] * sought));
    Root root{2 * way / (speed + end_speed)};
    constexpr int most_rounds = 5;
    for (int round = 0; round < most_rounds; ++round) {
        root.speed = speed_of(c, root.time_s) * direction_;
        const double change_s = (way_of(c, root.time_s) - sought) * direction_ / root.speed;
        root.time_s -= change_s;
        if (!(std::abs(change_s) <= exact_s / 4)) continue;
        root.is_exact = left_out_ * sixth_power(root.time_s) <= exact_s / 2 * root.speed;
        break;
    }
    return root;
}

double TimeWalk::solve_s(const MotorFunction& function, double middle) {
    double low_s = passed_s_, high_s = high_s_;
    for (int looks = 0; looks < most_looks; ++looks) {
        // Reached already: left open by the stretch before.
        if ((middle - seen_[0]) * direction_ <= 0 && seen_s_ <= low_s) return low_s;
        const Root found = root(middle);
        double next_s = seen_s_ + found.time_s;
        if (!(next_s >= low_s && next_s <= high_s))
            next_s = (low_s + high_s) / 2;
        else if (found.is_exact)
            return next_s;
        if (high_s - low_s < exact_s) return next_s;
        look(function, next_s);
        ((middle - seen_[0]) * direction_ > 0 ? low_s : high_s) = next_s;
    }
    return high_s;
}

}  // namespace lyr::motion
