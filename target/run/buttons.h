// The input lines that ask something of a print: buttons, the filament sensor, an emergency line.
//
// Contract
//  1. pressed() gives each input that has become active since the last call, once; a contact must last for settle_ns.
//  2. An emergency line or a filament sensor that is active from the start counts as pressed; a button does not.
//  3. Lines that cannot be read are an error of pressed() (status machine).

#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "target/config/printer.h"
#include "target/gpio/debounce.h"
#include "target/gpio/input_lines.h"

namespace lyr::run {

class Buttons {
public:
    static constexpr std::int64_t settle_ns = 20'000'000;

    // The printer's inputs in their order are the lines.
    static Result<Buttons> start(const config::Printer& printer,
                                 std::unique_ptr<gpio::InputLines> lines);

    // Of config's InputNumber.
    Result<std::vector<std::size_t>> pressed(std::int64_t now_ns);
    // As of the last call of pressed().
    bool is_active(std::size_t number) const;

private:
    struct Input {
        std::size_t number;
        gpio::Debounce debounce;
    };

    explicit Buttons(std::unique_ptr<gpio::InputLines> lines) : lines_(std::move(lines)) {}

    std::unique_ptr<gpio::InputLines> lines_;
    std::vector<Input> inputs_;
};

// On a board; none: the printer has no inputs.
Result<std::optional<Buttons>> open_buttons(const config::Printer& printer);

// Where there is no print that a button could mean. None: all is well. The emergency line has become active (status
// stopped), or the lines cannot be read (theirs).
std::optional<Diagnostic> emergency(Buttons& buttons, std::int64_t now_ns);

std::vector<gpio::InputRequest> input_requests(const config::Printer& printer);

}  // namespace lyr::run
