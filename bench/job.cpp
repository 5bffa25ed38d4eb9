#include "bench/job.h"

#include <cmath>
#include <filesystem>
#include <variant>
#include <vector>

#include "bench/accuracy.h"
#include "bench/gcode.h"
#include "bench/program.h"
#include "bench/scratch_file.h"
#include "format/export/gcode.h"
#include "format/reader.h"
#include "slicer/bounds.h"
#include "slicer/slicer.h"

namespace lyr::bench {
namespace {

constexpr int runs = 5;
constexpr double filament_diameter_mm = 1.75;
// Enough for the 99 %; where one lies far off, it takes OCCT a search over whole surfaces.
constexpr std::size_t points = 20'000;

constexpr double least_speedup = 10;
constexpr double most_memory_share = 0.25;
constexpr double least_error_ratio = 5;
constexpr double most_volume_difference = 0.05;
constexpr double least_size_ratio = 15, least_own_size_ratio = 8;

// Our defaults, said to PrusaSlicer, and what it has by default and we have not, switched off. Its classic walls are as
// wide everywhere as ours, and quicker made than its variable ones. The bed has the model's origin in its middle, so
// that models keep their coordinates.
constexpr const char* prusa_settings = R"(perimeters = 3
perimeter_generator = classic
gap_fill_enabled = 1
extra_perimeters = 0
thick_bridges = 0
fill_density = 15%
fill_pattern = grid
fill_angle = 45
infill_overlap = 25%
top_solid_layers = 5
bottom_solid_layers = 4
solid_infill_below_area = 15
extrusion_width = 0.45
first_layer_extrusion_width = 0.45
external_perimeter_extrusion_width = 0.45
perimeter_extrusion_width = 0.45
infill_extrusion_width = 0.45
solid_infill_extrusion_width = 0.45
top_infill_extrusion_width = 0.45
nozzle_diameter = 0.4
filament_diameter = 1.75
elefant_foot_compensation = 0
xy_size_compensation = 0
skirts = 0
brim_width = 0
support_material = 0
bed_shape = -500x-500,500x-500,500x500,-500x500
)";

Result<ScratchFile> settings_file(bool thin_walls) {
    return ScratchFile::with(prusa_settings + std::string("thin_walls = ") +
                             (thin_walls ? "1\n" : "0\n"));
}

struct Job {
    std::string step_path, layer_height, result_path;

