// What a thread asks of the kernel before it may be trusted with edges of microseconds.
//
// Contract
//  1. Nothing here fails a print: what the kernel refuses comes back as a warning that says what to do.

#pragma once

#include "base/diagnostic.h"

namespace lyr::run {

// Of the threads that are started from here on.
void keep_stacks_small();

// Keeps the memory of the whole process, present and future, in place: a page fault would cost
// milliseconds.
void lock_memory(Diagnostics& warnings);

// Puts the calling thread before all ordinary ones (SCHED_FIFO).
void take_precedence(Diagnostics& warnings);

}  // namespace lyr::run
