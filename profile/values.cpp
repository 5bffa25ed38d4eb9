// Numbers are read by from_chars, their units by comparison without spaces.

#include "profile/values.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "base/text.h"

namespace lyr::profile {
namespace {

const std::string* characters(const Scalar& scalar) {
    if (const auto* bare = std::get_if<Bare>(&scalar)) return &bare->text;
    return std::get_if<std::string>(&scalar);
}

std::string tight(std::string_view text) {
    std::string out(text);
    std::erase(out, ' ');
    return out;
}

bool means(std::string_view text, const Unit& unit) {
    const std::string word = tight(text);
    return word.empty() || word == tight(unit.name) ||
           std::find(unit.also.begin(), unit.also.end(), word) != unit.also.end();
}

// How many bytes of the text are a number.
std::size_t digits_of(std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return static_cast<std::size_t>(end - text.data());
}

std::optional<double> without_minus_zero(std::optional<double> value) {
    return value && *value == 0 ? 0.0 : value;
}

}  // namespace

std::string found(const Scalar& scalar) {
    if (const auto* number = std::get_if<double>(&scalar)) return shortest(*number);
    if (const auto* flag = std::get_if<bool>(&scalar)) return *flag ? "true" : "false";
    if (const std::string* text = characters(scalar)) return in_quotes(*text);
    return "a value of another type";
}

std::string found(const Given& given) {
    const auto* scalar = std::get_if<Scalar>(&given);
    return scalar ? found(*scalar) : "a list";
}

std::optional<double> number_in(const Scalar& scalar, const Unit& unit) {
    if (const auto* number = std::get_if<double>(&scalar))
        return std::isfinite(*number) ? without_minus_zero(*number) : std::nullopt;
    const std::string* text = characters(scalar);
    if (!text) return std::nullopt;
    const std::size_t digits = digits_of(*text);
    if (!means(std::string_view(*text).substr(digits), unit)) return std::nullopt;
    return without_minus_zero(finite_number(std::string_view(*text).substr(0, digits)));
}

std::optional<double> fraction_in(const Scalar& scalar) {
    if (const auto plain = number_in(scalar, {""})) return plain;
    const auto percent = number_in(scalar, {"%"});
    if (!percent) return std::nullopt;
    const std::string& text = *characters(scalar);
    // With an exponent of its own, which nobody writes, it is off by half a unit of the last digit.
    const auto exact = finite_number(text.substr(0, digits_of(text)) + "e-2");
    return exact ? without_minus_zero(exact) : *percent / 100;
}

std::optional<bool> switch_in(const Scalar& scalar) {
    if (const auto* flag = std::get_if<bool>(&scalar)) return *flag;
    const auto* bare = std::get_if<Bare>(&scalar);
    if (!bare || (bare->text != "true" && bare->text != "false")) return std::nullopt;
    return bare->text == "true";
}

std::optional<std::string> text_in(const Scalar& scalar) {
    const std::string* text = characters(scalar);
    if (!text || text->empty() || escaped(*text) != *text) return std::nullopt;
    return *text;
}

std::optional<List> list_in(const Given& given) {
    if (const auto* list = std::get_if<List>(&given)) return *list;
    const auto* bare = std::get_if<Bare>(&std::get<Scalar>(given));
    if (!bare) return std::nullopt;
    List list;
    if (bare->text.empty()) return list;
    for (std::size_t begin = 0; begin <= bare->text.size();) {
        const std::size_t end = std::min(bare->text.find(',', begin), bare->text.size());
        list.emplace_back(Bare{bare->text.substr(begin, end - begin)});
        begin = end + 1;
    }
    return list;
}

std::string show_fraction(double value) {
    // As many digits of a percentage as anybody writes; what has more is shown as it is.
    std::array<char, 32> percent{};
    std::snprintf(percent.data(), percent.size(), "%.12g%%", value * 100);
    const std::string text = percent.data();
    return fraction_in(Scalar(text)) == value ? show_text(text) : shortest(value);
}

std::string show_text(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += c;
    }
    return out + '"';
}

}  // namespace lyr::profile
