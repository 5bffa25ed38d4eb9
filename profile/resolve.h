// From a profile, what it inherits and the settings of a command line to the one configuration that holds.
//
// Contract
//  1. A later setting wins over an earlier one, settings win over the profile, and a profile over what it inherits. What
//     nobody says is the default or, of keys that follow from another, what follows from that one.
//  2. The result keeps the contract of profile/profile.h, whatever is given. Every value has its origin.
//  3. Errors are of status input and have file, line and column where a file is wrong: not TOML, not there, an unknown
//     key (with the nearest known one), a wrong type, out of range, a key that stands twice, a profile that inherits
//     itself. They are of status usage, with the option, where a setting is. Of several errors in a file the first is
//     given.
//  4. Two values that contradict each other are an error that names both with their origins, of status usage if a
//     setting is one of them.
//  5. resolve() of what to_toml() gives is the same profile.

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "profile/profile.h"

namespace lyr::profile {

// What a command line says: `key` and `value` by `option`, which is how the origin is shown ("--set").
struct Setting {
    std::string key, value, option;
};

// "layer.height=0.2", with or without spaces around the =; none without a = or a key.
std::optional<Setting> parse_setting(std::string_view text, const std::string& option);

struct Request {
    std::string
        profile;  // name of a file or of a built-in profile; "-": standard input; empty: none
    std::vector<Setting> settings;
};

struct Origin {
    enum class Kind : std::uint8_t { unsaid, file, built_in, option };
    Kind kind = Kind::unsaid;
    std::string name;        // of the file, or the option
    std::uint32_t line = 0;  // of the file
};

struct Resolved {
    Profile profile;
    std::string
        name;  // of the profile that was asked for: "abs"; empty: none, or from standard input
    std::vector<Origin> origins;     // of the keys, in the order of keys()
    std::vector<std::string> files;  // that were read; "-": standard input
};

Result<Resolved> resolve(const Request& request);

// Whether origins name files with their folders, or without, as suits what is given to others.
enum class Folders : std::uint8_t { shown, left_out };

// All keys as TOML, each with its origin: `height = 0.2  # abs.toml:7`.
std::string to_toml(const Resolved& resolved, Folders folders = Folders::shown);

}  // namespace lyr::profile
