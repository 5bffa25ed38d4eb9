// How this room words what it finds.

#pragma once

#include <string>
#include <utility>

#include "base/diagnostic.h"
#include "kernel/brep/model.h"

namespace lyr {

// Status geometry, at an instance of the file and a place.
Diagnostic defect(Severity severity, std::string message, SourceId source, const Point3& point);

// "0.0123 mm", three digits.
std::string in_mm(double length_mm);

}  // namespace lyr
