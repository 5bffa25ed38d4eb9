// toml++ parses; a walk over its tables looks every key up in the table of keys; what concerns several
// keys is checked last. All errors are collected with their places, since toml++ keeps its tables
// sorted by name and the first error in the file is the one to tell.

#include "target/config/printer.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <map>
#include <memory>
#include <set>

#include "base/constants.h"
#include "base/nearest_name.h"
#include "base/read_text.h"
#include "base/text.h"
#include "target/config/heater_keys.h"
#include "target/config/homing_keys.h"
#include "target/config/idle_keys.h"
#include "target/config/keys.h"
#include "target/config/life_keys.h"
#include "target/config/machine_keys.h"

namespace lyr::config {
namespace {

// A printer's file has a few kilobytes; more is some other file.
constexpr std::size_t largest_file = std::size_t{1} << 20;
// A row of a mesh of 100 points has a quarter of it. A key of more parts than fit would be so many tables in one another,
// each read and destroyed by a call within the last one's; cmake/toml.cmake bounds the rest of the nesting.
constexpr std::size_t longest_line = 4'096;
// No more are listed in a message.
constexpr std::size_t few_names = 4;
// A shorter part of a name says nothing.
constexpr std::size_t shortest_part = 4;

struct Place {
    std::uint32_t line = 0, column = 0;
    auto operator<=>(const Place&) const = default;
};

Place place_of(const toml::source_region& source) {
    return {static_cast<std::uint32_t>(source.begin.line),
            static_cast<std::uint32_t>(source.begin.column)};
}

Diagnostic input_error(std::string message, const std::string& file, Place place = {}) {
    Diagnostic error{Severity::error, ExitStatus::input, std::move(message), {}};
    error.where.file = file;
    error.where.line = place.line;
    error.where.column = place.column;
    return error;
}

// The only known name that holds what was written: "max_accel" stands for max_acceleration_mm_s2.
std::string name_in_full(std::string_view part, const std::vector<std::string>& known) {
    if (part.size() < shortest_part) return {};
    std::string found;
    for (const std::string& name : known) {
        if (name.find(part) == std::string::npos) continue;
        if (!found.empty()) return {};
        found = name;
    }
    return found;
}

// "bed, chamber, tool"
std::string listed(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
}

// Reads the tables of one file into a draft.
class Walk {
public:
    Walk() : keys_(printer_keys()) {
        for (const Key& key : keys_) by_path_[key.path] = &key;
    }

    void table(const toml::table& table, const std::string& prefix);
    void check_missing();
    void check_lines();
    void check_calibration();
    void check_files();
    void check_pulses();
    void check_machine();
    // The first problem in the order of the file.
    const std::pair<Place, std::string>* first_problem() const;
    Draft& draft() { return draft_; }
    // The file has this key or section.
    bool has(const std::string& path) const { return places_.count(path) != 0; }

private:
    void entry(const toml::key& name, const toml::node& node, const std::string& path);
    void unknown(const toml::key& name, const std::string& prefix);
    bool is_section(const std::string& path) const;
    // Of the key, else of the innermost table around it that the file has.
    Place place(std::string path) const;
    void problem(Place place, std::string message) {
        problems_.emplace_back(place, std::move(message));
    }

