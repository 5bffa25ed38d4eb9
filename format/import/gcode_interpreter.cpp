// Lines and commands; interpret_motion.cpp has those that move the head or the filament.

#include "format/import/gcode_interpreter.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>

#include "base/text.h"
#include "format/export/gcode_roles.h"

namespace lyr::format {
namespace {

constexpr double mm_per_inch = 25.4, s_per_min = 60, ms_per_s = 1000, full_fan = 255;
// G10 where no M207 says how far.
constexpr double usual_firmware_depth_mm = 1, usual_firmware_mm_s = 40;
// More of it is told. Rounding leaves some 0.00001 mm a retraction.
constexpr double least_pushed_aside_mm = 0.01;

// Of M220 and M221: more is a mistake; none of it would stop the machine.
constexpr double full_percent = 100, most_percent = 1000;

// Commands without which a print is the same.
struct Passed {
    std::string_view command, reason;
};
constexpr std::array passed{
    Passed{"M17", "motors on"},
    Passed{"M18", "motors off"},
    Passed{"M84", "motors off"},
    Passed{"M73", "tells people"},
    Passed{"M105", "asks"},
    Passed{"M114", "asks"},
    Passed{"M115", "asks"},
    Passed{"M117", "tells people"},
    Passed{"M118", "tells people"},
    Passed{"M110", "numbers of lines"},
    Passed{"M201", "limits of the machine"},
    Passed{"M203", "limits of the machine"},
    Passed{"M205", "limits of the machine"},
    Passed{"M400", "waits for the motions before"},
    Passed{"M555", "where the print is, for probing"},
    Passed{"M862.1", "checks the machine"},
    Passed{"M862.3", "checks the machine"},
    Passed{"M900", "the machine's own pressure advance"},
    Passed{"M107.1", "a fan beside the print"},
    Passed{"EXCLUDE_OBJECT_DEFINE", "names come with EXCLUDE_OBJECT_START"}};

// Motions, or what would make others of those that follow.
struct Refused {
    std::string_view command, reason;
};
constexpr std::array refused{Refused{"G5", "a spline"},
                             Refused{"G5.1", "a spline"},
                             Refused{"G6", "steps of the motors"},
                             Refused{"G18", "arcs lie in the plane of x and y"},
                             Refused{"G19", "arcs lie in the plane of x and y"},
                             Refused{"G42", "a motion to a point of the machine's mesh"},
                             Refused{"G51", "scaled motions"},
                             Refused{"G53", "positions of the machine"},
                             Refused{"G61", "a motion to a place that was kept"},
                             Refused{"G68", "turned motions"},
                             Refused{"G81", "a cycle of drilling"},
                             Refused{"G82", "a cycle of drilling"},
                             Refused{"G83", "a cycle of drilling"},
                             Refused{"G90.1", "centres of arcs are relative"},
                             Refused{"G93", "speeds by time"},
                             Refused{"M98", "another file's lines"},
                             Refused{"M808", "lines that are repeated"},
                             Refused{"FORCE_MOVE", "a motion of a motor"}};

const Refused* refusal(std::string_view name) {
    const auto* found = std::find_if(refused.begin(), refused.end(),
                                     [&](const Refused& one) { return one.command == name; });
    return found == refused.end() ? nullptr : found;
}

bool is_passed(std::string_view name) {
    return std::any_of(passed.begin(), passed.end(),
                       [&](const Passed& one) { return one.command == name; });
}

// "X20 E1" after a G1, as some programs write: machines differ in what they do with it.
bool is_word(std::string_view command) {
    constexpr std::string_view letters = "ABCEFIJKRUVWXYZ";
    return letters.find(command[0]) != std::string_view::npos &&
           (command.size() == 1 || (command[1] >= '0' && command[1] <= '9'));
}

bool is_one_of(std::string_view text, std::initializer_list<std::string_view> some) {
    return std::find(some.begin(), some.end(), text) != some.end();
}

std::uint32_t whole(std::optional<double> value) {
    constexpr double most = 255;
    return static_cast<std::uint32_t>(std::clamp(value.value_or(0), 0.0, most));
}

// 0: none that a strand has.
double thickness(std::string_view text) {
    const double value = finite_number(text).value_or(0);
    return value >= thinnest_mm && value <= thickest_mm ? value : 0;
}

bool is_tool(const std::string& name) {
    return name.size() > 1 && name[0] == 'T' &&
           std::all_of(name.begin() + 1, name.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

Diagnostic GcodeInterpreter::error(const std::string& message) const {
    return {Severity::error, ExitStatus::input, message, {.file = name_, .line = line_}};
}

bool GcodeInterpreter::begins_layer(std::string_view line) const {
    const std::size_t semicolon = line.find(';');
    return facts_.marks_layers && semicolon != std::string_view::npos &&
           format::begins_layer(trimmed(line.substr(semicolon + 1)));
}

GcodeLayer GcodeInterpreter::take_layer() {
    GcodeLayer layer = std::move(layer_);
    layer_ = {.begin = at_};
    height_is_layers_ = facts_.marks_layers;
    return layer;
}

Status GcodeInterpreter::take(std::string_view text, std::uint32_t number) {
    line_ = number;
    if (const auto object = begun_object(text); !object.empty()) {
        add_object(object);
        return Done{};
    }
    const GcodeLine line = gcode_line(text);
    if (!line.comment.empty()) take_comment(line.comment);
    return line.command.empty() ? Status(Done{}) : command(line);
}

void GcodeInterpreter::add_object(std::string_view name) {
    const auto found = std::find(facts_.objects.begin(), facts_.objects.end(), escaped(name));
    append(Object{static_cast<std::uint32_t>(found - facts_.objects.begin()) + 1});
}

void GcodeInterpreter::take_object_number(std::string_view rest) {
    const std::string_view number = object_mark(rest).number;
    if (number.empty()) return;  // names and counts are facts
    const auto& numbers = facts_.object_numbers;
    const auto found = std::find(numbers.begin(), numbers.end(), number);
    append(Object{
        found == numbers.end() ? 0 : static_cast<std::uint32_t>(found - numbers.begin()) + 1});
}

void GcodeInterpreter::take_comment(std::string_view comment) {
    const auto value = [&](std::string_view key) -> std::optional<std::string_view> {
        if (!comment.starts_with(key)) return std::nullopt;
        return trimmed(comment.substr(key.size()));
    };
    const auto number = [](std::string_view text) { return finite_number(text).value_or(0); };
    if (const auto type = value("TYPE:")) role_ = role_of_gcode(*type);
    if (const auto feature = value("FEATURE:")) role_ = role_of_gcode(*feature);
    if (const auto role = value("ROLE:")) role_ = role_named(*role);
    if (const auto width = value("WIDTH:")) width_mm_ = thickness(*width);
    if (const auto width = value("LINE_WIDTH:")) width_mm_ = thickness(*width);
    if (const auto height = value("HEIGHT:")) take_height(*height);
    if (const auto height = value("LAYER_HEIGHT:")) take_height(*height);
    for (const std::string_view key : {"Z:", "Z_HEIGHT:"})
        if (const auto z = value(key); z && number(*z) > 0) layer_.stated_z_mm = number(*z);
    if (comment.starts_with("stop printing object")) append(Object{0});
}

// The first one of a layer is the layer's own.
void GcodeInterpreter::take_height(std::string_view value) {
    height_mm_ = thickness(value);
    if (height_is_layers_ && height_mm_ > 0) layer_.stated_height_mm = height_mm_;
    height_is_layers_ = false;
}

Status GcodeInterpreter::command(const GcodeLine& line) {
    const std::string& name = line.command;
    const bool is_moving = is_one_of(name, {"G0", "G1", "G2", "G3"});
    const bool has_words = name.size() > 1 && name[1] >= '0' && name[1] <= '9' &&
                           !is_one_of(name, {"M23", "M28", "M486"});
    if (!std::isalpha(static_cast<unsigned char>(name[0])))
        return error("expected a command, found " + in_quotes(name));
    if (is_passed(name)) return Done{};
    if (is_word(name)) return error("expected a command, found the word " + in_quotes(name));
    if (const Refused* why = refusal(name))
        return Diagnostic{Severity::error,
                          ExitStatus::unsupported,
                          name + " is not handled: " + std::string(why->reason),
                          {.file = name_, .line = line_}};
    std::string why;
    const auto words = has_words ? gcode_words(line.rest, !is_moving, why) : GcodeWords();
    if (!words) return error(why);
    if ((*words)['G'] || (*words)['M']) return error("expected one command a line, found two");
    if (is_moving)
        for (const char axis : {'A', 'B', 'C', 'U', 'V', 'W'})
            if ((*words)[axis]) unknown(std::string("the axis ") + axis);
    if (name == "G0" || name == "G1") return move(*words);
    if (name == "G2" || name == "G3") return turn(*words, name == "G3");
    if (name == "M220" || name == "M221") return set_factor(name, *words);
    if (name == "G28") {
        home(*words);
    } else if (name == "G92") {
        set_position(*words);
    } else if (!set_mode(name) && !set_machine(line, *words) && !heat(name, *words)) {
        unknown(name);
    }
    return Done{};
}

// Percents of speed, of which Marlin keeps one (B) and takes it back (R), and of filament.
Status GcodeInterpreter::set_factor(const std::string& command, const GcodeWords& words) {
    if (words['S'] && !(*words['S'] > 0 && *words['S'] <= most_percent))
        return error("expected S from more than 0 to 1000 % behind " + command + ", found " +
                     shortest(*words['S']));
    if (command == "M220") {
        if (words['B']) kept_speed_ = speed_;
        if (words['S'])
            speed_ = *words['S'] / full_percent;
        else if (words['R'])
            speed_ = kept_speed_;
    } else if (words['S']) {
        flows_[words['T'] && !facts_.is_klippers ? whole(words['T']) : tool_] =
            *words['S'] / full_percent;
    }
    return Done{};
}

bool GcodeInterpreter::set_mode(const std::string& command) {
    if (command == "G20" || command == "G21") {
        unit_mm_ = command == "G20" ? mm_per_inch : 1;
    } else if (command == "G90" || command == "G91") {
        absolute_ = command == "G90";
        if (!facts_.is_klippers) absolute_filament_ = absolute_;
    } else if (command == "M82" || command == "M83") {
        absolute_filament_ = command == "M82";
    } else {
        return command == "G17";
    }
    return true;
}

bool GcodeInterpreter::set_machine(const GcodeLine& line, const GcodeWords& words) {
    const std::string& name = line.command;
    if (name == "G4") {
        const double time_ms = words['P'].value_or(0) + ms_per_s * words['S'].value_or(0);
        if (time_ms > 0 && time_ms < std::numeric_limits<std::uint32_t>::max())
            append(Dwell{static_cast<std::uint32_t>(time_ms)});
    } else if (name == "G10" && !words['L'] && !words['P']) {
        if (firmware_depth_mm_ == 0) firmware_depth_mm_ = usual_firmware_depth_mm;
        drawn_back_mm_ = firmware_depth_mm_;
        layer_.items.emplace_back(
            GcodeDraw{drawn_back_mm_, firmware_mm_s_ > 0 ? firmware_mm_s_ : usual_firmware_mm_s});
    } else if (name == "G11") {
        drawn_back_mm_ = 0;
        layer_.items.emplace_back(
            GcodeDraw{0, firmware_mm_s_ > 0 ? firmware_mm_s_ : usual_firmware_mm_s});
    } else if (name == "M207") {
        firmware_depth_mm_ = std::max(0.0, words['S'].value_or(0)) * unit_mm_;
        firmware_mm_s_ = std::max(0.0, words['F'].value_or(0)) * unit_mm_ / s_per_min;
    } else if (is_one_of(name, {"M0", "M1", "M25", "M601", "PAUSE"})) {
        append(Pause{PauseReason::user});
    } else if (name == "M600") {
        append(Pause{PauseReason::filament_change});
    } else if (name == "M204") {
        if (words['S']) print_mm_s2_ = travel_mm_s2_ = std::max(0.0, *words['S']);
        if (words['P']) print_mm_s2_ = std::max(0.0, *words['P']);
        if (words['T']) travel_mm_s2_ = std::max(0.0, *words['T']);
    } else if (name == "SET_VELOCITY_LIMIT") {
        const auto limit = finite_number(gcode_parameter(line.rest, "ACCEL"));
        if (limit && *limit > 0) print_mm_s2_ = travel_mm_s2_ = *limit;
    } else if (is_tool(name)) {
        append(Tool{whole(finite_number(name.substr(1)))});
        if (!facts_.is_klippers) tool_ = whole(finite_number(name.substr(1)));
    } else if (name == "M486") {
        take_object_number(line.rest);
    } else if (name == "EXCLUDE_OBJECT_END") {
        append(Object{0});
    } else {
        return false;
    }
    return true;
}

bool GcodeInterpreter::heat(const std::string& name, const GcodeWords& words) {
    // As Marlin: without a temperature nothing is set.
    if (is_one_of(name, {"M104", "M109", "M140", "M190", "M141", "M191"}) && !words['S'] &&
        !words['R'])
        return true;
    const double value = std::max(0.0, words['S'] ? *words['S'] : words['R'].value_or(0));
    const std::uint32_t tool = whole(words['T']);
    if (name == "M104" || name == "M109")
        append(Temperature{{HeaterKind::tool, tool}, value, name == "M109"});
    else if (name == "M140" || name == "M190")
        append(Temperature{{HeaterKind::bed, 0}, value, name == "M190"});
    else if (name == "M141" || name == "M191")
        append(Temperature{{HeaterKind::chamber, 0}, value, name == "M191"});
    else if (name == "M106")
        append(Fan{whole(words['P']),
                   std::clamp(words['S'].value_or(full_fan), 0.0, full_fan) / full_fan});
    else if (name == "M107")
        append(Fan{whole(words['P']), 0});
    else
        return false;
    return true;
}

void GcodeInterpreter::unknown(const std::string& command) {
    const auto known = std::find_if(unknown_.begin(), unknown_.end(),
                                    [&](const Unknown& other) { return other.command == command; });
    if (known != unknown_.end())
        ++known->count;
    else
        unknown_.push_back({command, line_, 1});
}

void GcodeInterpreter::report(Diagnostics& diagnostics) const {
    const auto warn = [&](const std::string& message, std::uint32_t line) {
        diagnostics.push_back(
            {Severity::warning, ExitStatus::input, message, {.file = name_, .line = line}});
    };
    for (const Unknown& unknown : unknown_)
        warn(in_quotes(unknown.command) + " is not known and left out (" +
                 counted(unknown.count, "time") + ", here first)",
             unknown.line);
    if (pushed_aside_line_ == 0 || pushed_aside_mm_ < least_pushed_aside_mm) return;
    warn("filament pushed while the head stands is left out: " +
             shortest(std::round(pushed_aside_mm_ * 100) / 100) + " mm in " +
             counted(pushed_aside_count_, "place") + ", here first",
         pushed_aside_line_);
}

}  // namespace lyr::format
