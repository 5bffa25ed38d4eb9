// What the command lines of the programs have in common: main(), options and their messages.

#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "apps/options.h"
#include "base/diagnostic.h"

namespace lyr::command_line {

struct Program {
    const char* name;
    const char* purpose;
    const char* examples;  // what stands below the options in --help
};

// All of main(): parses, then works. What fails is told in one line on standard error and ends with its status;
// docs/exit-status.md has the numbers. --help and --version are answered here.
int run_main(const Program& program, int argc, char** argv,
             const std::function<void(Options&)>& add_options,
             const std::function<Status(const Options&)>& work);

// Which to show where not all can be: errors before warnings before notes, the first of each. In their order.
std::vector<std::size_t> most_telling(const Diagnostics& diagnostics, std::size_t most);

// The most telling of them on standard error, one line each, and how many more there are.
void show(const Program& program, const Diagnostics& diagnostics);

// The options below refuse what is not of their kind, and say what they expect.

// The name of a file; `path` is left as it is where the option is not given.
void add_file(Options& options, const std::string& option, std::string& path,
              const std::string& text);

// Any text that `take` takes. A shape in brackets, "[AXES]", is a value that may be left out.
void add_text(Options& options, const std::string& option, const char* shape, TakeText take,
              const std::string& text);

// The same, and it may be given more than once: `take` is called each time, in the order of the command line.
void add_texts(Options& options, const std::string& option, const char* shape, TakeText take,
               const std::string& text);

void add_flag(Options& options, const std::string& option, bool& flag, const std::string& text);

struct NumberRange {
    double low, high;
    const char* unit;
};
// As many finite numbers as `values` holds, with commas between them. `shape` is how help shows them: "MM", "X,Y";
// the values are its defaults.
void add_numbers(Options& options, const std::string& option, const char* shape,
                 std::span<double> values, const NumberRange& range, const std::string& text);

struct CountRange {
    std::uint32_t low, high;
};
void add_count(Options& options, const std::string& option, const char* shape, std::uint32_t& value,
               const CountRange& range, const std::string& text);

}  // namespace lyr::command_line
