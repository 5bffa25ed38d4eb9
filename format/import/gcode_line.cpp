#include "format/import/gcode_line.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/text.h"

namespace lyr::format {
namespace {

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}
bool is_digit(char c) {
    return c >= '0' && c <= '9';
}
char upper(char c) {
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}
bool is_letter(char c) {
    return upper(c) >= 'A' && upper(c) <= 'Z';
}

std::string_view behind_number(std::string_view text) {
    std::size_t at = 1;
    while (at < text.size() && is_digit(text[at])) ++at;
    return trimmed(text.substr(at));
}

// "G1", "G01" is the same; "G92.1" is not.
std::string command_of(std::string_view text, std::size_t& used) {
    std::string command(1, upper(text[0]));
    used = 1;
    const bool is_number = text.size() > 1 && is_digit(text[1]);
    const auto belongs = [&](char c) {
        return is_number ? is_digit(c) || c == '.' : is_letter(c) || is_digit(c) || c == '_';
    };
    while (used < text.size() && belongs(text[used])) command += upper(text[used++]);
    if (is_number)
        while (command.size() > 2 && command[1] == '0' && is_digit(command[2])) command.erase(1, 1);
    return command;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
    return text;
}

GcodeLine gcode_line(std::string_view text) {
    GcodeLine line;
    const std::size_t semicolon = text.find(';');
    if (semicolon != std::string_view::npos) line.comment = trimmed(text.substr(semicolon + 1));
    text = trimmed(text.substr(0, semicolon));
    for (;;) {
        if (text.starts_with('('))
            text = trimmed(text.substr(std::min(text.find(')'), text.size() - 1) + 1));
        else if (text.size() > 1 && upper(text[0]) == 'N' && is_digit(text[1]))
            text = behind_number(text);
        else
            break;
    }
    if (text.empty() || text == "%") return line;
    if (!is_letter(text[0])) {
        line.command = text.substr(0, text.find(' '));
        return line;
    }
    std::size_t used = 0;
    line.command = command_of(text, used);
    line.rest = trimmed(text.substr(used));
    return line;
}

std::optional<GcodeWords> gcode_words(std::string_view rest, bool flags, std::string& why) {
    GcodeWords words;
    for (std::size_t at = 0; at < rest.size();) {
        const char c = rest[at];
        if (is_space(c)) {
            ++at;
            continue;
        }
        if (c == '*') break;
        if (c == '(') {
            at = std::min(rest.find(')', at), rest.size() - 1) + 1;
            continue;
        }
        if (!is_letter(c)) {
            why = "expected a letter and a number, found " + in_quotes(rest.substr(at));
            return std::nullopt;
        }
        std::size_t begin = at + 1;
        while (begin < rest.size() && is_space(rest[begin])) ++begin;
        if (begin < rest.size() && rest[begin] == '+') ++begin;
        std::size_t end = begin;
        while (end < rest.size() && (is_digit(rest[end]) || rest[end] == '.' || rest[end] == '-'))
            ++end;
        double value = 0;
        const auto [stop, error] = std::from_chars(rest.data() + begin, rest.data() + end, value);
        const bool is_flag = begin == end;
        const bool is_number =
            error == std::errc() && stop == rest.data() + end && std::isfinite(value);
        if (is_flag ? !flags : !is_number) {
            why = "expected a number behind " + std::string(1, c) + ", found " +
                  in_quotes(rest.substr(at + 1, rest.find(' ', at) - at - 1));
            return std::nullopt;
        }
        std::optional<double>& word = words.at(upper(c));
        if (word) {
            why = std::string("the letter ") + c + " stands twice";
            return std::nullopt;
        }
        word = value;
        at = is_flag ? at + 1 : end;
    }
    return words;
}

std::string_view gcode_parameter(std::string_view rest, std::string_view key) {
    for (std::size_t at = 0; at < rest.size();) {
        const std::size_t end = std::min(rest.find(' ', at), rest.size());
        const std::string_view word = rest.substr(at, end - at);
        const std::size_t equals = word.find('=');
        if (equals == key.size() && std::equal(key.begin(), key.end(), word.begin(),
                                               [](char a, char b) { return a == upper(b); }))
            return word.substr(equals + 1);
        at = end + 1;
    }
    return {};
}

}  // namespace lyr::format
