// CLI11 splits the words into options; values are taken as text and read here, so that every program refuses the same
// things in the same words.

#include "apps/command_line.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <limits>
#include <new>
#include <numeric>
#include <optional>
#include <system_error>
#include <vector>

#include "base/replace_file.h"
#include "base/text.h"

namespace lyr::command_line {
namespace {

// A file with ten thousand dirty edges does not need ten thousand lines.
constexpr std::size_t most_shown = 20;

void show(const Program& program, const Diagnostic& diagnostic) {
    std::fprintf(stderr, "%s: %s\n", program.name, to_string(diagnostic).c_str());
}

int fail(const Program& program, const Diagnostic& diagnostic) {
    Diagnostic shown = diagnostic;
    if (shown.status == ExitStatus::usage)
        shown.message += std::string(" (") + program.name + " --help explains)";
    show(program, shown);
    return static_cast<int>(shown.status);
}

// Where standard input, output or error is closed, the next file that is opened would take its place, and get what is
// said to people. Reading /dev/null there makes writing fail, as it should.
void keep_standard_descriptors() {
    for (int open = STDIN_FILENO; open <= STDERR_FILENO;) {
        open = ::open("/dev/null", O_RDONLY);
        if (open > STDERR_FILENO) ::close(open);
        if (open < 0) return;
    }
}

// A reader that goes away and a limit on file sizes are errors of output, with a message and nothing left behind.
void make_signals_errors() {
    for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
}

// CLI11's words for the user's mistakes, turned into ours.
Diagnostic usage_error(const CLI::App& app, const CLI::ParseError& error) {
    const std::string text = error.what();
    if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
        for (const std::string& word : app.remaining())
            if (word != "--")
                return usage((word.starts_with('-') ? "unknown option " : "unexpected argument ") +
                             in_quotes(word));
    }
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) == nullptr) return usage(text);
    // CLI11 begins with the option's name and a colon, but for flags, whose name it says without dashes.
    const std::size_t end = text.find_first_of(": ");
    return text[end] == ':' ? usage(text.substr(0, end) + ": expected one value, once")
                            : usage("--" + text.substr(0, end) + ": takes no value");
}

// Whether there is work to do.
Result<bool> parse(CLI::App& app, int argc, char** argv) {
    std::string answer;
    try {
        app.parse(argc, argv);
        return true;
    } catch (const CLI::CallForHelp&) {
        answer = app.help();
    } catch (const CLI::CallForVersion& version) {
        answer = std::string(version.what()) + '\n';
    } catch (const CLI::ParseError& error) {
        return usage_error(app, error);
    }
    auto out = ReplaceFile::open("-");
    if (!out) return out.error();
    out->write(answer);
    if (const Status written = out->commit(); !written) return written.error();
    return false;
}

std::string limits_of(const NumberRange& range) {
    std::string text = shortest(range.low) + " to " + shortest(range.high);
    if (*range.unit != '\0') text += std::string(" ") + range.unit;
    return text;
}

// False, with nothing stored, if the text is not as many numbers of the range as there are values.
bool take_numbers(std::string_view text, std::span<double> values, const NumberRange& range) {
    std::vector<double> read;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const auto number = finite_number(text.substr(begin, end - begin));
        if (!number || *number < range.low || *number > range.high) return false;
        read.push_back(*number);
        begin = end + 1;
    }
    if (read.size() != values.size()) return false;
    std::copy(read.begin(), read.end(), values.begin());
    return true;
}

}  // namespace

int run_main(const Program& program, int argc, char** argv,
             const std::function<void(CLI::App&)>& add_options,
             const std::function<Status(const CLI::App&)>& work) {
    // Nothing of this project throws; what the standard library throws (no memory) ends here.
    try {
        keep_standard_descriptors();
        make_signals_errors();
        CLI::App app(program.purpose, program.name);
        app.footer(program.examples);
        app.set_version_flag("--version", program.name + std::string(" " LYR_VERSION));
        add_options(app);
        const Result<bool> parsed = parse(app, argc, argv);
        if (!parsed) return fail(program, parsed.error());
        const Status done = *parsed ? work(app) : Status(Done{});
        return done ? static_cast<int>(ExitStatus::ok) : fail(program, done.error());
    } catch (const std::bad_alloc&) {
        return fail(program, {Severity::error, ExitStatus::internal, "out of memory", {}});
    } catch (const std::system_error& error) {
        return fail(program,
                    {Severity::error,
                     ExitStatus::internal,
                     "the system gives no more threads or memory: " + std::string(error.what()),
                     {}});
    } catch (const std::exception& error) {
        return fail(program, {Severity::error, ExitStatus::internal, error.what(), {}});
    }
}

