// Diagnostics: what a program has to say about its input, as values that travel with the result.
//
// Contract
//  1. A function that can fail returns Result<T>: the value, or the one Diagnostic that explains why not.
//  2. What does not stop the work (a healed gap, a skipped entity) is appended to a Diagnostics list that
//     is passed down; nothing is printed below apps/.
//  3. to_string() gives one line, "place: severity: message", with every part of the place that is known, and no control
//     character, whatever the input's bytes are.

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace lyr {

enum class Severity : std::uint8_t { note, warning, error };

// Why a program ends with what status; docs/exit-status.md lists them for users.
enum class ExitStatus : int {
    ok = 0,
    internal = 1,     // a defect of the program itself
    usage = 2,        // options that make no sense
    input = 3,        // the input is missing, unreadable or not what it should be
    unsupported = 4,  // valid input that uses something not handled yet
    geometry = 5,     // a model that cannot be cut: gaps, contradictions, open contours
    output = 6,       // the result cannot be written
    machine = 7,      // the printer cannot do, or did not do, what the file asks
    stopped = 8,      // ended on request (SIGINT, SIGTERM) before it was done
    differs = 9,      // two prints that were compared are not the same
};

// Where in the input or the result. Everything is optional; `line` and `column` count from 1.
struct Location {
    std::string file{};
    std::uint32_t line = 0;
    std::uint32_t column = 0;
    std::uint64_t entity = 0;    // instance name #entity of a STEP file; 0: none
    std::optional<int> layer{};  // from 1, the layer on the bed, as people count
    std::optional<double> x_mm{}, y_mm{}, z_mm{};
};

struct Diagnostic {
    Severity severity = Severity::error;
    ExitStatus status = ExitStatus::input;  // of the program, if this is what ends it
    std::string message;                    // one line, without place and severity
    Location where;
};

using Diagnostics = std::vector<Diagnostic>;

std::string to_string(const Diagnostic& diagnostic);

// An error with status machine, and without a place.
Diagnostic machine_error(std::string message);

// A value or the reason why there is none. What a temporary holds is moved out of it, so that `auto&& x = *f();` and
// `for (auto& x : *f())` do not refer to what is gone.
template <class T>
class [[nodiscard]] Result {
public:
    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
    Result(Diagnostic error) : state_(std::in_place_index<1>, std::move(error)) {}

    bool ok() const { return state_.index() == 0; }
    explicit operator bool() const { return ok(); }
    T& value() & { return std::get<0>(state_); }
    const T& value() const& { return std::get<0>(state_); }
    T value() && { return std::get<0>(std::move(state_)); }
    T& operator*() & { return value(); }
    const T& operator*() const& { return value(); }
    T operator*() && { return std::move(*this).value(); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }
    const Diagnostic& error() const& { return std::get<1>(state_); }
    Diagnostic error() && { return std::get<1>(std::move(state_)); }

private:
    std::variant<T, Diagnostic> state_;
};

struct Done {};
using Status = Result<Done>;

}  // namespace lyr
