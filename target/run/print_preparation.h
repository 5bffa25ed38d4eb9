// What is known and decided about a print before a line is touched.
//
// Contract
//  1. prepare() is an error where print.h says that nothing moves: the file, the printer or the journal is not right, or
//     the machine cannot do what the file demands. Its notes are what is to be said before anything moves.
//  2. From then on this process's memory is locked, and its real-time threads take precedence as far as they may.
//  3. begin_journals() is for when all lines are held and nothing has moved: journals that would say wrongly how high
//     the head is are gone from the disk when it returns; or it is an error.

#pragma once

#include "target/run/inspect.h"
#include "target/run/print.h"
#include "target/run/print_file.h"

namespace lyr::run {

struct Prepared {
    PrintFile file;
    Inspection inspection;
    Diagnostics notes;
    PrintJournal journal;
};

// Somebody or something can give that command.
bool can_resume(const PrintJob& job);

Result<Prepared> prepare(const PrintJob& job);
Status begin_journals(const PrintJob& job, PrintJournal& journal);

}  // namespace lyr::run
