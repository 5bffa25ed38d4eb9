// One line a diagnostic, in the form that editors and people know from compilers.

#include "base/diagnostic.h"

#include <cmath>
#include <cstdio>

#include "base/text.h"

namespace lyr {
namespace {

const char* name_of(Severity severity) {
    switch (severity) {
        case Severity::note:
            return "note";
        case Severity::warning:
            return "warning";
        case Severity::error:
            return "error";
    }
    return "error";
}

void append_coordinate(std::string& line, const char* name, const std::optional<double>& value_mm) {
    if (!value_mm || !std::isfinite(*value_mm)) return;
    // Beyond a kilometre nobody wants to count the digits.
    constexpr double longest_mm = 1e6;
    char text[48];
    std::snprintf(text, sizeof text, std::abs(*value_mm) <= longest_mm ? " %s=%.3f" : " %s=%.4g",
                  name, *value_mm);
    line += text;
}

}  // namespace

Diagnostic machine_error(std::string message) {
    return {Severity::error, ExitStatus::machine, std::move(message), {}};
}

std::string to_string(const Diagnostic& diagnostic) {
    const Location& where = diagnostic.where;
    std::string line;
    if (!where.file.empty()) {
        line = escaped(where.file);
        if (where.line) line += ':' + std::to_string(where.line);
        if (where.line && where.column) line += ':' + std::to_string(where.column);
        line += ": ";
    }
    line += name_of(diagnostic.severity);
    line += ": ";
    if (where.entity) line += '#' + std::to_string(where.entity) + ": ";
    line += escaped(diagnostic.message);
    std::string place;
    if (where.layer) place += " layer " + std::to_string(*where.layer);
    append_coordinate(place, "x", where.x_mm);
    append_coordinate(place, "y", where.y_mm);
    append_coordinate(place, "z", where.z_mm);
    return place.empty() ? line : line + " (at" + place + ')';
}

}  // namespace lyr
