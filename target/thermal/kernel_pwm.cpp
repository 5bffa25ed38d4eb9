// The file of the duty cycle stays open, so that nothing but one write is left to fail later.

#include "target/thermal/kernel_pwm.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/read_text.h"

namespace lyr::thermal {
namespace {

constexpr const char* in_use = "in use: end that program first (fuser tells which)";

Diagnostic failed(const std::string& file, const std::string& why) {
    return {Severity::error, ExitStatus::machine, "kernel PWM: " + why, {.file = file}};
}

bool write_text(int file, const std::string& text) {
    const ssize_t written = ::pwrite(file, text.data(), text.size(), 0);
    // One that is short sets none.
    if (written >= 0) errno = EIO;
    return written == static_cast<ssize_t>(text.size());
}

}  // namespace

Result<KernelPwm> KernelPwm::open(const std::string& folder, Use use) {
    constexpr std::size_t longest_number = 64;
    const std::string period_path = folder + "/period", duty_path = folder + "/duty_cycle",
                      enable_path = folder + "/enable";
    const auto text = read_text(period_path, longest_number);
    if (!text)
        return failed(period_path,
                      "the channel is not there; write its number to ../export of its folder");
    std::int64_t period_ns = 0;
    std::from_chars(text->data(), text->data() + text->size(), period_ns);
    if (period_ns <= 0)
        return failed(period_path, "no period is set; write one in nanoseconds to this file");
    const int duty = ::open(duty_path.c_str(), O_WRONLY | O_CLOEXEC);
    if (duty < 0) return failed(duty_path, std::strerror(errno));
    // Held for as long as anyone has this descriptor, as a keeper that was forked does: until it has dropped the channel.
    if (use == Use::alone && ::flock(duty, LOCK_EX | LOCK_NB) != 0) {
        const int error = errno;
        ::close(duty);
        return failed(duty_path, error == EWOULDBLOCK ? in_use : std::strerror(error));
    }
    KernelPwm pwm(folder, duty, period_ns);
    if (Status off = pwm.set(0); !off) return off.error();
    const int enable = ::open(enable_path.c_str(), O_WRONLY | O_CLOEXEC);
    const bool enabled = enable >= 0 && write_text(enable, "1");
    const int error = errno;
    if (enable >= 0) ::close(enable);
    if (!enabled) return failed(enable_path, std::strerror(error));
    return pwm;
}

KernelPwm::KernelPwm(KernelPwm&& other) noexcept
    : folder_(std::move(other.folder_)),
      duty_file_(std::exchange(other.duty_file_, -1)),
      period_ns_(other.period_ns_),
      duty_ns_(other.duty_ns_) {}

KernelPwm::~KernelPwm() {
    if (duty_file_ < 0) return;
    (void)set(0);
    ::close(duty_file_);
}

Status KernelPwm::set(double share) {
    const double wanted = std::clamp(share, 0.0, 1.0) * static_cast<double>(period_ns_);
    const std::int64_t duty_ns = std::llround(wanted);
    if (duty_ns == duty_ns_ && duty_ns != 0) return Done{};
    // One that fails may have got there in part.
    duty_ns_ = -1;
    if (!write_text(duty_file_, std::to_string(duty_ns) + '\n'))
        return failed(folder_ + "/duty_cycle", std::strerror(errno));
    duty_ns_ = duty_ns;
    return Done{};
}

}  // namespace lyr::thermal
