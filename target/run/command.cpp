// One table of words; each says how many values follow and what they make.

#include "target/run/command.h"

#include <algorithm>
#include <array>
#include <sstream>

#include "base/nearest_name.h"
#include "base/text.h"
#include "target/config/heater.h"

namespace lyr::run {
namespace {

// No heater of any printer goes further; what this one can do is asked where the command is carried out.
constexpr double highest_target_c = 1'000;

ParsedCommand number_in(const std::string& word, double low, double high, Command (*make)(double)) {
    const std::optional<double> value = finite_number(word);
    if (value && *value >= low && *value <= high) return make(*value);
    return formatted("expected a number from %g to %g, found ", low, high) + in_quotes(word);
}

ParsedCommand set_temperature(const std::vector<std::string>& words) {
    const auto& names = config::heater_names;
    const auto name = std::find(names.begin(), names.end(), words[1]);
    if (name == names.end()) return "expected tool, bed or chamber, found " + in_quotes(words[1]);
    ParsedCommand parsed = number_in(words[2], 0, highest_target_c, [](double target_c) -> Command {
        return SetTemperature{0, target_c};
    });
    if (auto* command = std::get_if<Command>(&parsed))
        std::get<SetTemperature>(*command).heater = static_cast<std::size_t>(name - names.begin());
    return parsed;
}

using Words = std::vector<std::string>;

struct Word {
    std::string_view name;
    const char* values;  // what must follow, for messages
    std::size_t count;
    ParsedCommand (*parse)(const Words&);
};

template <class Plain>
ParsedCommand plain(const Words&) {
    return Command(Plain{});
}

constexpr std::array<Word, 8> commands{{
    {"pause", "nothing", 0, plain<Pause>},
    {"resume", "nothing", 0, plain<Resume>},
    {"change_filament", "nothing", 0, plain<ChangeFilament>},
    {"cancel", "nothing", 0, plain<Cancel>},
    {"emergency_stop", "nothing", 0, plain<EmergencyStop>},
    {"set", "a heater and a temperature", 2, set_temperature},
    {"fan", "a share from 0 to 1", 1,
     [](const Words& words) {
         return number_in(words[1], 0, 1, [](double duty) -> Command { return SetFan{duty}; });
     }},
    {"speed", "a factor from 0.1 to 3", 1,
     [](const Words& words) {
         return number_in(words[1], least_speed_factor, most_speed_factor,
                          [](double factor) -> Command { return SetSpeedFactor{factor}; });
     }},
}};

template <class... Calls>
struct Overloaded : Calls... {
    using Calls::operator()...;
};

}  // namespace

ParsedCommand parse_command(const Words& words) {
    if (words.empty()) return "expected a command";
    const auto word = std::find_if(commands.begin(), commands.end(),
                                   [&](const Word& known) { return known.name == words[0]; });
    if (word == commands.end()) {
        std::vector<std::string> names;
        for (const Word& known : commands) names.emplace_back(known.name);
        const std::string nearest = nearest_name(words[0], names);
        return "unknown command " + in_quotes(words[0]) +
               (nearest.empty() ? "" : "; did you mean `" + nearest + "`?");
    }
    if (words.size() != word->count + 1) return "`" + words[0] + "` takes " + word->values;
    return word->parse(words);
}

std::string text_of(const Command& command) {
    const Overloaded texts{
        [](const Pause&) { return std::string("pause"); },
        [](const Resume&) { return std::string("resume"); },
        [](const ChangeFilament&) { return std::string("change_filament"); },
        [](const Cancel&) { return std::string("cancel"); },
        [](const EmergencyStop&) { return std::string("emergency_stop"); },
        [](const SetTemperature& set) {
            return "set " + std::string(config::heater_names[set.heater]) + ' ' +
                   shortest(set.target_c);
        },
        [](const SetFan& fan) { return "fan " + shortest(fan.duty); },
        [](const SetSpeedFactor& speed) { return "speed " + shortest(speed.factor); }};
    return std::visit(texts, command);
}

Result<std::vector<TimedCommand>> parse_script(std::string_view text, const std::string& file) {
    std::vector<TimedCommand> script;
    std::istringstream lines{std::string(text)};
    std::string line;
    for (std::uint32_t number = 1; std::getline(lines, line); ++number) {
        std::istringstream split(line.substr(0, line.find('#')));
        Words words;
        for (std::string word; split >> word;) words.push_back(word);
        if (words.empty()) continue;
        const auto wrong = [&](const std::string& complaint) {
            return Diagnostic{
                Severity::error, ExitStatus::input, complaint, {.file = file, .line = number}};
        };
        const std::optional<double> time_s = finite_number(words[0]);
        if (!time_s || *time_s < 0)
            return wrong("expected a time in seconds, found " + in_quotes(words[0]));
        words.erase(words.begin());
        const ParsedCommand parsed = parse_command(words);
        if (const auto* complaint = std::get_if<std::string>(&parsed)) return wrong(*complaint);
        script.push_back({*time_s, std::get<Command>(parsed)});
    }
    std::stable_sort(
        script.begin(), script.end(),
        [](const TimedCommand& a, const TimedCommand& b) { return a.time_s < b.time_s; });
    return script;
}

}  // namespace lyr::run
