// The keys of printer.toml: one table of path, rule and destination, from which the reading, the
// messages and the list of known keys all follow. Private to this room.
//
// Contract
//  1. Key::apply stores the node's value in the draft, or returns what is wrong with it (without place
//     and without the key's name) and stores nothing.

#pragma once

#include <toml++/toml.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "target/config/printer.h"

namespace lyr::config {

// A printer while its file is being read.
struct Draft {
    Printer printer;
    std::string chip = "gpiochip0";  // of lines that name none
};

using Complaint = std::optional<std::string>;

struct Key {
    std::string path;  // "axis.x.steps_per_mm"
    bool required = false;
    bool pin = false;  // may be a table whose entries are keys of their own
    std::function<Complaint(const toml::node&, Draft&)> apply;
};

std::vector<Key> printer_keys();

}  // namespace lyr::config