Diagnostic usage(const std::string& message) {
    return {Severity::error, ExitStatus::usage, message, {}};
}

std::vector<std::size_t> most_telling(const Diagnostics& diagnostics, std::size_t most) {
    std::vector<std::size_t> chosen(diagnostics.size());
    std::iota(chosen.begin(), chosen.end(), std::size_t{0});
    std::stable_sort(chosen.begin(), chosen.end(), [&](std::size_t a, std::size_t b) {
        return diagnostics[a].severity > diagnostics[b].severity;
    });
    chosen.resize(std::min(chosen.size(), most));
    std::sort(chosen.begin(), chosen.end());
    return chosen;
}

void show(const Program& program, const Diagnostics& diagnostics) {
    const std::vector<std::size_t> shown = most_telling(diagnostics, most_shown);
    for (const std::size_t i : shown) show(program, diagnostics[i]);
    if (diagnostics.size() > shown.size())
        std::fprintf(stderr, "%s: ... and %zu more\n", program.name,
                     diagnostics.size() - shown.size());
}

CLI::Option* add_text(CLI::App& app, const std::string& option, const char* shape, TakeText take,
                      const std::string& text) {
    const std::string name = option.substr(option.find(',') + 1);
    const auto read = [name, take = std::move(take)](const std::string& value) {
        if (const auto expected = take(value))
            throw CLI::ValidationError(name,
                                       "expected " + *expected + ", found " + in_quotes(value));
    };
    return app.add_option_function<std::string>(option, read, text)->option_text(shape);
}

CLI::Option* add_texts(CLI::App& app, const std::string& option, const char* shape, TakeText take,
                       const std::string& text) {
    return add_text(app, option, shape, std::move(take), text)->trigger_on_parse();
}

CLI::Option* add_file(CLI::App& app, const std::string& option, std::string& path,
                      const std::string& text) {
    const auto take = [&path](const std::string& value) -> std::optional<std::string> {
        if (value.empty()) return "the name of a file";
        path = value;
        return std::nullopt;
    };
    return add_text(app, option, "FILE", take, text);
}

void add_flag(CLI::App& app, const std::string& option, bool& flag, const std::string& text) {
    app.add_flag(option, flag, text)->disable_flag_override();
}

void add_numbers(CLI::App& app, const std::string& option, const char* shape,
                 std::span<double> values, const NumberRange& range, const std::string& text) {
    const auto take = [=](const std::string& value) -> std::optional<std::string> {
        if (take_numbers(value, values, range)) return std::nullopt;
        const bool one = values.size() == 1;
        return (one ? "a number from " : shape + std::string(", each from ")) + limits_of(range);
    };
    std::string shown = std::string(shape) + "  [";
    for (const double& value : values) shown += (&value == &values[0] ? "" : ",") + shortest(value);
    shown += ']';
    add_text(app, option, shown.c_str(), take, text + "; " + limits_of(range));
}

void add_count(CLI::App& app, const std::string& option, const char* shape, std::uint32_t& value,
               const CountRange& range, const std::string& text) {
    const auto take = [&value, range](const std::string& word) -> std::optional<std::string> {
        std::uint32_t count = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), count);
        if (error == std::errc() && end == word.data() + word.size() && count >= range.low &&
            count <= range.high) {
            value = count;
            return std::nullopt;
        }
        std::string expected = "a whole number from " + std::to_string(range.low);
        if (range.high != std::numeric_limits<std::uint32_t>::max())
            expected += " to " + std::to_string(range.high);
        return expected;
    };
    add_text(app, option, shape, take, text);
}

}  // namespace lyr::command_line
