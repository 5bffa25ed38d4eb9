#include "apps/print_checks.h"

#include <algorithm>
#include <span>

#include "apps/files.h"
#include "apps/signal_watch.h"
#include "base/read_text.h"
#include "base/replace_file.h"
#include "base/text.h"
#include "format/check/repair.h"
#include "format/check/verify.h"
#include "format/export/diff.h"
#include "format/reader.h"

namespace lyr::command_line {
namespace {

std::span<const std::byte> bytes_of(const std::string& text) {
    return std::as_bytes(std::span(text.data(), text.size()));
}

Result<std::string> read_print(const std::string& path) {
    const auto wrong = [](std::string_view head) -> std::optional<std::string> {
        const bool fits = head.empty() || format::is_print(std::as_bytes(std::span(head)));
        return fits ? std::nullopt : std::optional<std::string>(format::no_print);
    };
    return read_text(path, most_readable_bytes(path), {format::print_head_bytes, wrong});
}

Status verify_print(const std::string& path) {
    const auto file = read_print(path);
    if (!file) return file.error();
    const format::Verification verification = format::verify(bytes_of(*file));
    const std::string name = input_name(path);
    if (const Status told = tell(format::to_text(verification, name)); !told) return told;
    if (verification.findings.empty()) return Done{};
    return format::to_diagnostic(verification, name);
}

Status repair_print(const std::string& path, const std::string& output) {
    const auto file = read_print(path);
    if (!file) return file.error();
    const std::string name = input_name(path);
    const format::Verification verification = format::verify(bytes_of(*file));
    const auto repaired = format::repair(bytes_of(*file), verification, name, output);
    if (!repaired) return repaired.error();
    std::string text;
    if (verification.findings.empty())
        text = name + ": whole, nothing is to be repaired\n";
    else
        text = format::to_text(verification, name);
    for (const std::string& note : repaired->notes) text += note + '\n';
    text += output_name(output) + ": " + counted(repaired->totals.layers, "layer") + ", " +
            counted(repaired->totals.bytes, "byte") + '\n';
    return tell(text, {{"the repaired print", output}});
}

Status diff_prints(const std::string& first, const std::string& second) {
    if (first == "-" || second == "-") return usage("--diff reads both prints twice: name files");
    const auto difference = format::diff(first, second);
    if (!difference) return difference.error();
    if (!difference->any()) return Done{};
    if (const Status told =
            tell(format::to_text(*difference, output_name(first), output_name(second)));
        !told)
        return told;
    const std::size_t keys = difference->metadata.size() + difference->configuration.size();
    return Diagnostic{Severity::note,
                      ExitStatus::differs,
                      "the prints differ: " + counted(difference->layers.size(), "layer") + ", " +
                          counted(keys, "key"),
                      {}};
}

// The largest one.
Status write_thumbnail(const std::string& path, const std::string& output) {
    const auto reader = format::Reader::open(path);
    if (!reader) return reader.error();
    const auto& all = reader->header().metadata.thumbnails;
    const auto largest = std::max_element(all.begin(), all.end(), [](const auto& a, const auto& b) {
        return std::uint64_t{a.width} * a.height < std::uint64_t{b.width} * b.height;
    });
    if (largest == all.end())
        return Diagnostic{Severity::error,
                          ExitStatus::input,
                          "the print has no thumbnail",
                          {.file = input_name(path)}};
    auto file = ReplaceFile::open(output);
    if (!file) return file.error();
    file->write(largest->png);
    return file->commit();
}

}  // namespace

void add_checks(Options& app, CheckRequest& request) {
    add_flag(app, "--verify", request.verify,
             "Check the file to its last byte and say what is damaged or missing");
    add_flag(app, "--repair", request.repair,
             "Write (-o FILE) the whole layers in front of the first damage as a print");
    add_flag(app, "--thumbnail", request.thumbnail,
             "Write (-o FILE.png) the print's own picture, the largest that it has");
    add_file(app, "--diff", request.diff_path,
             "How the print differs from this one: metadata, settings, layers, totals");
}

Status check_print(const Options& app, const Program& program, const CheckRequest& request,
                   const std::string& lyr_path, const std::string& output_path, bool others) {
    const bool diffs = !request.diff_path.empty(), writes = app.count("--output") > 0;
    if (others || request.verify + request.repair + request.thumbnail + diffs > 1)
        return usage("--verify, --repair, --thumbnail and --diff stand alone");
    if (request.repair && !writes) return usage("--repair needs -o FILE: the print to write");
    const bool may_write = request.repair || request.thumbnail;
    if (writes && !may_write)
        return usage("-o goes with --repair or --thumbnail, not with --verify or --diff");
    const char* what = request.thumbnail ? "the picture" : "the repaired print";
    if (const Status apart =
            check_apart({{"the print", lyr_path}}, {{what, may_write ? output_path : ""}});
        !apart)
        return apart;
    const SignalWatch watch(program.name);
    if (request.verify) return verify_print(lyr_path);
    if (request.repair) return repair_print(lyr_path, output_path);
    if (request.thumbnail) return write_thumbnail(lyr_path, output_path);
    return diff_prints(request.diff_path, lyr_path);
}

}  // namespace lyr::command_line
