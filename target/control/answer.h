// What the server says, as a client reads it.
//
// Contract
//  1. read_answer() gives what a line holds, or none if it is no line of the protocol; members that it does not know
//     are passed over, since a later server may say more.
//  2. The status that it gives is the one that json_of() was given, within the digits of that.

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "target/run/print_control.h"

namespace lyr::control {

struct Greeting {
    int protocol = 0;
    std::string printer, file;
};
struct Refused {
    std::string code, message;
};
struct Accepted {};
struct Told {
    run::PrintStatus status;
    std::string printer;
    std::string json;  // of the status
    bool is_event = false;
};
using Answer = std::variant<Greeting, Refused, Accepted, Told>;

std::optional<Answer> read_answer(std::string_view line);

// For people, several lines.
std::string text_of(const Told& told);

}  // namespace lyr::control
