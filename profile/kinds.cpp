// Each kind is a reader, a writer and words; what they have in common is in scalar_key().

#include "profile/kinds.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "base/nearest_name.h"
#include "base/text.h"

namespace lyr::profile {
namespace {

std::string expected(const std::string& what, const Given& given) {
    return "expected " + what + ", found " + found(given);
}

// Without exponent, as people write the ends of a range.
std::string plain(double value) {
    std::array<char, 32> text{};
    const auto [end, error] =
        std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
    return error == std::errc() ? std::string(text.data(), end) : shortest(value);
}

std::string range_text(Range range, const Unit& unit) {
    const std::string text = plain(range.low) + " to " + plain(range.high);
    return unit.name.empty() ? text : text + ' ' + std::string(unit.name);
}

template <class T>
std::optional<T> if_inside(std::optional<T> value, Range range) {
    return value && *value >= range.low && *value <= range.high ? value : std::nullopt;
}

// A key of one value. `hint` is what else to say to somebody who gave something else.
template <class T>
Key scalar_key(std::string path, const std::string& accepts, const Member<T>& member,
               std::function<std::optional<T>(const Scalar&)> read,
               std::function<std::string(const T&)> show,
               std::function<std::string(const Scalar&)> hint = {}) {
    const auto store = [=](const Given& given, Profile& profile) -> Complaint {
        const auto* scalar = std::get_if<Scalar>(&given);
        const std::optional<T> value = scalar ? read(*scalar) : std::nullopt;
        if (!value)
            return expected(accepts, given) + (scalar && hint ? hint(*scalar) : std::string());
        member.set(profile, *value);
        return std::nullopt;
    };
    return {std::move(path), accepts, store,
            [=](const Profile& profile) { return show(member.get(profile)); }};
}

// For somebody who gave 15 where "15%" is meant.
std::string percent_hint(const Scalar& scalar, Range range) {
    const auto value = number_in(scalar, {""});
    if (!value || *value <= range.high || *value > 100 * range.high) return {};
    const std::string percent = shortest(*value) + '%';
    const bool bare = std::holds_alternative<Bare>(scalar);
    return "; write " + (bare ? percent : show_text(percent)) + " or " + shortest(*value / 100);
}

std::string name_hint(const Scalar& scalar, std::span<const std::string_view> names) {
    const auto text = text_in(scalar);
    const std::vector<std::string> known(names.begin(), names.end());
    const std::string nearest = text ? nearest_name(*text, known) : std::string();
    return nearest.empty() ? nearest : "; did you mean `" + nearest + "`?";
}

std::string alternatives(std::span<const std::string_view> names) {
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i > 0) text += i + 1 == names.size() ? " or " : ", ";
        text += names[i];
    }
    return text;
}

std::string show_list(const std::vector<std::string>& texts) {
    std::string shown;
    for (const std::string& text : texts) shown += (shown.empty() ? "" : ", ") + show_text(text);
    return '[' + shown + ']';
}

}  // namespace

Key number_key(std::string path, Member<double> member, Unit unit, Range range) {
    return scalar_key<double>(
        std::move(path), range_text(range, unit), member,
        [=](const Scalar& scalar) { return if_inside(number_in(scalar, unit), range); },
        [](double value) { return shortest(value); });
}

Key fraction_key(std::string path, Member<double> member, Range range) {
    const std::string accepts = plain(range.low * 100) + "% to " + plain(range.high * 100) + '%';
    return scalar_key<double>(
        std::move(path), accepts, member,
        [=](const Scalar& scalar) { return if_inside(fraction_in(scalar), range); },
        [](double value) { return show_fraction(value); },
        [=](const Scalar& scalar) { return percent_hint(scalar, range); });
}

Key count_key(std::string path, Member<std::uint32_t> member, Range range) {
    const auto read = [=](const Scalar& scalar) -> std::optional<std::uint32_t> {
        const auto value = if_inside(number_in(scalar, {""}), range);
        if (!value || *value != std::floor(*value)) return std::nullopt;
        return static_cast<std::uint32_t>(*value);
    };
    return scalar_key<std::uint32_t>(std::move(path),
                                     "a whole number from " + range_text(range, {""}), member, read,
                                     [](std::uint32_t value) { return std::to_string(value); });
}

Key switch_key(std::string path, Member<bool> member) {
    return scalar_key<bool>(
        std::move(path), "true or false", member,
        [](const Scalar& scalar) { return switch_in(scalar); },
        [](bool value) { return std::string(value ? "true" : "false"); });
}

Key choice_key(std::string path, Member<std::size_t> member,
               std::span<const std::string_view> names) {
    const auto read = [=](const Scalar& scalar) -> std::optional<std::size_t> {
        const auto text = text_in(scalar);
        const auto name = text ? std::find(names.begin(), names.end(), *text) : names.end();
        if (name == names.end()) return std::nullopt;
        return static_cast<std::size_t>(name - names.begin());
    };
    return scalar_key<std::size_t>(
        std::move(path), alternatives(names), member, read,
        [=](std::size_t value) { return show_text(std::string(names[value])); },
        [=](const Scalar& scalar) { return name_hint(scalar, names); });
}

Key text_key(std::string path, Member<std::string> member) {
    return scalar_key<std::string>(
        std::move(path), "a text", member, [](const Scalar& scalar) { return text_in(scalar); },
        [](const std::string& value) { return show_text(value); });
}

Key list_key(std::string path, Member<std::vector<std::string>> member) {
    const std::string accepts = "a list of texts";
    const auto store = [=](const Given& given, Profile& profile) -> Complaint {
        const auto list = list_in(given);
        if (!list) return expected(accepts, given);
        std::vector<std::string> texts;
        for (const Scalar& entry : *list) {
            const auto text = text_in(entry);
            if (!text) return expected(accepts, Given(entry)) + " in it";
            texts.push_back(*text);
        }
        member.set(profile, texts);
        return std::nullopt;
    };
    return {std::move(path), accepts, store,
            [=](const Profile& profile) { return show_list(member.get(profile)); }};
}

Key point_key(std::string path, Member<std::array<double, 2>> member, Unit unit, Range range) {
    const std::string each = ", each " + range_text(range, unit), in_file = "[x, y]" + each;
    const auto store = [=](const Given& given, Profile& profile) -> Complaint {
        const bool listed = std::holds_alternative<List>(given);
        const std::string accepts = listed ? in_file : "X,Y" + each;
        const auto list = list_in(given);
        if (!list || list->size() != 2) return expected(accepts, given);
        std::array<double, 2> point{};
        for (std::size_t i = 0; i < point.size(); ++i) {
            const auto value = if_inside(number_in((*list)[i], unit), range);
            if (!value)
                return expected(accepts, given) + (listed ? " with " + found((*list)[i]) : "");
            point[i] = *value;
        }
        member.set(profile, point);
        return std::nullopt;
    };
    return {std::move(path), in_file, store, [=](const Profile& profile) {
                const auto point = member.get(profile);
                return '[' + shortest(point[0]) + ", " + shortest(point[1]) + ']';
            }};
}

}  // namespace lyr::profile
