// What lyrview does with prints that may be damaged, with two of them, and with their pictures: --verify, --repair,
// --diff, --thumbnail.

#pragma once

#include <string>

#include "apps/command_line.h"
#include "base/diagnostic.h"

namespace lyr::command_line {

struct CheckRequest {
    bool verify = false, repair = false, thumbnail = false;
    std::string diff_path;  // the print that the other one is compared with

    bool any() const { return verify || repair || thumbnail || !diff_path.empty(); }
};

void add_checks(Options& app, CheckRequest& request);

// `others`: options of the command line that are not for these. Errors: the print is damaged or missing (input), of a
// newer version (unsupported), the two differ (differs), not writable (output), options that do not go together
// (usage).
Status check_print(const Options& app, const Program& program, const CheckRequest& request,
                   const std::string& lyr_path, const std::string& output_path, bool others);

}  // namespace lyr::command_line
