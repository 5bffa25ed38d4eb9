#include "apps/options.h"

#include <algorithm>
#include <vector>

#include "base/text.h"

namespace lyr::command_line {
namespace {

constexpr std::size_t text_column = 30;    // of what an option is for
constexpr std::size_t most_columns = 100;  // of a line of help

// What getopt_long() comes back with; else an option's letter, or its number after first_long.
constexpr int end_of_options = -1, stands_alone = 1, not_taken = '?', value_lacks = ':';
constexpr int first_long = 256;

bool is_negative(std::string_view word) {
    return word.size() > 1 && word[0] == '-' && word[1] >= '0' && word[1] <= '9';
}

bool is_option(std::string_view word) {
    return word.size() > 1 && word[0] == '-' && !is_negative(word);
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

Options::Grammar Options::grammar_of(const std::vector<Known>& known) {
    // Words that stand alone come in their order; a value that lacks is told apart.
    Grammar grammar{"-:", {}};
    for (std::size_t i = 0; i < known.size(); ++i) {
        const Option& option = known[i].option;
        if (!is_option(option.names)) continue;
        const int value = option.shape.empty()          ? no_argument
                          : option.shape.front() == '[' ? optional_argument
                                                        : required_argument;
        const char* name = option.names.c_str() + option.names.find("--") + 2;
        grammar.long_names.push_back({name, value, nullptr, first_long + static_cast<int>(i)});
        if (option.names[1] != '-')
            (grammar.short_names += option.names[1]).append(static_cast<std::size_t>(value), ':');
    }
    grammar.long_names.push_back({});
    return grammar;
}

// Of what getopt found.
std::size_t Options::index_of(int code) const {
    if (code >= first_long) return static_cast<std::size_t>(code - first_long);
    return index_of(std::string("-") + static_cast<char>(code));
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

// What getopt could not take.
Status Options::refused(int found, const char* word) const {
    if (optopt == 0) {
        const std::string_view name = word;
        return usage("unknown option " + in_quotes(name.substr(0, name.find('='))));
    }
    const std::size_t index = index_of(optopt);
    if (index == known_.size())
        return usage("unknown option " + in_quotes(std::string("-") + static_cast<char>(optopt)));
    const std::string name = long_name(known_[index].option);
    return usage(name + (found == value_lacks ? ": expected one value, once" : ": takes no value"));
}

// `next`, the word behind, is the value of an option that may lack one, unless it is an option.
Status Options::take(int found, const char* word, const char* next) {
    if (found == stands_alone) return take_alone(optarg);
    if (found == not_taken || found == value_lacks) return refused(found, word);
    Known& known = known_[index_of(found)];
    const bool may_lack = known.option.shape.starts_with('[');
    if (optarg || !may_lack || !next || is_option(next)) return give(known, optarg ? optarg : "");
    ++optind;
    return give(known, next);
}

Status Options::parse(std::span<char* const> words) {
    const Grammar grammar = grammar_of(known_);
    std::string program;
    std::vector<char*> all{program.data()};
    all.insert(all.end(), words.begin(), words.end());
    const int count = static_cast<int>(all.size());
    all.push_back(nullptr);
    const auto word_at = [&](int index) { return all[static_cast<std::size_t>(index)]; };
    Status first = Done{};
    const auto note = [&](const Status& taken) {
        if (first && !taken) first = taken;
    };
    const auto next_code = [&](int end) {
        return getopt_long(end, all.data(), grammar.short_names.c_str(), grammar.long_names.data(),
                           nullptr);
    };
    optind = 0;
    next_code(1);  // forgets the last command line
    for (;;) {
        // To getopt_long() a number below zero is an option.
        if (optind < count && is_negative(word_at(optind))) {
            note(take_alone(word_at(optind++)));
            continue;
        }
        const int found = next_code(count);
        if (found == end_of_options) break;
        note(take(found, word_at(optind - 1), word_at(optind)));
    }
    for (; optind < count; ++optind) note(take_alone(word_at(optind)));
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
