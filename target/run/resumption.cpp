#include "target/run/resumption.h"

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

}  // namespace

std::string journal_path(const config::Printer& printer, const std::string& file) {
    if (printer.recovery_folder.empty()) return file + ".journal";
    const std::filesystem::path name = std::filesystem::path(file).filename();
    return (std::filesystem::path(printer.recovery_folder) / name).string() + ".journal";
}

Result<Resumption> find_resumption(const config::Printer& printer, const std::string& file) {
    const std::string path = journal_path(printer, file);
    const Result<std::optional<JournalEntry>> entry = read_journal(path);
    if (!entry) return entry.error();
    if (!*entry) return refused("nothing to resume: there is no journal " + path, file);
    const Result<FileIdentity> identity = identity_of(file);
    if (!identity) return identity.error();
    if (!(*identity == (*entry)->file))
        return refused("the file is not the one that was being printed: it was changed since",
                       file);
    Resumption resumption{**entry, std::max(1u, (*entry)->layer) - 1, 0, {}};
    Result<format::Reader> reader = open_file(file, resumption.first_layer);
    if (!reader) return reader.error();
    if (const auto start = reader->next(); !start) return start.error();
    resumption.state = reader->layer().state;
    const format::LayerState& layer = resumption.state;
    motion::Point head{layer.start_x_mm, layer.start_y_mm, layer.z_mm};
    if (const auto& place_um = resumption.entry.place_um)
        head = {(*place_um)[0] / um_per_mm, (*place_um)[1] / um_per_mm, layer.z_mm};
    resumption.stopped_z_mm = z_over_start_mm(printer, head);
    if (const auto rest_nm = resumption.entry.rest_nm)
        resumption.stopped_z_mm = static_cast<double>(*rest_nm) / nm_per_mm;
    return resumption;
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
        "%s was cut off in layer %u of %u, %.0f s into the print, the head at z %.3f mm%s\n",
        file.c_str(), resumption.first_layer + 1, resumption.entry.layers,
        static_cast<double>(resumption.entry.time_ns) / ns_per_s, resumption.stopped_z_mm,
        resumption.entry.rest_nm ? ", at rest" : "");
}

}  // namespace lyr::run
