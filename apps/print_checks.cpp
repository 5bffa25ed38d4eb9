#include "apps/print_checks.h"

#include <algorithm>
#include <span>

#include "apps/export_format.h"
#include "apps/files.h"
#include "apps/signal_watch.h"
#include "base/file_place.h"
#include "base/read_text.h"
#include "base/replace_file.h"
#include "base/text.h"
#include "format/check/repair.h"
#include "format/check/verify.h"
#include "format/export/diff.h"
#include "format/reader.h"

namespace lyr::command_line {
namespace {

Diagnostic other_file(const std::string& path) {
    return {Severity::error, ExitStatus::input, format::no_print, {.file = path}};
}

// A file is looked at piece by piece; what comes from a stream is held as a whole.
Result<format::FileView> view_of(const std::string& path, std::string& held) {
    const auto fits = [](std::span<const std::byte> head) {
        return head.empty() || format::is_print(head);
    };
    if (path != "-" && is_regular_file(path)) {
        auto view = format::FileView::open(path);
        if (view && !fits(view->at(0, format::print_head_bytes))) return other_file(path);
        return view;
    }
    const auto wrong = [&](std::string_view head) -> std::optional<std::string> {
        return fits(std::as_bytes(std::span(head))) ? std::nullopt
                                                    : std::optional(std::string(format::no_print));
    };
    auto text = read_text(path, most_readable_bytes(path), {format::print_head_bytes, wrong});
    if (!text) return text.error();
    held = std::move(*text);
    return format::FileView(std::as_bytes(std::span(held)));
}

Status verify_print(const std::string& path) {
    std::string held;
    auto file = view_of(path, held);
    if (!file) return file.error();
    const format::Verification verification = format::verify(*file);
    if (file->error()) return *file->error();
    const std::string name = input_name(path);
    if (const Status told = tell(format::to_text(verification, name)); !told) return told;
    if (verification.findings.empty()) return Done{};
    return format::to_diagnostic(verification, name);
}

Status repair_print(const std::string& path, const std::string& output) {
    std::string held;
    auto file = view_of(path, held);
    if (!file) return file.error();
    const std::string name = input_name(path);
    const format::Verification verification = format::verify(*file);
    if (file->error()) return *file->error();
    const auto repaired = format::repair(*file, verification, name, output);
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
    const auto named = export_format(output_path, "", std::nullopt);
    if (request.repair && named && *named != ExportFormat::lyr)
        return usage("--repair writes a print: say -o FILE.lyr");
    if (request.thumbnail && named) return usage("--thumbnail writes a picture: say -o FILE.png");
    const SignalWatch watch(program.name);
    if (request.verify) return verify_print(lyr_path);
    if (request.repair) return repair_print(lyr_path, output_path);
    if (request.thumbnail) return write_thumbnail(lyr_path, output_path);
    return diff_prints(request.diff_path, lyr_path);
}

}  // namespace lyr::command_line