    std::vector<std::string> ours() const {
        return {LYR_STEPC,
                step_path,
                "-o",
                result_path,
                "--threads",
                "1",
                "--layer-height",
                layer_height,
                "--set",
                "perimeters.count=3",
                "--set",
                "infill.density=15%",
                "--set",
                "infill.pattern=grid"};
    }
    std::vector<std::string> theirs(const std::string& settings_path) const {
        return {"prusa-slicer",
                "--export-gcode",
                "--load",
                settings_path,
                "--layer-height",
                layer_height,
                "--first-layer-height",
                layer_height,
                "--dont-arrange",
                "--output",
                result_path,
                step_path};
    }
};

// Of one side.
struct Outcome {
    Usage usage;
    double volume_mm3 = 0, bytes = 0;
    std::vector<double> distances_mm;  // sorted
    double gcode_bytes = 0;            // of ours, as lyrview writes it
};

Result<double> lyr_volume_mm3(const std::string& path) {
    auto reader = format::Reader::open(path);
    if (!reader) return reader.error();
    double volume_mm3 = 0;
    for (;;) {
        const auto operation = reader->next();
        if (!operation) return operation.error();
        if (!*operation) return volume_mm3;
        if (std::holds_alternative<format::LayerStart>(**operation))
            volume_mm3 += reader->layer().totals.volume_mm3;
    }
}

Result<double> own_gcode_bytes(const std::string& path) {
    auto reader = format::Reader::open(path);
    if (!reader) return reader.error();
    double bytes = 0;
    Diagnostics notes;
    const auto count = [&](std::string_view piece) { bytes += static_cast<double>(piece.size()); };
    const Status written = format::write_gcode(*reader, {}, count, notes);
    if (!written) return written.error();
    return bytes;
}

Result<Outcome> ours(const Job& job, double layer_height_mm, const occt::Surfaces& surfaces) {
    const auto usage = median_usage(runs, job.ours());
    if (!usage) return usage.error();
    const auto volume_mm3 = lyr_volume_mm3(job.result_path);
    if (!volume_mm3) return volume_mm3.error();
    const double bytes = static_cast<double>(std::filesystem::file_size(job.result_path));
    const auto gcode_bytes = own_gcode_bytes(job.result_path);
    if (!gcode_bytes) return gcode_bytes.error();
    const auto flank = printed_points(job.step_path, layer_height_mm, points);
    if (!flank) return flank.error();
    return Outcome{*usage, *volume_mm3, bytes, distances_mm(surfaces, *flank), *gcode_bytes};
}

// PrusaSlicer puts the part's lowest point on the bed and leaves it where it is otherwise.
Result<double> bottom_mm(const std::string& step_path) {
    const slicer::Options options;
    Diagnostics found;
    const auto model = slicer::load(step_path, options, found);
    if (!model) return model.error();
    return slicer::bounding_box(*model, options.tolerance()).min().z();
}

Result<std::vector<double>> their_distances_mm(const Job& job, double layer_height_mm,
                                               const occt::Surfaces& surfaces) {
    const auto bottom = bottom_mm(job.step_path);
    if (!bottom) return bottom.error();
    const auto settings = settings_file(false);
    if (!settings) return settings.error();
    if (const auto usage = run_program(job.theirs(settings->path())); !usage) return usage.error();
    const auto gcode = read_gcode(job.result_path, filament_diameter_mm);
    if (!gcode) return gcode.error();
    std::vector<Point3> flank = flank_points(gcode->walls, layer_height_mm, points);
    for (Point3& point : flank) point.z() += *bottom;
    return distances_mm(surfaces, flank);
}

Result<Outcome> theirs(const Job& job, double layer_height_mm, const occt::Surfaces& surfaces) {
    const auto settings = settings_file(true);
    if (!settings) return settings.error();
    const auto usage = median_usage(runs, job.theirs(settings->path()));
    if (!usage) return usage.error();
    const auto gcode = read_gcode(job.result_path, filament_diameter_mm);
    if (!gcode) return gcode.error();
    const double bytes = static_cast<double>(std::filesystem::file_size(job.result_path));
    const auto distances = their_distances_mm(job, layer_height_mm, surfaces);
    if (!distances) return distances.error();
    return Outcome{*usage, gcode->volume_mm3, bytes, *distances, 0};
}

std::string percent(double share) {
    return number(100 * share) + " %";
}

Table table_of(const std::string& title, const Outcome& ours, const Outcome& theirs) {
    constexpr double bytes_per_mb = 1e6;
    Table table{title, {"", "ours", "PrusaSlicer", "ratio", "required"}, {}};
    const auto row = [&](const std::string& what, double mine, double other,
                         const std::string& required, const std::string& unit) {
        table.rows.push_back(
            {what, number(mine) + unit, number(other) + unit, number(other / mine), required});
    };
    row("processor time", ours.usage.processor_s, theirs.usage.processor_s, number(least_speedup),
        " s");
    row("peak memory", ours.usage.peak_bytes / bytes_per_mb, theirs.usage.peak_bytes / bytes_per_mb,
        number(1 / most_memory_share), " MB");
    const auto distance = [&](const std::string& what, double share, const std::string& required) {
        row("distance from the surface, " + what, quantile(ours.distances_mm, share),
            quantile(theirs.distances_mm, share), required, " mm");
    };
    distance("median", 0.5, "");
    distance("99 %", 0.99, number(least_error_ratio));
    distance("greatest", 1, number(least_error_ratio));
    row("extruded volume", ours.volume_mm3, theirs.volume_mm3,
        "+- " + percent(most_volume_difference), " mm3");
    row("file", ours.bytes / bytes_per_mb, theirs.bytes / bytes_per_mb, number(least_size_ratio),
        " MB");
    table.rows.push_back({"our own G-code of it", number(ours.gcode_bytes / bytes_per_mb) + " MB",
                          "", number(ours.gcode_bytes / ours.bytes), number(least_own_size_ratio)});
    return table;
}

void require(const std::string& name, const Outcome& ours, const Outcome& theirs,
             Requirements& requirements) {
    const auto least = [&](const std::string& what, double measured, double wanted) {
        requirements.push_back(
            {.what = name + ": " + what, .measured = measured, .wanted = wanted});
    };
    const auto most = [&](const std::string& what, double measured, double wanted) {
        requirements.push_back(
            {.what = name + ": " + what, .measured = measured, .wanted = wanted, .at_most = true});
    };
    least("whole job, times PrusaSlicer's speed", theirs.usage.processor_s / ours.usage.processor_s,
          least_speedup);
    most("peak memory, of PrusaSlicer's", ours.usage.peak_bytes / theirs.usage.peak_bytes,
         most_memory_share);
    for (const auto& [what, share] : {std::pair("99 % of the walls", 0.99), {"all walls", 1.0}}) {
        least(std::string("PrusaSlicer's distance from the surface, times ours, ") + what,
              quantile(theirs.distances_mm, share) / quantile(ours.distances_mm, share),
              least_error_ratio);
    }
    most("extruded volume off PrusaSlicer's", std::abs(ours.volume_mm3 / theirs.volume_mm3 - 1),
         most_volume_difference);
    least("PrusaSlicer's file, times ours", theirs.bytes / ours.bytes, least_size_ratio);
    least("our own G-code, times the .lyr file", ours.gcode_bytes / ours.bytes,
          least_own_size_ratio);
}

}  // namespace

Status compare_job(const std::string& step_path, double layer_height_mm,
                   Requirements& requirements) {
    const auto surfaces = occt::Surfaces::read(step_path);
    if (!surfaces) {
        return Diagnostic{
            Severity::error, ExitStatus::input, "OCCT reads no shape", {.file = step_path}};
    }
    const auto result = ScratchFile::with("");
    if (!result) return result.error();
    const Job job{step_path, number(layer_height_mm), result->path()};
    const auto mine = ours(job, layer_height_mm, *surfaces);
    if (!mine) return mine.error();
    const auto other = theirs(job, layer_height_mm, *surfaces);
    if (!other) return other.error();
    const std::string name = std::filesystem::path(step_path).filename().string();
    print(table_of("The whole job, " + name + " at " + job.layer_height +
                       " mm a layer, three perimeters, 15 % grid; medians of " +
                       std::to_string(runs) + " runs, distances of " + std::to_string(points) +
                       " points",
                   *mine, *other));
    require(name, *mine, *other, requirements);
    return Done{};
}

}  // namespace lyr::bench
