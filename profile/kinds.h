// The kinds of key: what each takes, how it is shown, and what is wrong with what it refuses. Private to this room.
//
// Contract
//  1. Key::store stores what is given, or returns what is wrong with it (without place and without the key's name) and
//     stores nothing.
//  2. What Key::show gives is TOML from which Key::store reads the same value, bit for bit.
//  3. A fraction that is too large, but would not be as a percentage, is refused with what to write instead.

#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "profile/profile.h"
#include "profile/values.h"

namespace lyr::profile {

using Complaint = std::optional<std::string>;

// What holds where nobody says anything, if that follows from another key.
struct Derived {
    std::string text;  // "as layer.height"
    void (*set)(Profile&) = nullptr;
};

struct Key {
    std::string path;     // "layer.height"
    std::string accepts;  // "0.001 to 10 mm"
    std::function<Complaint(const Given&, Profile&)> store;
    std::function<std::string(const Profile&)> show;
    std::string help{};
    std::optional<Derived> derived{};
};

// A value within a Profile.
template <class T>
struct Member {
    std::function<T(const Profile&)> get;
    std::function<void(Profile&, const T&)> set;
};

struct Range {
    double low, high;
};

Key number_key(std::string path, Member<double> member, Unit unit, Range range);
Key fraction_key(std::string path, Member<double> member, Range range);
Key count_key(std::string path, Member<std::uint32_t> member, Range range);
Key switch_key(std::string path, Member<bool> member);
// The value is the place of its name among `names`, which outlive the key.
Key choice_key(std::string path, Member<std::size_t> member,
               std::span<const std::string_view> names);
Key text_key(std::string path, Member<std::string> member);
Key list_key(std::string path, Member<std::vector<std::string>> member);
Key point_key(std::string path, Member<std::array<double, 2>> member, Unit unit, Range range);

}  // namespace lyr::profile
