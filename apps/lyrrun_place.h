// lyrrun's options that find the machine's place, move it by hand and calibrate it, in place of a print.

#pragma once

#include <optional>

#include "apps/command_line.h"
#include "target/home/calibration.h"

namespace lyr::command_line {

struct PlaceArguments {
    std::optional<home::AxisSet> home;  // empty: all that can be
    std::optional<motion::Point> jog_mm;
    std::optional<double> feed_mm, tool_c;  // of filament, with the tool this warm
    std::optional<std::vector<home::Calibration>> calibrate;  // empty: all that the printer needs

    bool given() const { return home || jog_mm || feed_mm || tool_c || calibrate; }
};

void add_place_options(Options& app, PlaceArguments& arguments);

// A print that resumes takes its height from where the head stands.
bool counts_on_height(const config::Printer& printer);

// What the options ask for; the report on standard output.
Status work_place(const Program& program, const PlaceArguments& arguments, const home::Job& job);

}  // namespace lyr::command_line
