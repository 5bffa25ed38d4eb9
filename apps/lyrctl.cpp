// lyrctl: tells how a print is going, and controls it, through the socket of the lyrrun that prints.

#include <algorithm>
#include <cmath>
#include <string>

#include "apps/command_line.h"
#include "apps/files.h"
#include "apps/page.h"
#include "apps/signal_watch.h"
#include "base/nearest_name.h"
#include "base/text.h"
#include "target/control/link.h"
#include "target/control/places.h"
#include "target/control/request.h"

namespace {

using namespace lyr;
using namespace lyr::command_line;

struct Arguments {
    std::vector<std::string> words;
    std::string socket;
    bool json = false, watch = false;
    std::string token_path;
};

constexpr Program program{
    "lyrctl", "Tells how a print is going, and controls it.",
    "Commands:\n"
    "  status            how far the print is, and its temperatures\n"
    "  pause             bring the head to rest and park it\n"
    "  resume            go on where the print was paused\n"
    "  change-filament   pause, and draw the filament out; resume when the next one is in\n"
    "  cancel            park, heaters off, the print is over\n"
    "  stop              EMERGENCY: motors and heaters at once; the print is lost\n"
    "  web PORT          a page that shows and controls prints, for this machine's browsers\n"
    "  set NAME=VALUE... tool, bed, chamber: °C (0: off); fan, speed: percent. The file's own\n"
    "                    settings follow when it comes to them\n"
    "\n"
    "Examples:\n"
    "  lyrctl status\n"
    "  lyrctl status --watch\n"
    "  lyrctl set tool=210 bed=60 fan=50% speed=120%\n"
    "  lyrctl web 8080\n"
    "  lyrctl pause --socket /run/lyr/ender.sock\n"
    "\n"
    "A command is done when the status says so; lyrctl ends as soon as lyrrun has accepted it.\n"
    "Where one printer is at work, it is found by itself. docs/control-protocol.md has the\n"
    "protocol for programs of your own.\n"
    "Exit status: 0 done, 2 options, 6 output, 7 no printer is at work, it cannot do this now, or\n"
    "(--watch) the print failed, 8 stopped on request, as it was, or (--watch) the print was.\n"};

void add_options(Options& app, Arguments& arguments) {
    add_texts(
        app, "command", "COMMAND ...",
        [&](const std::string& word) {
            arguments.words.push_back(word);
            return std::optional<std::string>();
        },
        "What to do; see below");
    add_file(app, "--socket", arguments.socket,
             "The printer's socket, where there are several, or one in another place");
    add_flag(app, "--json", arguments.json, "status: one JSON object, a line each with --watch");
    add_file(
        app, "--token", arguments.token_path,
        "web: a file with the token that the page asks for; made if it is missing, readable by "
        "its owner alone  [a new token each time, which is told]");
    add_flag(app, "--watch", arguments.watch, "status: again and again, until the print is over");
}

struct Plain {
    const char* word;     // of the command line
    const char* command;  // of the protocol
};
constexpr Plain plain_commands[] = {
    {"status", "status"}, {"pause", "pause"},
    {"resume", "resume"}, {"change-filament", "change_filament"},
    {"cancel", "cancel"}, {"stop", "stop"},
};

Diagnostic unknown_command(const std::string& word) {
    std::vector<std::string> known{"set", "web"};
    for (const Plain& plain : plain_commands) known.emplace_back(plain.word);
    const std::string nearest = nearest_name(word, known);
    return usage("unknown command " + in_quotes(word) +
                 (nearest.empty() ? "" : "; did you mean " + nearest + "?"));
}

// "fan=50%" is a member of "set".
Result<std::string> setting(const std::string& word) {
    struct Setting {
        const char* name;
        const char* member;
        bool is_share;
        double low, high;  // as they are given
    };
    constexpr double percent = 0.01, hottest_c = control::highest_target_c;
    constexpr Setting settings[] = {{"tool", "tool_c", false, 0, hottest_c},
                                    {"bed", "bed_c", false, 0, hottest_c},
                                    {"chamber", "chamber_c", false, 0, hottest_c},
                                    {"fan", "fan", true, 0, 100},
                                    {"speed", "speed", true, run::least_speed_factor / percent,
                                     run::most_speed_factor / percent}};
    const std::size_t equals = std::min(word.find('='), word.size());
    for (const Setting& each : settings) {
        if (word.substr(0, equals) != each.name) continue;
        std::string value = word.substr(std::min(equals + 1, word.size()));
        // A share without its sign would leave open whether 1 is all or next to nothing.
        const bool has_unit = value.ends_with('%');
        if (has_unit) value.pop_back();
        const auto number = finite_number(value);
        if (!number || has_unit != each.is_share || *number < each.low || *number > each.high)
            return usage("set " + std::string(each.name) + ": expected " +
                         (each.is_share ? "a number" : "°C,") +
                         formatted(" from %g to %g", each.low, each.high) +
                         (each.is_share ? " and %" : "") + ", found " + in_quotes(word));
        return '"' + std::string(each.member) +
               "\":" + shortest(each.is_share ? *number * percent : *number);
    }
    return usage("set: expected tool=, bed=, chamber=, fan= or speed=, found " + in_quotes(word));
}

// The line to send.
Result<std::string> request_of(const Arguments& arguments) {
    const auto& words = arguments.words;
    if (words.empty()) return usage("a command is required");
    if (words[0] != "web" && !arguments.token_path.empty()) return usage("--token goes with web");
    if (words[0] != "status" && (arguments.json || arguments.watch))
        return usage("--json and --watch go with status");
    if (words[0] == "set") {
        if (words.size() < 2) return usage("set: expected what to set, such as tool=210");
        std::string line = "{\"id\":1,\"command\":\"set\"";
        for (std::size_t i = 1; i < words.size(); ++i) {
            const Result<std::string> member = setting(words[i]);
            if (!member) return member.error();
            line += ',' + *member;
        }
        return line + '}';
    }
    for (const Plain& plain : plain_commands) {
        if (words[0] != plain.word) continue;
        if (words.size() > 1) return usage("unexpected argument " + in_quotes(words[1]));
        return "{\"id\":1,\"command\":\"" + std::string(plain.command) + "\"}";
    }
    return unknown_command(words[0]);
}

Result<std::string> find_socket(const Arguments& arguments) {
    if (!arguments.socket.empty()) return arguments.socket;
    const std::vector<std::string> found = control::sockets();
    if (found.size() == 1) return found[0];
    std::string places;
    for (const std::string& place : found.empty() ? control::socket_folders() : found)
        places += (places.empty() ? "" : ", ") + place;
    if (found.empty())
        return machine_error("no printer is at work: there is no socket in " + places);
    return usage("several printers are at work; choose one with --socket: " + places);
}

Status show(const control::Told& told, const Arguments& arguments) {
    if (arguments.json) return tell(told.json + '\n');
    return tell(text_of(told));
}

Status watch(control::Link& link, const Arguments& arguments) {
    constexpr const char* subscribe = R"({"id":1,"command":"subscribe","interval_s":1})";
    const SignalWatch signals(program.name);
    if (Status sent = link.send(subscribe); !sent) return sent;
    for (;;) {
        const Result<control::Answer> answer = link.next();
        if (!answer) return answer.error();
        if (const auto* refused = std::get_if<control::Refused>(&*answer))
            return machine_error(refused->message);
        const auto* told = std::get_if<control::Told>(&*answer);
        if (!told) continue;
        if (Status shown = show(*told, arguments); !shown) return shown;
        if (!run::is_over(told->status.state)) continue;
        if (told->status.state == run::PrintState::done) return Done{};
        if (told->status.state == run::PrintState::stopped)
            return Diagnostic{Severity::error,
                              ExitStatus::stopped,
                              "the print was stopped: " + told->status.message,
                              {}};
        return machine_error("the print failed: " + told->status.message);
    }
}

Result<PageOptions> page_of(const Arguments& arguments) {
    const auto& words = arguments.words;
    const std::optional<double> port = words.size() == 2 ? finite_number(words[1]) : std::nullopt;
    if (!port || *port < 0 || *port > 65535 || *port != std::floor(*port))
        return usage("web: expected a port, 1 to 65535, or 0 for one that is free");
    if (arguments.json || arguments.watch) return usage("--json and --watch go with status");
    return PageOptions{static_cast<std::uint16_t>(*port), arguments.socket, arguments.token_path};
}

Status work(const Arguments& arguments) {
    if (!arguments.words.empty() && arguments.words[0] == "web") {
        const Result<PageOptions> page = page_of(arguments);
        return page ? serve_page(program, *page) : page.error();
    }
    const Result<std::string> request = request_of(arguments);
    if (!request) return request.error();
    const Result<std::string> socket = find_socket(arguments);
    if (!socket) return socket.error();
    Result<control::Link> link = control::Link::open(*socket);
    if (!link) return link.error();
    if (arguments.watch) return watch(*link, arguments);
    if (Status sent = link->send(*request); !sent) return sent;
    const Result<control::Answer> answer = link->next();
    if (!answer) return answer.error();
    if (const auto* refused = std::get_if<control::Refused>(&*answer))
        return machine_error(refused->message);
    if (const auto* told = std::get_if<control::Told>(&*answer)) return show(*told, arguments);
    return Done{};
}

}  // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    return run_main(
        program, argc, argv, [&](Options& app) { add_options(app, arguments); },
        [&](const Options&) { return work(arguments); });
}