    std::vector<Key> keys_;
    std::map<std::string, const Key*> by_path_;
    std::map<std::string, Place> places_;
    std::vector<std::pair<Place, std::string>> problems_;
    Draft draft_;
};

bool Walk::is_section(const std::string& path) const {
    const auto next = by_path_.lower_bound(path + '.');
    return next != by_path_.end() && next->first.starts_with(path + '.');
}

Place Walk::place(std::string path) const {
    for (;;) {
        if (const auto known = places_.find(path); known != places_.end()) return known->second;
        const std::size_t dot = path.rfind('.');
        if (dot == std::string::npos) return {};
        path.resize(dot);
    }
}

void Walk::table(const toml::table& table, const std::string& prefix) {
    for (const auto& [name, node] : table) {
        const std::string path = prefix + std::string(name.str());
        places_[path] = place_of(name.source());
        const bool dotted = name.str().find('.') != std::string_view::npos;
        if (dotted || (!by_path_.count(path) && !is_section(path)))
            unknown(name, prefix);
        else
            entry(name, node, path);
    }
}

void Walk::entry(const toml::key& name, const toml::node& node, const std::string& path) {
    const auto known = by_path_.find(path);
    const Key* key = known == by_path_.end() ? nullptr : known->second;
    const toml::table* section = node.as_table();
    if (section && is_section(path)) {
        table(*section, path + '.');
        if (key && !section->contains("line"))
            problem(place_of(name.source()), path + ": expected `line`, the line's number or name");
    } else if (!key) {
        problem(place_of(name.source()),
                path + ": expected a section [" + path + "], found a value");
    } else if (const Complaint complaint = key->apply(node, draft_)) {
        problem(place_of(node.source()), path + ": " + *complaint);
    }
}

void Walk::unknown(const toml::key& name, const std::string& prefix) {
    std::set<std::string> here;
    for (const auto& [path, key] : by_path_)
        if (path.starts_with(prefix))
            here.insert(path.substr(prefix.size(), path.find('.', prefix.size()) - prefix.size()));
    const std::vector<std::string> candidates(here.begin(), here.end());
    std::string message = "unknown key `" + std::string(name.str()) + '`';
    if (!prefix.empty()) message += " in [" + prefix.substr(0, prefix.size() - 1) + ']';
    std::string nearest = nearest_name(name.str(), candidates);
    if (nearest.empty()) nearest = name_in_full(name.str(), candidates);
    if (!nearest.empty())
        message += "; did you mean `" + nearest + "`?";
    else if (candidates.size() <= few_names)
        message += "; known are " + listed(candidates);
    else
        message += "; docs/configuration.md lists the keys";
    problem(place_of(name.source()), std::move(message));
}

void Walk::check_missing() {
    for (const Key& key : keys_)
        if (key.required && !places_.count(key.path))
            problem(place(key.path), key.path + " is missing");
}

// Every line that a printer may have with the key that names it, in order.
template <class AnyPrinter>
auto lines_of(AnyPrinter& printer) {
    std::vector<std::pair<std::string, decltype(&printer.axes[0].step)>> lines;
    for (std::size_t i = 0; i < axis_count; ++i) {
        const std::string axis = "axis." + std::string(axis_names[i]) + '.';
        lines.emplace_back(axis + "step", &printer.axes[i].step);
        lines.emplace_back(axis + "direction", &printer.axes[i].direction);
        lines.emplace_back(axis + "enable", &printer.axes[i].enable);
    }
    for (std::size_t i = 0; i < heater_count; ++i)
        if (auto& heater = printer.heaters[i])
            lines.emplace_back("heater." + std::string(heater_names[i]) + ".output",
                               &heater->output);
    if (printer.part_fan) lines.emplace_back("fan.part.output", &printer.part_fan->output);
    for (std::size_t i = 0; i < printer.endstops.size(); ++i)
        lines.emplace_back("axis." + std::string(axis_names[i]) + ".endstop",
                           &printer.endstops[i].input);
    if (printer.probe) lines.emplace_back("probe.input", &printer.probe->input);
    for (std::size_t i = 0; i < input_count; ++i)
        lines.emplace_back("input." + std::string(input_names[i]), &printer.inputs[i]);
    return lines;
}

void Walk::check_lines() {
    std::map<std::pair<std::string, std::variant<std::uint32_t, std::string>>, std::string> users;
    for (const auto& [path, pin] : lines_of(draft_.printer)) {
        if (!*pin) continue;
        if ((*pin)->chip.empty()) (*pin)->chip = draft_.chip;
        const auto [user, fresh] = users.emplace(std::pair{(*pin)->chip, (*pin)->line}, path);
        if (fresh) continue;
        std::string message = path + ": this line is already used by " + user->second;
        // Drivers that share an enable line are common, and one key is enough for them.
        if (path.ends_with(".enable")) message += "; leave the key out here if drivers share it";
        problem(place(path), std::move(message));
    }
}

// Of two that share a channel one would be heated by the other's power, and stay on when that is a fan; of two that share a
// sensor nobody would watch one.
void Walk::check_files() {
    const auto files = used_files(draft_.printer);
    for (auto file = files.begin(); file != files.end(); ++file)
        for (auto user = files.begin(); user != file; ++user)
            if (file->second == user->second)
                problem(place(file->first),
                        file->first + ": this file is already used by " + user->first);
}

// Only what is written there again when something else is calibrated.
void Walk::check_calibration() {
    for (const auto& [path, where] : places_) {
        if (!by_path_.count(path)) continue;
        if (is_calibration_key(path))
            draft_.printer.calibrated.push_back(path);
        else
            problem(where, path + ": not a key of a calibration; it belongs in the printer's file");
    }
}

void Walk::check_pulses() {
    const PulseTiming& pulse = draft_.printer.pulse;
    const auto needed_ns = static_cast<double>(pulse.high_ns + pulse.low_ns);
    for (std::size_t i = 0; i < axis_count; ++i) {
        const Axis& axis = draft_.printer.axes[i];
        const double rate_hz = fastest_motor_mm_s(draft_.printer, i) * axis.steps_per_mm;
        if (rate_hz * needed_ns <= ns_per_s) continue;
        const std::string path = "axis." + std::string(axis_names[i]) + ".max_speed_mm_s";
        problem(place(path),
                path + ": " + std::to_string(std::llround(rate_hz)) +
                    " steps a second leave no time for pulses of pulse.high_us + pulse.low_us = " +
                    std::to_string(pulse.high_ns + pulse.low_ns) + " ns");
    }
}

void Walk::check_machine() {
    const auto given = [this](const std::string& path) { return has(path); };
    for (const auto& problems :
         {machine_problems(draft_.printer, given), homing_problems(draft_.printer, given),
          heat_problems(draft_.printer, given), life_problems(draft_.printer),
          idle_problems(draft_.printer, given)})
        for (const auto& [path, message] : problems) {
            const auto& calibrated = draft_.printer.calibrated;
            const bool is_calibrated =
                std::find(calibrated.begin(), calibrated.end(), path) != calibrated.end();
            problem(place(path), path + message +
                                     (is_calibrated ? "; it is in the calibration file, " +
                                                          draft_.printer.calibration_file
                                                    : ""));
        }
}

const std::pair<Place, std::string>* Walk::first_problem() const {
    // Without a place (line 0: a whole section is missing) comes last.
    const auto order = [](const auto& a, const auto& b) {
        return std::pair(a.first.line == 0, a.first) < std::pair(b.first.line == 0, b.first);
    };
    const auto first = std::min_element(problems_.begin(), problems_.end(), order);
    return first == problems_.end() ? nullptr : &*first;
}

Status check_lines_short(std::string_view text, const std::string& file) {
    std::uint32_t number = 0;
    for (std::size_t begin = 0; begin < text.size(); ++number) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        if (end - begin > longest_line)
            return input_error("this line has more than " + counted(longest_line, "byte") +
                                   ", which no value needs; a long list can take several lines",
                               file, {number + 1, 1});
        begin = end + 1;
    }
    return Done{};
}

Status take(Walk& walk, std::string_view text, const std::string& file) {
    if (Status are_short = check_lines_short(text, file); !are_short) return are_short;
    const toml::parse_result parsed = toml::parse(text, file);
    if (!parsed)
        return input_error(std::string(parsed.error().description()), file,
                           place_of(parsed.error().source()));
    walk.table(parsed.table(), "");
    return Done{};
}

// What was measured stands above what the printer's file says.
Status take_calibration(Draft& draft, const std::string& printer_file) {
    std::string& path = draft.printer.calibration_file;
    if (path.empty()) return Done{};
    if (path.find('/') == std::string::npos)
        path = printer_file.substr(0, printer_file.rfind('/') + 1) + path;
    const std::string file = path;
    if (::access(file.c_str(), F_OK) != 0 && errno == ENOENT) return Done{};
    const Result<std::string> text = read_text(file == "-" ? "./-" : file, largest_file);
    if (!text) return text.error();
    Walk walk;
    draft.printer.uncalibrated = std::make_shared<const Printer>(draft.printer);
    std::swap(walk.draft(), draft);
    if (Status taken = take(walk, *text, file); !taken) return taken;
    walk.check_calibration();
    if (const auto* problem = walk.first_problem())
        return input_error(problem->second, file, problem->first);
    std::swap(walk.draft(), draft);
    return Done{};
}

}  // namespace

