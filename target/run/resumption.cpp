#include "target/run/resumption.h"

#include <dirent.h>

#include <algorithm>
#include <filesystem>

#include "base/constants.h"
#include "base/text.h"
#include "target/moves/machine.h"
#include "target/run/inspect.h"

namespace lyr::run {
namespace {

Diagnostic refused(std::string message, const std::string& file) {
    return {Severity::error, ExitStatus::input, std::move(message), {.file = file}};
}

// As high as the head was there, said of a head over start_mm.
double z_over_start_mm(const config::Printer& printer, const motion::Point& head) {
    const auto bed = moves::bed_of(printer);
    if (!bed) return head.z;
    const motion::Point start{printer.start_mm[0], printer.start_mm[1], head.z};
    return head.z + bed->lift_mm(head) - bed->lift_mm(start);
}

void note_replaced(Diagnostic why, Diagnostics& notes) {
    why.severity = Severity::warning;
    why.message += "; it is replaced";
    notes.push_back(std::move(why));
}

// What becomes of a journal that is there. Errors: it is another printer's.
Status see_to(const std::string& path, const config::Printer& printer, const FileIdentity& file,
              Diagnostics& notes) {
    const Result<std::optional<JournalEntry>> before = read_journal(path);
    if (!before) note_replaced(before.error(), notes);
    if (!before || !*before) return Done{};
    const std::string different = difference((*before)->printer, identity_of(printer));
    if (!different.empty())
        return Diagnostic{Severity::error,
                          ExitStatus::output,
                          "the journal is of a print on another printer (other " + different +
                              ") and stays: give each printer a recovery.folder of its own",
                          {.file = path}};
    if (!((*before)->file == file))
        note_replaced(refused("the journal is of another file of this name", path), notes);
    return Done{};
}

Status try_journal(const config::Printer& printer, const std::string& file, const std::string& path,
                   PrintJournal& opened, Diagnostics& notes) {
    const Result<FileIdentity> identity = identity_of(file);
    if (!identity) return identity.error();
    Result<Journal> journal = Journal::open(path);
    if (!journal) return journal.error();
    if (Status ours = see_to(path, printer, *identity, notes); !ours) return ours;
    opened.file = *identity;
    opened.journal.emplace(std::move(*journal));
    return Done{};
}

bool is_of(const config::Printer& printer, const Result<std::optional<JournalEntry>>& entry) {
    return entry && *entry && (*entry)->printer == identity_of(printer);
}

// What it says of the head is believed as long as it is there.
Diagnostic outlived(const Diagnostic& error) {
    Diagnostic why = error;
    why.message +=
        "; nothing has moved, since it would go on saying how high the head was before: mend its "
        "folder or disk, or remove it";
    return why;
}

// Those of other prints on this printer, in the same folder as this one.
std::vector<std::string> journals_beside(const config::Printer& printer, const std::string& path) {
    std::vector<std::string> found;
    const std::string folder = path.substr(0, path.rfind('/') + 1);
    DIR* const entries = ::opendir(folder.empty() ? "." : folder.c_str());
    if (!entries) return found;
    while (const dirent* entry = ::readdir(entries)) {
        std::string there = folder + entry->d_name;
        // One that nobody writes would be waited for.
        if (!there.ends_with(".journal") || there == path || entry->d_type == DT_FIFO) continue;
        if (is_of(printer, read_journal(there))) found.push_back(std::move(there));
    }
    ::closedir(entries);
    return found;
}

Status forget(const std::string& path) {
    Result<Journal> journal = Journal::open(path);
    // One with nothing in it is removed.
    if (journal) return journal->clear();
    return journal.error();
}

}  // namespace

Status open_journal(const config::Printer& printer, const std::string& file,
                    const std::string& path, PrintJournal& opened, Diagnostics& notes) {
    const Status tried = try_journal(printer, file, path, opened, notes);
    if (tried) return Done{};
    const Result<std::optional<JournalEntry>> before = read_journal(path);
    if (!before || is_of(printer, before)) return is_kept(path) ? tried : outlived(tried.error());
    Diagnostic& note = notes.emplace_back(tried.error());
    note.severity = Severity::warning;
    note.message += "; this print cannot be resumed after a loss of power";
    opened.why_none = note.message;
    return Done{};
}

Status begin_journal(PrintJournal& opened, const std::optional<Resumption>& resumption) {
    if (!opened.journal) return Done{};
    const Status begun =
        resumption ? opened.journal->write(resumption->entry) : opened.journal->clear();
    if (begun) return begun;
    return outlived(begun.error());
}

void note_others(const config::Printer& printer, const std::string& path, Diagnostics& notes) {
    for (std::string& other : journals_beside(printer, path))
        if (!is_kept(other))
            notes.push_back({Severity::warning,
                             ExitStatus::ok,
                             "a print was cut off that cannot be resumed once this one has moved "
                             "the head; its journal is removed",
                             {.file = std::move(other)}});
}

Status forget_others(const config::Printer& printer, const std::string& path) {
    for (const std::string& other : journals_beside(printer, path))
        if (const Status forgotten = forget(other); !forgotten) return outlived(forgotten.error());
    return Done{};
}

Status check_none_rests(const config::Printer& printer) {
    for (const std::string& path : journals_beside(printer, journal_path(printer, "")))
        return refused(is_kept(path) ? "a print is under way on this printer"
                                     : "a print was cut off, and --resume takes its height from "
                                       "where the head stands: resume it, or, to home or move "
                                       "the head, remove this file first",
                       path);
    return Done{};
}

std::string journal_path(const config::Printer& printer, const std::string& file) {
    if (printer.recovery_folder.empty()) return file + ".journal";
    const std::filesystem::path name = std::filesystem::path(file).filename();
    return (std::filesystem::path(printer.recovery_folder) / name).string() + ".journal";
}

Result<Resumption> find_resumption(const config::Printer& printer, const std::string& file) {
    const std::string path = journal_path(printer, file);
    const Result<std::optional<JournalEntry>> entry = read_journal(path);
    if (!entry) return entry.error();
    if (!*entry)
        return refused("nothing to resume: there is no journal, or nothing in it: " + path, file);
    const std::string different = difference((*entry)->printer, identity_of(printer));
    if (!different.empty())
        return refused("it was begun on another printer, or this one was changed since: other " +
                           different + "; resume it with that printer's file as it was",
                       file);
    const Result<FileIdentity> identity = identity_of(file);
    if (!identity) return identity.error();
    if (!(*identity == (*entry)->file))
        return refused("the file is not the one that was being printed: it was changed since",
                       file);
    Resumption resumption{**entry, std::max(1u, (*entry)->layer) - 1, 0, {}, 0};
    if (!resumption.entry.is_unloaded)
        resumption.drawn_back_mm = resumption.entry.drawn_back_um / um_per_mm;
    Result<format::Reader> reader = open_file(file, resumption.first_layer);
    if (!reader) return reader.error();
    if (const auto start = reader->next(); !start) return start.error();
    resumption.state = reader->layer().state;
    const format::LayerState& layer = resumption.state;
    motion::Point head{layer.start_x_mm, layer.start_y_mm, layer.z_mm};
    if (const auto& place_um = resumption.entry.place_um)
        head = {(*place_um)[0] / um_per_mm, (*place_um)[1] / um_per_mm, layer.z_mm};
    resumption.stopped_z_mm = resumption.entry.layer == 0 ? printer.start_mm[config::axis_z]
                                                          : z_over_start_mm(printer, head);
    if (const auto rest_nm = resumption.entry.rest_nm)
        resumption.stopped_z_mm = static_cast<double>(*rest_nm) / nm_per_mm;
    return resumption;
}

Diagnostics lost_entry(const config::Printer& printer, const std::string& file) {
    std::string path = journal_path(printer, file);
    if (!has_damage(path)) return {};
    return {
        {Severity::warning,
         ExitStatus::ok,
         "one of its two entries is damaged, and the other one counts: if the power failed while "
         "the later one was written, the head may stand a layer higher than is taken here",
         {.file = std::move(path)}}};
}

Status check_cut_off(const config::Printer& printer, const std::string& file) {
    if (!is_kept(journal_path(printer, file))) return Done{};
    return refused("it is being printed now: `lyrctl status` says how far it is", file);
}

config::Printer lifted(const config::Printer& printer, const Resumption& resumption) {
    config::Printer machine = printer;
    const double z_mm = resumption.stopped_z_mm;
    machine.start_mm[config::axis_z] =
        std::max(z_mm, std::min(z_mm + printer.pause.lift_mm, printer.axes[config::axis_z].max_mm));
    return machine;
}

std::string text_of(const Resumption& resumption, const std::string& file) {
    return formatted(
        "%s was cut off in layer %u of %u, %.0f s into the print, the head at z %.3f mm%s%s\n",
        file.c_str(), resumption.first_layer + 1, resumption.entry.layers,
        static_cast<double>(resumption.entry.time_ns) / ns_per_s, resumption.stopped_z_mm,
        resumption.entry.rest_nm ? ", at rest" : "",
        resumption.entry.is_unloaded ? ", the filament drawn out" : "");
}

}  // namespace lyr::run
