// The print without a board, in real time: to try a file, a configuration, or what controls a print. Lines lead nowhere,
// heaters are models.
//
// Contract
//  1. All else is print(): the same threads, waits, guards, commands and report.
//  2. No line is opened, whatever the printer's file names; it need not name any.
//  3. A late edge does not end it: there is no motor that could lose a step. How late they were is in the report.

#pragma once

#include "target/run/print.h"

namespace lyr::run {

Result<PrintReport> dry_run(PrintJob job);

}  // namespace lyr::run
