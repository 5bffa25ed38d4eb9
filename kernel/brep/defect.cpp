#include "kernel/brep/defect.h"

#include <cstdio>

namespace lyr {

Diagnostic defect(Severity severity, std::string message, SourceId source, const Point3& point) {
    return {
        severity,
        ExitStatus::geometry,
        std::move(message),
        {.entity = source, .layer = {}, .x_mm = point.x(), .y_mm = point.y(), .z_mm = point.z()}};
}

std::string in_mm(double length_mm) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g mm", length_mm);
    return text;
}

}  // namespace lyr
