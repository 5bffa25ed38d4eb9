// Pairs of keys, and when they contradict each other.

#include "profile/checks.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include "profile/keys.h"

namespace lyr::profile {
namespace {

struct Contradiction {
    std::string_view first, relation, second;
    bool (*holds)(const Profile&);
    std::string_view advice = "";
};

// Beyond that much of its bore, nothing of a nozzle is over a line to press it flat: it is laid down as a round string,
// with gaps beside it. (PrusaSlicer draws the line there too.)
constexpr double widest_bores = 3;

// So that 2.1 is three times 0.7.
constexpr double round_off_mm = 1e-9;

bool is_too_wide(double width_mm, const Profile& profile) {
    return width_mm > widest_bores * profile.nozzle.diameter_mm + round_off_mm;
}

// A nozzle presses a line flat, which it cannot if the line is thicker than its bore; and a line's cross-section with
// rounded flanks is at least as wide as it is high.
constexpr std::string_view above = "is more than";
constexpr std::string_view below = "is less than";
constexpr std::string_view too_wide = "is more than three times";
constexpr Contradiction contradictions[] = {
    {"layer.height", above, "nozzle.diameter",
     [](const Profile& p) { return p.layer.height_mm > p.nozzle.diameter_mm; }},
    {"layer.first_height", above, "nozzle.diameter",
     [](const Profile& p) { return p.layer.first_height_mm > p.nozzle.diameter_mm; }},
    {"layer.min_height", above, "layer.max_height",
     [](const Profile& p) { return p.layer.min_height_mm > p.layer.max_height_mm; }},
    {"layer.max_height", above, "nozzle.diameter",
     [](const Profile& p) {
         return p.layer.adaptive && p.layer.max_height_mm > p.nozzle.diameter_mm;
     }},
    {"perimeters.width", below, "layer.max_height",
     [](const Profile& p) {
         return p.layer.adaptive && p.perimeters.width_mm < p.layer.max_height_mm;
     }},
    {"skin.width", below, "layer.max_height",
     [](const Profile& p) { return p.layer.adaptive && p.skin.width_mm < p.layer.max_height_mm; }},
    {"infill.width", below, "layer.max_height",
     [](const Profile& p) {
         return p.layer.adaptive && p.infill.width_mm < p.layer.max_height_mm;
     }},
    {"perimeters.width", below, "layer.height",
     [](const Profile& p) { return p.perimeters.width_mm < p.layer.height_mm; }},
    {"perimeters.width", below, "layer.first_height",
     [](const Profile& p) { return p.perimeters.width_mm < p.layer.first_height_mm; }},
    {"skin.width", below, "layer.height",
     [](const Profile& p) { return p.skin.width_mm < p.layer.height_mm; }},
    {"skin.width", below, "layer.first_height",
     [](const Profile& p) { return p.skin.width_mm < p.layer.first_height_mm; }},
    {"infill.width", below, "layer.height",
     [](const Profile& p) { return p.infill.width_mm < p.layer.height_mm; }},
    {"infill.width", below, "layer.first_height",
     [](const Profile& p) { return p.infill.width_mm < p.layer.first_height_mm; }},
    {"perimeters.min_width", above, "perimeters.max_width",
     [](const Profile& p) { return p.perimeters.min_width_mm > p.perimeters.max_width_mm; }},
    {"perimeters.min_gap", above, "perimeters.max_width",
     [](const Profile& p) { return p.perimeters.min_gap_mm > p.perimeters.max_width_mm; }},
    {"perimeters.width", too_wide, "nozzle.diameter",
     [](const Profile& p) { return is_too_wide(p.perimeters.width_mm, p); },
     ": no nozzle lays so wide a line; for thicker walls set perimeters.count"},
    {"skin.width", too_wide, "nozzle.diameter",
     [](const Profile& p) { return is_too_wide(p.skin.width_mm, p); },
     ": no nozzle lays so wide a line"},
    {"infill.width", too_wide, "nozzle.diameter",
     [](const Profile& p) { return is_too_wide(p.infill.width_mm, p); },
     ": no nozzle lays so wide a line"},
    {"perimeters.max_width", too_wide, "nozzle.diameter",
     [](const Profile& p) { return is_too_wide(p.perimeters.max_width_mm, p); },
     ": no nozzle lays so wide a line"},
    {"fan.min", above, "fan.max", [](const Profile& p) { return p.fan.min > p.fan.max; }},
    {"fan.min_layer_time", above, "fan.ramp_time",
     [](const Profile& p) { return p.fan.min_layer_time_s > p.fan.ramp_time_s; }},
};

std::size_t number_of(std::string_view path) {
    const auto key = std::find_if(keys().begin(), keys().end(),
                                  [&](const Key& candidate) { return candidate.path == path; });
    return static_cast<std::size_t>(key - keys().begin());
}

std::string stated(const Resolved& resolved, std::size_t key) {
    return keys()[key].path + " = " + keys()[key].show(resolved.profile) + " (" +
           origin_text(resolved, key, Folders::shown) + ')';
}

// The first of the keys that a file states is where the reader looks.
Location place(const Resolved& resolved, std::initializer_list<std::size_t> some) {
    for (const std::size_t key : some) {
        const Origin& origin = resolved.origins[key];
        if (origin.kind == Origin::Kind::file) return {.file = origin.name, .line = origin.line};
    }
    return {};
}

}  // namespace

Status check(const Resolved& resolved) {
    for (const Contradiction& contradiction : contradictions) {
        if (!contradiction.holds(resolved.profile)) continue;
        const std::size_t a = number_of(contradiction.first), b = number_of(contradiction.second);
        const bool by_option = resolved.origins[a].kind == Origin::Kind::option ||
                               resolved.origins[b].kind == Origin::Kind::option;
        return Diagnostic{Severity::error, by_option ? ExitStatus::usage : ExitStatus::input,
                          stated(resolved, a) + ' ' + std::string(contradiction.relation) + ' ' +
                              stated(resolved, b) + std::string(contradiction.advice),
                          by_option ? Location{} : place(resolved, {a, b})};
    }
    return Done{};
}

}  // namespace lyr::profile