Result<Printer> parse_printer(std::string_view text, const std::string& file) {
    Walk walk;
    if (Status taken = take(walk, text, file); !taken) return taken.error();
    if (!walk.first_problem())
        if (Status taken = take_calibration(walk.draft(), file); !taken) return taken.error();
    // A mistyped key is missing too; only the slip itself is worth telling.
    if (!walk.first_problem()) walk.check_missing();
    walk.check_lines();
    walk.check_files();
    walk.check_pulses();
    if (!walk.first_problem()) walk.check_machine();
    if (const auto* problem = walk.first_problem())
        return input_error(problem->second, file, problem->first);
    Printer printer = std::move(walk.draft().printer);
    printer.timing.is_given = walk.has("timing");
    if (printer.name.empty()) printer.name = "unnamed";
    return printer;
}

Result<Printer> read_printer(const std::string& path) {
    const Result<std::string> text = read_text(path, largest_file);
    if (!text) return text.error();
    return parse_printer(*text, path == "-" ? standard_input_name : path);
}

std::vector<std::pair<std::string, Pin>> used_lines(const Printer& printer) {
    std::vector<std::pair<std::string, Pin>> used;
    for (const auto& [path, pin] : lines_of(printer))
        if (*pin) used.emplace_back(path, **pin);
    return used;
}

