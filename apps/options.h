// The words of a command line: options with their values, and words that stand alone. The C library's getopt_long() takes
// them apart; as it keeps its place in global variables, one command line is read at a time.
//
// Contract
//  1. "--name VALUE", "--name=VALUE", "-n VALUE" and "-nVALUE" say the same. The value is any word, also one that begins
//     with a dash, but where it may be left out: there such a word is the next option.
//     A name may be cut short while it is clear.
//  2. Words that stand alone may be anywhere, and all are that after "--". A dash alone is one of them, and so is -5.
//  3. Each option is given once, but for those that repeat. What is wrong first is the error; what follows it is read
//     nevertheless, so that --help is always understood.

#pragma once

#include <getopt.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"

namespace lyr::command_line {

// Stores a value, or answers what was expected in its place: "KEY=VALUE".
using TakeText = std::function<std::optional<std::string>(const std::string&)>;

struct Option {
    std::string names;  // "--json", "-o,--output"; without dashes for words that stand alone
    std::string
        shape;  // how help shows the value: "FILE", "[AXES]" if it may be left out; "" if there is none
    TakeText take;     // gets "" for a value that is left out
    std::string text;  // what help says
    bool repeats = false;
};

class Options {
public:
    void add(Option option);
    Status parse(std::span<char* const> words);

    // How often the option was given that has this name.
    std::size_t count(std::string_view name) const;

    // The usage and every option, in lines of at most 100 columns.
    std::string help(const std::string& program) const;

private:
    struct Known {
        Option option;
        std::size_t count = 0;
    };

    // For getopt_long().
    struct Grammar {
        std::string short_names;
        std::vector<::option> long_names;
    };

    static Grammar grammar_of(const std::vector<Known>& known);
    std::size_t index_of(int code) const;
    std::size_t index_of(std::string_view name) const;
    Status give(Known& known, const std::string& value);
    Status take_alone(const std::string& word);
    Status take(int found, const char* word, const char* next);
    Status refused(int found, const char* word) const;

    std::vector<Known> known_;
};

// Options that make no sense.
Diagnostic usage(const std::string& message);

}  // namespace lyr::command_line
