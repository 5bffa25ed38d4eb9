// Two passes over the text: what its comments say of the whole, then what it does.

#include "format/import/gcode_import.h"

#include <cmath>
#include <optional>

#include "base/text.h"
#include "format/import/gcode_facts.h"
#include "format/import/gcode_interpreter.h"
#include "format/import/gcode_layers.h"

namespace lyr::format {
namespace {

constexpr double usual_filament_mm = 1.75;
constexpr double least_lost_mm = 0.01;
// Between heights: what relative moves add up to.
constexpr double same_z_mm = 1e-6;

Metadata metadata_of(const GcodeFacts& facts, const std::string& source_name,
                     const GcodeImportOptions& options) {
    Metadata data;
    data.generator = options.generator;
    if (!facts.producer.empty()) data.generator += ", from G-code of " + facts.producer;
    data.source_name = facts.source.empty() ? source_name : facts.source;
    data.source_sha256 = facts.source_sha256;
    data.printer = facts.printer;
    data.material = facts.material;
    data.profile = facts.profile;
    data.filament_density_g_cm3 = facts.filament_density_g_cm3;
    data.objects = facts.objects;
    data.filament_diameter_mm = options.filament_diameter_mm > 0 ? options.filament_diameter_mm
                                : facts.filament_diameter_mm > 0 ? facts.filament_diameter_mm
                                                                 : usual_filament_mm;
    return data;
}

// Layers by height: the last item that extruded, and where.
class ByHeight {
public:
    // Behind a line: if it has extruded at another height than before, the items before it are a layer.
    std::optional<GcodeLayer> take(GcodeLayer& layer) {
        std::optional<GcodeLayer> below;
        for (; seen_ < layer.items.size(); ++seen_) {
            const auto* go = std::get_if<GcodeGo>(&layer.items[seen_]);
            if (!go || !go->extrudes()) continue;
            if (z_mm_ && std::abs(*z_mm_ - go->from.z) > same_z_mm) below = split(layer);
            z_mm_ = go->to.z;
            after_ = seen_ + 1;
        }
        return below;
    }

private:
    GcodeLayer split(GcodeLayer& layer) {
        const auto at = layer.items.begin() + static_cast<std::ptrdiff_t>(after_);
        GcodeLayer below{
            .items = {layer.items.begin(), at}, .begin = layer.begin, .extrudes = true};
        layer.begin = std::get<GcodeGo>(layer.items[after_ - 1]).to;
        layer.items.erase(layer.items.begin(), at);
        seen_ -= after_;
        return below;
    }

    std::optional<double> z_mm_;
    std::size_t seen_ = 0, after_ = 0;
};

}  // namespace

Result<FileTotals> import_gcode(std::string_view text, const std::string& name,
                                const std::string& source_name, const std::string& lyr_path,
                                const GcodeImportOptions& options, Diagnostics& diagnostics) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF", binary = "GCDE";
    if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
    if (text.starts_with(binary))
        return Diagnostic{Severity::error,
                          ExitStatus::unsupported,
                          "this is binary G-code; slicers write it as text, too",
                          {.file = name}};
    const GcodeFacts facts = gcode_facts(text);
    const Metadata metadata = metadata_of(facts, source_name, options);
    auto writer = Writer::create(lyr_path, facts.quantum, metadata);
    if (!writer) return writer.error();
    GcodeLayers layers(*writer, facts.quantum, metadata.filament_diameter_mm);
    GcodeInterpreter interpreter(name, facts);
    ByHeight by_height;
    std::optional<Diagnostic> error;
    const auto keep = [&](const Status& status) {
        if (!status) error = status.error();
    };
    bool marked = false;  // a layer has begun
    for_each_line(text, [&](std::string_view line, std::uint32_t number) {
        if (interpreter.begins_layer(line)) {
            if (marked || interpreter.layer().extrudes)
                keep(layers.add(interpreter.take_layer()));
            else
                interpreter.begin_layer();
            marked = true;
        }
        if (!error) keep(interpreter.take(line, number));
        if (error || facts.marks_layers) return !error;
        if (auto below = by_height.take(interpreter.layer())) keep(layers.add(std::move(*below)));
        return !error;
    });
    const bool is_layer = marked || interpreter.layer().extrudes;
    if (!error && is_layer) keep(layers.add(interpreter.take_layer()));
    if (!error && !interpreter.extrudes())
        error = Diagnostic{
            Severity::error, ExitStatus::input, "nothing in it extrudes", {.file = name}};
    if (!error) keep(layers.finish());
    if (error) return *error;
    interpreter.report(diagnostics);
    if (layers.lost_filament_mm() > least_lost_mm)
        diagnostics.push_back({Severity::warning,
                               ExitStatus::input,
                               "motions that are too short for what they push are left out, with " +
                                   shortest(std::round(layers.lost_filament_mm() * 100) / 100) +
                                   " mm of filament",
                               {.file = name}});
    if (layers.left_out())
        diagnostics.push_back(
            {Severity::warning,
             ExitStatus::input,
             "more than 16 heaters or 8 fans: a layer's start does not set all of them",
             {.file = name}});
    if (layers.speeds_differ())
        diagnostics.push_back({Severity::note,
                               ExitStatus::ok,
                               "retractions of one layer have the speed of its first",
                               {.file = name}});
    return writer->finish();
}

}  // namespace lyr::format
