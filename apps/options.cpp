#include "apps/options.h"

#include <algorithm>

#include "base/text.h"

namespace lyr::command_line {
namespace {

constexpr std::size_t text_column = 30;    // of what an option is for
constexpr std::size_t most_columns = 100;  // of a line of help

// -5 is a number.
bool is_option(std::string_view word) {
    return word.size() > 1 && word[0] == '-' && !(word[1] >= '0' && word[1] <= '9');
}

// "--output" of "-o,--output".
std::string long_name(const Option& option) {
    return option.names.substr(option.names.find(',') + 1);
}

bool is_called(const Option& option, std::string_view name) {
    return name == long_name(option) ||
           name == std::string_view(option.names).substr(0, option.names.find(','));
}

// In lines that begin below each other.
std::string folded(std::string_view text) {
    std::string lines;
    for (constexpr std::size_t width = most_columns - text_column; text.size() > width;) {
        const std::size_t space = text.rfind(' ', width);
        if (space == std::string_view::npos) break;
        lines.append(text.substr(0, space)).append(1, '\n').append(text_column, ' ');
        text.remove_prefix(space + 1);
    }
    return lines.append(text);
}

std::string help_of(const Option& option) {
    std::string head = "  " + option.names;
    if (!option.shape.empty()) head += ' ' + option.shape;
    if (head.size() + 2 > text_column)
        head += '\n' + std::string(text_column, ' ');
    else
        head.resize(text_column, ' ');
    return head + folded(option.text) + '\n';
}

}  // namespace

Diagnostic usage(const std::string& message) {
    return {Severity::error, ExitStatus::usage, message, {}};
}

void Options::add(Option option) {
    known_.push_back({std::move(option)});
}

std::size_t Options::index_of(std::string_view name) const {
    const auto found = std::find_if(known_.begin(), known_.end(), [&](const Known& known) {
        return is_called(known.option, name);
    });
    return static_cast<std::size_t>(found - known_.begin());
}

std::size_t Options::count(std::string_view name) const {
    const std::size_t index = index_of(name);
    return index < known_.size() ? known_[index].count : 0;
}

Status Options::give(Known& known, const std::string& value) {
    const std::string name = long_name(known.option);
    if (known.count++ > 0 && !known.option.repeats)
        return usage(name + ": expected one value, once");
    if (const auto expected = known.option.take(value))
        return usage(name + ": expected " + *expected + ", found " + in_quotes(value));
    return Done{};
}

Status Options::take_alone(const std::string& word) {
    for (Known& known : known_)
        if (!is_option(known.option.names) && (known.count == 0 || known.option.repeats))
            return give(known, word);
    return usage("unexpected argument " + in_quotes(word));
}

// `after` is what follows: its first word may be the value.
Status Options::take_option(const std::string& word, std::span<char* const>& after) {
    const bool is_long = word[1] == '-';
    const std::size_t end = is_long ? std::min(word.find('='), word.size()) : 2;
    const std::size_t index = index_of(std::string_view(word).substr(0, end));
    if (index == known_.size()) return usage("unknown option " + in_quotes(word));
    Known& known = known_[index];
    std::optional<std::string> value;
    if (end < word.size()) value = word.substr(is_long ? end + 1 : end);
    if (known.option.shape.empty())
        return value ? usage(long_name(known.option) + ": takes no value") : give(known, "");
    const bool may_lack = known.option.shape.front() == '[';
    if (!value && !after.empty() && !(may_lack && is_option(after.front()))) {
        value = after.front();
        after = after.subspan(1);
    }
    if (!value && !may_lack) return usage(long_name(known.option) + ": expected one value, once");
    return give(known, value.value_or(""));
}

Status Options::parse(std::span<char* const> words) {
    Status first = Done{};
    for (bool all_alone = false; !words.empty();) {
        const std::string word = words.front();
        words = words.subspan(1);
        if (!all_alone && word == "--") {
            all_alone = true;
            continue;
        }
        const bool alone = all_alone || !is_option(word);
        const Status taken = alone ? take_alone(word) : take_option(word, words);
        if (first && !taken) first = taken;
    }
    return first;
}

std::string Options::help(const std::string& program) const {
    std::string words, options, usage = "Usage: " + program + " [OPTIONS]";
    for (const Known& known : known_) {
        const bool alone = !is_option(known.option.names);
        if (alone) usage += " [" + known.option.names + ']';
        (alone ? words : options) += help_of(known.option);
    }
    return usage + "\n\nPositionals:\n" + words + "\nOptions:\n" + options;
}

}  // namespace lyr::command_line
