// What the comments of a G-code file say of it as a whole: where its layers begin, what it was made by and of. Private to
// this room.

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "format/metadata.h"
#include "format/operation.h"

namespace lyr::format {

struct GcodeFacts {
    bool marks_layers = false;  // with comments; otherwise by height
    std::vector<std::string> objects{};
    std::vector<std::string> object_numbers{};  // of M486 S; each is the object of the same index
    std::string producer{}, source{}, source_sha256{}, printer{}, material{}, profile{};
    double filament_diameter_mm = 0, filament_density_g_cm3 = 0;  // 0: not stated
    Quantum quantum{};
    bool is_klippers = false;  // G90 and G91 leave E as it is; Marlin's mean it, too
};

GcodeFacts gcode_facts(std::string_view text);

// Whether a comment begins a layer: those of PrusaSlicer and OrcaSlicer, Cura and Simplify3D.
bool begins_layer(std::string_view comment);

// Of M486: S0 begins an object, S-1 ends it, A is its name, as `S0 A"name"` or by itself. Empty: not there.
struct ObjectMark {
    std::string_view number{}, name{};
};
ObjectMark object_mark(std::string_view rest);

// The name of the object that a command or comment begins; empty: none.
std::string_view begun_object(std::string_view line);

// Calls `take(line, number)` for each line, from 1, until it returns false.
template <class Take>
void for_each_line(std::string_view text, Take&& take) {
    std::uint32_t number = 0;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        if (!take(text.substr(at, end - at), ++number)) return;
        at = end + 1;
    }
}

}  // namespace lyr::format
