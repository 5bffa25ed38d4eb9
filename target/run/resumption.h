// Going on with a print that was cut off: from its journal to where it begins again.
//
// Contract
//  1. A print goes on at the start of the layer that the head was in, in the state that the file says for it.
//  2. find_resumption() refuses (status input) when there is no journal, or the file is not the one that it was written
//     for: not by name, but by all its bytes.
//  3. x and y of the head are those of start_mm: it was put there, or homed. Its height is that of the layer, or where the
//     journal says that it was at rest; it begins lifted by pause.lift_mm.
//  4. Over a crooked bed, that height counts from the bed's at start_mm. Of a head that was not at rest, it is that of the
//     place that the journal has; without one, of where the layer begins.

#pragma once

#include <string>

#include "format/operation.h"
#include "target/config/printer.h"
#include "target/run/journal.h"

namespace lyr::run {

// Beside the print, or in the folder that the printer's file names.
std::string journal_path(const config::Printer& printer, const std::string& file);

struct Resumption {
    JournalEntry entry;
    std::uint32_t first_layer = 0;  // from 0
    double stopped_z_mm = 0;        // where the head is found, over start_mm
    format::LayerState state;       // of that layer
};

Result<Resumption> find_resumption(const config::Printer& printer, const std::string& file);

// The printer with the head over where it stopped.
config::Printer lifted(const config::Printer& printer, const Resumption& resumption);

std::string text_of(const Resumption& resumption, const std::string& file);

}  // namespace lyr::run
