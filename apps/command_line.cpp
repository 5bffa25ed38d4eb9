// Values are taken as text and read here, so that every program refuses the same things in the same words.

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

#include "apps/signal_watch.h"
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
    if (shown.status == ExitStatus::stopped) end_soon(shown.status);
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

// Writes an answer of the program itself.
Status say(const std::string& text) {
    auto out = ReplaceFile::open("-");
    if (!out) return out.error();
    out->write(text);
    return out->commit();
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

Status parse_and_work(const Program& program, std::span<char* const> words,
                      const std::function<void(Options&)>& add_options,
                      const std::function<Status(const Options&)>& work) {
    Options options;
    bool help = false, version = false;
    add_flag(options, "-h,--help", help, "Print this help message and exit");
    add_flag(options, "--version", version, "Display program version information and exit");
    add_options(options);
    const Status parsed = options.parse(words);
    if (help)
        return say(program.purpose + std::string(1, '\n') + options.help(program.name) + '\n' +
                   program.examples + '\n');
    if (version) return say(program.name + std::string(" " LYR_VERSION "\n"));
    return parsed ? work(options) : parsed;
}

}  // namespace

int run_main(const Program& program, int argc, char** argv,
             const std::function<void(Options&)>& add_options,
             const std::function<Status(const Options&)>& work) {
    // Nothing of this project throws; what the standard library throws (no memory) ends here.
    try {
        keep_standard_descriptors();
        make_signals_errors();
        const auto all = std::span(argv, static_cast<std::size_t>(argc));
        const Status done = parse_and_work(program, all.subspan(argc > 0), add_options, work);
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

void add_text(Options& options, const std::string& option, const char* shape, TakeText take,
              const std::string& text) {
    options.add({option, shape, std::move(take), text});
}

void add_texts(Options& options, const std::string& option, const char* shape, TakeText take,
               const std::string& text) {
    options.add({option, shape, std::move(take), text, true});
}

void add_file(Options& options, const std::string& option, std::string& path,
              const std::string& text) {
    const auto take = [&path](const std::string& value) -> std::optional<std::string> {
        if (value.empty()) return "the name of a file";
        path = value;
        return std::nullopt;
    };
    add_text(options, option, "FILE", take, text);
}

void add_flag(Options& options, const std::string& option, bool& flag, const std::string& text) {
    const auto take = [&flag](const std::string&) {
        flag = true;
        return std::optional<std::string>();
    };
    add_texts(options, option, "", take, text);
}

void add_numbers(Options& options, const std::string& option, const char* shape,
                 std::span<double> values, const NumberRange& range, const std::string& text) {
    const auto take = [=](const std::string& value) -> std::optional<std::string> {
        if (take_numbers(value, values, range)) return std::nullopt;
        const bool one = values.size() == 1;
        return (one ? "a number from " : shape + std::string(", each from ")) + limits_of(range);
    };
    std::string shown = std::string(shape) + "  [";
    for (const double& value : values) shown += (&value == &values[0] ? "" : ",") + shortest(value);
    shown += ']';
    add_text(options, option, shown.c_str(), take, text + "; " + limits_of(range));
}

void add_count(Options& options, const std::string& option, const char* shape, std::uint32_t& value,
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
    add_text(options, option, shape, take, text);
}

}  // namespace lyr::command_line
