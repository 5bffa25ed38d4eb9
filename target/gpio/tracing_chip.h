// A chip around another that writes what happens to its lines as a Value Change Dump (IEEE 1364,
// section 18), which GTKWave and other wave viewers read.
//
// Contract
//  1. Every write is passed on first; only what succeeded is traced.
//  2. The file has a time scale of 1 ns, one wire a line named after its purpose ("x.step" becomes
//     x_step), the state at the start, and from then on changes only. 1 is active, whatever the
//     level.
//  3. Time is the clock's since the chip was made, and never goes back.
//  4. finish() writes the time of the end, so that the last state has a length, and what is still
//  in the
//     buffer; it comes before the file's commit(), which reports failures to write.

#pragma once

#include <span>
#include <string>

#include "base/replace_file.h"
#include "target/gpio/clock.h"
#include "target/gpio/gpio_chip.h"

namespace lyr::gpio {

class TracingChip final : public GpioChip {
public:
    // `names` one a line of `inner`; all four must outlive the chip.
    TracingChip(GpioChip& inner, const Clock& clock, std::span<const std::string> names,
                ReplaceFile& file);
    ~TracingChip() override;

    std::size_t line_count() const override { return inner_.line_count(); }
    Status write(LineMask changed, LineMask levels) override;
    Status release() override;
    void finish();

private:
    void trace(LineMask changed, LineMask levels);
    void append_time();
    void append_level(std::size_t line);
    void flush();

    GpioChip& inner_;
    const Clock& clock_;
    ReplaceFile& file_;
    std::string buffer_;
    std::int64_t start_ns_;
    std::int64_t traced_ns_ = -1;  // time of the last "#" line
    LineMask levels_ = 0;
    bool released_ = false;
};

}  // namespace lyr::gpio
