// A PWM channel of the kernel, by its folder in sysfs.
//
// Contract
//  1. open() takes a channel that is exported and has a period, and leaves it enabled with nothing on it; what
//     is missing is a diagnostic (status machine) that says what to write where.
//  2. set() writes only what changes, but an off always, and anything after a write that failed.
//  3. The destructor leaves nothing on it.
//  4. A channel that is locked (flock) by another is a diagnostic, and nothing is written. The lock of Use::alone lasts until
//     the object and all processes forked since are gone. Use::switch_off takes none and heeds none.

#pragma once

#include <cstdint>
#include <string>

#include "base/diagnostic.h"

namespace lyr::thermal {

class KernelPwm {
public:
    enum class Use : std::uint8_t { alone, switch_off };

    static Result<KernelPwm> open(const std::string& folder, Use use = Use::alone);
    KernelPwm(KernelPwm&& other) noexcept;
    KernelPwm& operator=(KernelPwm&&) = delete;
    ~KernelPwm();

    // 0 to 1.
    Status set(double share);

private:
    KernelPwm(std::string folder, int duty_file, std::int64_t period_ns)
        : folder_(std::move(folder)), duty_file_(duty_file), period_ns_(period_ns) {}

    std::string folder_;
    int duty_file_;
    std::int64_t period_ns_;
    std::int64_t duty_ns_ = -1;  // as last written; below 0: not known
};

}  // namespace lyr::thermal
