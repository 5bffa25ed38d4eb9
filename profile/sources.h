// Finds a profile by the name that somebody gave: a file, standard input or one of the built-in ones. Private to this
// room.

#pragma once

#include <string>

#include "base/diagnostic.h"

namespace lyr::profile {

struct Source {
    std::string shown{};  // what messages call it: "profiles/abs.toml"
    std::string path{};   // the file; "-": standard input; empty: built in
    std::string name{};   // "abs"; empty for standard input
    std::string text{};
    std::string folder{};  // to which the names that it gives are relative; empty: the current one
    std::string identity{};  // the same for the same text, whatever it was called
    bool built_in = false;
};

// Contract
//  1. A name that ends in .toml is the file of that name or, without a folder in it and with no such file, the built-in
//     profile. A name without is the built-in profile or, if there is none, the file. "-" is standard input.
//  2. Errors (status input): not there, unreadable, more than 1 MiB; the message names the built-in profiles.
Result<Source> find_source(const std::string& name);

// As `from` means the name: files are relative to its folder, and what is built in names only what is built in.
Result<Source> find_source(const std::string& name, const Source& from);

}  // namespace lyr::profile
