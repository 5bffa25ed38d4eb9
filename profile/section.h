// Adds the keys of one section of a Profile to the table. Private to this room.

#pragma once

#include <string>
#include <utility>
#include <vector>

#include "profile/kinds.h"

namespace lyr::profile {

template <class S>
class Section {
public:
    Section(std::vector<Key>& keys, std::string name, S Profile::*section)
        : keys_(keys), name_(std::move(name)), section_(section) {}

    Section& number(const char* name, double S::*field, Unit unit, Range range, const char* help) {
        return add(number_key(path(name), member(field), unit, range), help);
    }
    Section& fraction(const char* name, double S::*field, Range range, const char* help) {
        return add(fraction_key(path(name), member(field), range), help);
    }
    Section& count(const char* name, std::uint32_t S::*field, Range range, const char* help) {
        return add(count_key(path(name), member(field), range), help);
    }
    Section& flag(const char* name, bool S::*field, const char* help) {
        return add(switch_key(path(name), member(field)), help);
    }
    // `names` are those of the enumerators, in their order.
    template <class Enum>
    Section& choice(const char* name, Enum S::*field, std::span<const std::string_view> names,
                    const char* help) {
        const Member<Enum> value = member(field);
        const Member<std::size_t> number{
            [=](const Profile& profile) { return static_cast<std::size_t>(value.get(profile)); },
            [=](Profile& profile, std::size_t n) { value.set(profile, static_cast<Enum>(n)); }};
        return add(choice_key(path(name), number, names), help);
    }
    Section& text(const char* name, std::string S::*field, const char* help) {
        return add(text_key(path(name), member(field)), help);
    }
    Section& list(const char* name, std::vector<std::string> S::*field, const char* help) {
        return add(list_key(path(name), member(field)), help);
    }
    Section& point(const char* name, std::array<double, 2> S::*field, Unit unit, Range range,
                   const char* help) {
        return add(point_key(path(name), member(field), unit, range), help);
    }

    // Of the key that was added last: what holds if nobody says it.
    Section& otherwise(const char* text, void (*set)(Profile&)) {
        keys_.back().derived = Derived{text, set};
        return *this;
    }

private:
    std::string path(const char* name) const { return name_ + '.' + name; }
    Section& add(Key key, const char* help) {
        key.help = help;
        keys_.push_back(std::move(key));
        return *this;
    }
    template <class T>
    Member<T> member(T S::*field) const {
        return {[section = section_, field](const Profile& p) { return p.*section.*field; },
                [section = section_, field](Profile& p, const T& v) { p.*section.*field = v; }};
    }

    std::vector<Key>& keys_;
    std::string name_;
    S Profile::*section_;
};

}  // namespace lyr::profile
