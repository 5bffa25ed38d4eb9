// Going on with a print that was cut off: from its journal to where it begins again.
//
// Contract
//  1. A print goes on at the start of the layer that the head was in, in the state that the file says for it.
//  2. find_resumption() refuses (status input) when there is no journal, or the file is not the one that it was
//     written for: not by name, but by all its bytes; or the printer is another one, as printer_identity.h says.
//     lost_entry() warns where one of the journal is damaged, which may have been the latest.
//  3. x and y of the head are those of start_mm: it was put there, or homed. Its height is that of the layer, before the
//     first one that of start_mm, or where the journal says that it was at rest; it begins lifted by pause.lift_mm.
//  4. Over a crooked bed, that height counts from the bed's at start_mm. Of a head that was not at rest, it is that
//     of the place that the journal has; without one, of where the layer begins.
//  5. The filament begins as far drawn back as the journal says, which is not at all of a head that was on its path.
//     Where it was drawn out, it is to be changed first.
//  6. open_journal() leaves a journal of another printer as it is, and then opens none. One that nobody can go on from is
//     replaced. Both are noted. The file is read to its end, which heaters must not wait for.
//  7. Once a head has moved otherwise, nothing says any more how high it rested. open_journal() is an error (status output)
//     where one of this printer cannot be written. begin_journal() and forget_others() are for when all else is ready and
//     nothing has moved: what is there is gone then, or, of a print that resumes, was found to be writable; or it is an
//     error (status output).

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
    double drawn_back_mm = 0;       // of the filament, when the path begins
};

Result<Resumption> find_resumption(const config::Printer& printer, const std::string& file);

Diagnostics lost_entry(const config::Printer& printer, const std::string& file);

// Error (status input): a print that is under way keeps its journal.
Status check_cut_off(const config::Printer& printer, const std::string& file);

struct PrintJournal {
    std::optional<Journal> journal;
    std::string why_none;
    FileIdentity file;
};

Status open_journal(const config::Printer& printer, const std::string& file,
                    const std::string& path, PrintJournal& opened, Diagnostics& notes);
Status begin_journal(PrintJournal& opened, const std::optional<Resumption>& resumption);

// Of the journals beside this one, of other prints on this printer.
void note_others(const config::Printer& printer, const std::string& path, Diagnostics& notes);
Status forget_others(const config::Printer& printer, const std::string& path);

// Error (status input): in recovery.folder, or else here, lies the journal of a print on this printer that was cut off.
Status check_none_rests(const config::Printer& printer);

// The printer with the head over where it stopped.
config::Printer lifted(const config::Printer& printer, const Resumption& resumption);

std::string text_of(const Resumption& resumption, const std::string& file);

}  // namespace lyr::run