std::vector<std::pair<std::string, std::string>> used_files(const Printer& printer) {
    std::vector<std::pair<std::string, std::string>> used;
    const auto use = [&](const std::string& path, std::string file) {
        while (file.ends_with('/')) file.pop_back();
        if (!file.empty()) used.emplace_back(path, std::move(file));
    };
    for (std::size_t i = 0; i < heater_count; ++i) {
        const std::optional<Heater>& heater = printer.heaters[i];
        if (!heater) continue;
        const std::string section = "heater." + std::string(heater_names[i]);
        use(section + ".pwm", heater->pwm);
        use(section + ".sensor.file", heater->sensor.file);
    }
    if (printer.part_fan) use("fan.part.pwm", printer.part_fan->pwm);
    return used;
}

Printer generic_printer() {
    constexpr double room_mm = 10'000;
    Printer printer;
    printer.name = "generic";
    printer.axes[axis_x] = {80, 300, 3'000, -room_mm, room_mm, false, {}, {}, {}};
    printer.axes[axis_y] = printer.axes[axis_x];
    printer.axes[axis_z] = {400, 12, 200, -room_mm, room_mm, false, {}, {}, {}};
    printer.axes[axis_e] = {400, 60, 5'000, 0, 0, false, {}, {}, {}};
    for (const std::size_t heater : {heater_tool, heater_bed})
        printer.heaters[heater] = default_heater(heater);
    printer.part_fan.emplace();
    return printer;
}

std::vector<std::string> known_keys() {
    std::set<std::string> paths;
    for (const Key& key : printer_keys()) {
        std::string path = key.path;
        for (const std::string_view section : {"axis.", "heater."})
            if (path.starts_with(section))
                path.replace(section.size(), path.find('.', section.size()) - section.size(), "*");
        paths.insert(path);
    }
    return {paths.begin(), paths.end()};
}

}  // namespace lyr::config
