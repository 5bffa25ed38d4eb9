// What a client asks: one JSON object a line. docs/control-protocol.md is the specification.
//
// Contract
//  1. Whatever the bytes are, read_request() gives a request that is whole and in its ranges, or one refusal that says
//     what is wrong in words, with a code that does not change between versions, and the request's id if it has one.
//  2. Members that a command does not know, that stand twice, or that hold an object or a list are refused, so that a
//     mistyped one is not passed over.

#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "target/run/command.h"

namespace lyr::control {

enum class ErrorCode : std::uint8_t {
    bad_json,     // the line is no JSON
    bad_request,  // it is no object with a command and the members that the command has
    unknown_command,
    bad_value,  // a member is not of its kind or out of its range
    line_too_long,
    too_many_clients,  // another one needs the place; then the connection ends
    wrong_state,       // the print cannot do this now
    no_such_heater,    // ... that this printer has
    busy,              // too many commands wait already
    forbidden,         // of the page: no token, or another site's page asks
};
std::string_view name_of(ErrorCode code);

// No heater of any printer goes further; what this one can do is asked where it is known.
inline constexpr double highest_target_c = 1'000;

struct GetStatus {};
struct Subscribe {
    double interval_s = 0;  // 0: no more
};
// Carried out in their order.
using Commands = std::vector<run::Command>;

struct Request {
    std::string id = "null";  // as JSON
    std::variant<GetStatus, Subscribe, Commands> wish;
};

struct Refusal {
    std::string id = "null";
    ErrorCode code = ErrorCode::bad_json;
    std::string message;
};

inline constexpr double shortest_interval_s = 0.1, longest_interval_s = 3600;
inline constexpr std::size_t longest_id_bytes = 64;

std::variant<Request, Refusal> read_request(std::string_view line);

// The answers.
std::string done_line(const std::string& id);
std::string refusal_line(const Refusal& refusal);

}  // namespace lyr::control
