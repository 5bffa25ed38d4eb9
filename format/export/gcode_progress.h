// The share that is done and the time that is left, as M73 tells a printer's display. Private to this room.
//
// Contract
//  1. The share never falls; a line is written only where percent or minutes change.
//  2. At a layer's start both are those of the layers' estimates; within it they follow way over speed, which never gets
//     ahead of the estimate. Without estimates the share is that of the layers, and no time is told.

#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "format/metadata.h"
#include "format/operation.h"

namespace lyr::format {

class GcodeProgress {
public:
    explicit GcodeProgress(const Summary& summary)
        : layers_(summary.layers), whole_s_(summary.estimated_time_s) {}

    void begin_layer(const Layer& layer, std::string& out) {
        done_s_ = layer_end_s_;
        layer_end_s_ += layer.state.estimated_time_s;
        tell(whole_s_ > 0 ? done_s_ / whole_s_
                          : static_cast<double>(layer.index) / std::max(layers_, 1u),
             out);
    }
    void pass(double length_mm, double speed_mm_s, std::string& out) {
        if (!(whole_s_ > 0) || !(speed_mm_s > 0)) return;
        done_s_ = std::min(done_s_ + length_mm / speed_mm_s, layer_end_s_);
        tell(done_s_ / whole_s_, out);
    }

private:
    void tell(double share, std::string& out) {
        constexpr double s_per_min = 60;
        const int percent = static_cast<int>(100 * std::min(share, 1.0));
        const std::int64_t minutes = std::llround(std::max(0.0, whole_s_ - done_s_) / s_per_min);
        if (percent == percent_ && minutes == minutes_) return;
        percent_ = percent;
        minutes_ = minutes;
        out += "M73 P" + std::to_string(percent);
        if (whole_s_ > 0) out += " R" + std::to_string(minutes);
        out += '\n';
    }

    std::uint32_t layers_;
    double whole_s_, done_s_ = 0, layer_end_s_ = 0;
    int percent_ = -1;
    std::int64_t minutes_ = -1;
};

}  // namespace lyr::format
