#include "target/run/print_preparation.h"

#include <utility>

#include "target/run/demands.h"
#include "target/run/real_time.h"

namespace lyr::run {
namespace {

Status prepare_journals(const PrintJob& job, Prepared& prepared) {
    if (job.journal.empty()) return Done{};
    if (job.forgets_others) note_others(job.printer, job.journal, prepared.notes);
    return open_journal(job.printer, job.file, job.journal, prepared.journal, prepared.notes);
}

}  // namespace

bool can_resume(const PrintJob& job) {
    return (job.control && job.is_reachable) || job.printer.inputs[config::input_pause];
}

Result<Prepared> prepare(const PrintJob& job) {
    if (const Status has = check_cpu(job.printer.timing.cpu); !has) return has.error();
    Result<PrintFile> file = PrintFile::open(job.file);
    if (!file) return file.error();
    Result<Inspection> inspection = inspect(*file, job.printer);
    if (!inspection) return inspection.error();
    Prepared prepared{std::move(*file), std::move(*inspection), {}, {}};
    const Status possible = check_demands(prepared.inspection, job.printer, job.no_heat,
                                          prepared.notes, can_resume(job));
    if (!possible) return possible.error();
    if (const Status opened = prepare_journals(job, prepared); !opened) return opened.error();
    if (const Status same = prepared.file.check(); !same) return same.error();
    lock_memory(prepared.notes);
    try_precedence(job.printer.timing.cpu, prepared.notes);
    return prepared;
}

Status begin_journals(const PrintJob& job, PrintJournal& journal) {
    if (job.forgets_others)
        if (Status forgotten = forget_others(job.printer, job.journal); !forgotten)
            return forgotten;
    return begin_journal(journal, job.resumption);
}

}  // namespace lyr::run
