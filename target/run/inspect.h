// Reads a .lyr file from end to end before anything moves: a print that would fail in its last layer
// because the file is damaged or leaves the machine's range fails here, in the first seconds.
//
// Contract
//  1. Every checksum of the file has been verified when this succeeds.
//  2. A path that leaves the range of an axis anywhere, between the ends of an arc too, is an error
//     (status machine) with layer and position; a second tool is one of status unsupported; a path
//     without speed is one of status input.
//  3. The result says what the file asks of the machine.

#pragma once

#include <string>

#include "target/config/printer.h"
#include "target/run/file_path.h"
#include "target/run/print_file.h"

namespace lyr::run {

struct Inspection {
    format::FileHeader header;
    PathTotals totals;
    Demands demands;
    AxisValues low_mm{}, high_mm{};   // of the path, the start of the print included
    double filament_diameter_mm = 0;  // the printer's, or else the file's
};

// For one pass over a file.
Result<format::Reader> open_file(const std::string& path, std::uint32_t first_layer = 0);

Result<Inspection> inspect(const PrintFile& print, const config::Printer& printer);
Result<Inspection> inspect(const std::string& path, const config::Printer& printer);

}  // namespace lyr::run
