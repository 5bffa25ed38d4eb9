// One line, one fault.

#include "target/thermal/faults.h"

#include <algorithm>
#include <array>
#include <sstream>

#include "base/nearest_name.h"
#include "base/text.h"

namespace lyr::thermal {
namespace {

struct Word {
    std::string_view name;
    FaultKind kind;
    bool has_value = false;
};
constexpr std::array<Word, 16> words{{{"open", FaultKind::open},
                                      {"short", FaultKind::shorted},
                                      {"detach", FaultKind::detached},
                                      {"freeze", FaultKind::frozen},
                                      {"unreadable", FaultKind::unreadable},
                                      {"jump", FaultKind::jump, true},
                                      {"stuck_on", FaultKind::stuck_on},
                                      {"no_power", FaultKind::no_power},
                                      {"weak", FaultKind::weak, true},
                                      {"draught", FaultKind::draught, true},
                                      {"silent", FaultKind::silent},
                                      {"mend", FaultKind::mend},
                                      {"stuck", FaultKind::stuck},
                                      {"dead", FaultKind::dead},
                                      {"bounce", FaultKind::bounce, true},
                                      {"lose", FaultKind::lose, true}}};

// What is wrong with a line, without its place.
using Complaint = std::string;
using Parsed = std::variant<Fault, Complaint>;

Complaint take_heater(const std::string& name, const config::Printer& printer, Fault& fault) {
    const auto& names = config::heater_names;
    const auto known = std::find(names.begin(), names.end(), name);
    fault.heater = static_cast<std::size_t>(known - names.begin());
    if (known != names.end() && printer.heaters[fault.heater]) return {};
    return "the printer has no heater " + in_quotes(name);
}

Complaint take_contact(const std::string& name, const config::Printer& printer, Fault& fault) {
    const auto& names = config::contact_names;
    const auto known = std::find(names.begin(), names.end(), name);
    fault.contact = static_cast<std::size_t>(known - names.begin());
    if (fault.kind == FaultKind::lose)
        return fault.contact < printer.endstops.size() ? "" : "expected x, y or z";
    const bool has =
        known != names.end() && (fault.contact == config::contact_probe
                                     ? printer.probe && printer.probe->input
                                     : printer.endstops[fault.contact].input.has_value());
    return has ? "" : "the printer has no endstop or probe " + in_quotes(name);
}

Parsed parse(const std::vector<std::string>& parts, const config::Printer& printer) {
    Fault fault;
    const std::optional<double> time_s = finite_number(parts[0]);
    if (!time_s || *time_s < 0) return "expected a time in seconds, found " + in_quotes(parts[0]);
    fault.time_s = *time_s;
    if (parts.size() < 2) return "expected a fault after the time";
    const auto word = std::find_if(words.begin(), words.end(),
                                   [&](const Word& known) { return known.name == parts[1]; });
    if (word == words.end()) {
        std::vector<std::string> names;
        for (const Word& known : words) names.emplace_back(known.name);
        const std::string nearest = nearest_name(parts[1], names);
        return "unknown fault " + in_quotes(parts[1]) +
               (nearest.empty() ? "" : "; did you mean `" + nearest + "`?");
    }
    fault.kind = word->kind;
    const bool has_target = fault.kind != FaultKind::silent;
    const bool of_contact = is_of_contact(fault.kind);
    const std::size_t expected = 2 + (has_target ? 1 : 0) + (word->has_value ? 1 : 0);
    if (parts.size() != expected)
        return "`" + parts[1] + "` takes " +
               (!has_target  ? "nothing more"
                : of_contact ? "an endstop's axis"
                             : "a heater") +
               (word->has_value ? " and a value" : "");
    if (!has_target) return fault;
    if (Complaint complaint = of_contact ? take_contact(parts[2], printer, fault)
                                         : take_heater(parts[2], printer, fault);
        !complaint.empty())
        return complaint;
    if (!word->has_value) return fault;
    const std::optional<double> value = finite_number(parts[3]);
    if (!value) return "expected a number, found " + in_quotes(parts[3]);
    fault.value = *value;
    return fault;
}

}  // namespace

bool is_of_contact(FaultKind kind) {
    return kind == FaultKind::stuck || kind == FaultKind::dead || kind == FaultKind::bounce ||
           kind == FaultKind::lose;
}

Result<std::vector<Fault>> parse_faults(std::string_view text, const std::string& file,
                                        const config::Printer& printer) {
    std::vector<Fault> faults;
    std::istringstream lines{std::string(text)};
    std::string line;
    for (std::uint32_t number = 1; std::getline(lines, line); ++number) {
        std::istringstream split(line.substr(0, line.find('#')));
        std::vector<std::string> parts;
        for (std::string part; split >> part;) parts.push_back(part);
        if (parts.empty()) continue;
        const Parsed parsed = parse(parts, printer);
        if (const auto* complaint = std::get_if<Complaint>(&parsed))
            return Diagnostic{
                Severity::error, ExitStatus::input, *complaint, {.file = file, .line = number}};
        faults.push_back(std::get<Fault>(parsed));
    }
    std::stable_sort(faults.begin(), faults.end(),
                     [](const Fault& a, const Fault& b) { return a.time_s < b.time_s; });
    return faults;
}

void apply(const Fault& fault, ModelFaults& faults) {
    switch (fault.kind) {
        case FaultKind::open:
            faults.open = true;
            break;
        case FaultKind::shorted:
            faults.shorted = true;
            break;
        case FaultKind::detached:
            faults.detached = true;
            break;
        case FaultKind::frozen:
            faults.frozen = true;
            break;
        case FaultKind::unreadable:
            faults.unreadable = true;
            break;
        case FaultKind::jump:
            faults.jump_c = fault.value;
            break;
        case FaultKind::stuck_on:
            faults.stuck_on = true;
            break;
        case FaultKind::no_power:
            faults.power_share = 0;
            break;
        case FaultKind::weak:
            faults.power_share = fault.value;
            break;
        case FaultKind::draught:
            faults.draught_w_k = fault.value;
            break;
        case FaultKind::silent:
        case FaultKind::stuck:
        case FaultKind::dead:
        case FaultKind::bounce:
        case FaultKind::lose:
            break;
        case FaultKind::mend:
            faults = {};
            break;
    }
}

}  // namespace lyr::thermal
