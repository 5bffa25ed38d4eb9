#include "target/control/web/history.h"

#include <algorithm>
#include <limits>

#include "base/text.h"

namespace lyr::control {

void History::take(const run::PrintStatus& status) {
    if (last_s_ && status.elapsed_s - *last_s_ < sample_s) return;
    last_s_ = status.elapsed_s;
    Sample sample;
    sample.time_s = static_cast<float>(status.elapsed_s);
    sample.values_c.fill(std::numeric_limits<float>::quiet_NaN());
    for (std::size_t i = 0; i < config::heater_count; ++i) {
        const run::HeaterNow& heater = status.heaters[i];
        if (!heater.is_present) continue;
        sample.values_c[2 * i] = static_cast<float>(heater.temperature_c);
        sample.values_c[2 * i + 1] = static_cast<float>(heater.target_c);
    }
    if (ring_.size() < most_samples)
        ring_.push_back(sample);
    else
        ring_[count_ % most_samples] = sample;
    ++count_;
}

std::string History::since(std::uint64_t number) const {
    const std::uint64_t oldest = count_ - ring_.size();
    std::string text = "{\"next\":" + std::to_string(count_) + ",\"samples\":[";
    const std::uint64_t from = std::clamp(number, oldest, count_);
    for (std::uint64_t i = from; i < count_; ++i) {
        const Sample& sample = ring_[i % most_samples];
        text += formatted(i == from ? "[%.0f" : ",[%.0f", static_cast<double>(sample.time_s));
        for (const float value : sample.values_c)
            text += ',' + in_json(static_cast<double>(value), 1);
        text += ']';
    }
    return text + "]}";
}

}  // namespace lyr::control
