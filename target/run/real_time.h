// What a thread asks of the kernel before it may be trusted with edges of microseconds.
//
// Contract
//  1. What the kernel refuses comes back as a warning that says what to do, and fails no print.
//  2. check_cpu() is an error (status machine) that names timing.cpu if this program's threads may not run there.

#pragma once

#include <optional>

#include "base/diagnostic.h"

namespace lyr::run {

// Of the threads that are started from here on.
void keep_stacks_small();

// Keeps the memory of the whole process, present and future, in place: a page fault would cost
// milliseconds. A limit that is too low for a print's threads counts as refused.
void lock_memory(Diagnostics& warnings);

// Puts the calling thread before all ordinary ones (SCHED_FIFO), and on that processor alone; none: on any.
void take_precedence(std::optional<unsigned> cpu, Diagnostics& warnings);
// What a thread that takes it would be told; this one stays as it is.
void try_precedence(std::optional<unsigned> cpu, Diagnostics& warnings);

Status check_cpu(std::optional<unsigned> cpu);

}  // namespace lyr::run
