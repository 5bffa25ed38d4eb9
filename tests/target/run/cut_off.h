// What a print that was cut off leaves behind.

#pragma once

#include <doctest/doctest.h>

#include <cmath>

#include "target/run/resumption.h"

namespace lyr::tests {

// Of a printer's steppers.
inline constexpr std::size_t line_count = 8;

// A head that was parked.
inline run::JournalEntry resting_at(double z_mm) {
    run::JournalEntry entry;
    entry.layer = 1;
    entry.rest_nm = std::llround(z_mm * 1e6);
    return entry;
}

// Of this file on this printer, 5 s into a print of 6 layers; the rest is the entry's.
inline void write_journal(const config::Printer& printer, const std::string& file,
                          run::JournalEntry entry) {
    Result<run::Journal> journal = run::Journal::open(run::journal_path(printer, file));
    REQUIRE(journal.ok());
    entry.file = *run::identity_of(file);
    entry.printer = run::identity_of(printer);
    entry.layers = 6;
    entry.time_ns = 5'000'000'000;
    REQUIRE(journal->write(entry).ok());
}

}  // namespace lyr::tests
