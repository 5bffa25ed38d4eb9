// From a STEP file to a print: what stepc does, as functions.
//
//   load()        file -> model, turned so that the build direction is +z
//   section_at()  sections at given heights, in the model's own coordinates
//   print()       the model on the bed -> layers -> .lyr
//
// Contract
//  1. No output appears unless all of it is right: an error leaves the target as it was.
//  2. The output depends on the input and the options, not on the number of threads.
//  3. Layers are `layer.height_mm` thick, the first one `layer.first_height_mm`; each is the section at its middle, as
//     long as that is below the part's top. So a part of a whole number of layers has just as many, and a rest of
//     less than half a layer is left off, of more than half counts as a layer. Adaptive layers: adaptive.h.
//  4. On the bed means: lowest point at z = 0, or over the raft (raft.h); the bounding box's lower left corner at `plate.at_mm`. Copies lie as
//     plate.h has it; they are made once, and differ in their place and in the way from one to the other only.
//  5. A contour that does not close is an error, unless `allow_open`; then it is left out and reported.
//  6. Surfaces that close, if need be after sewing, are solids. Those that do not are left out beside solids; alone they
//     are an error (status geometry), unless `allow_open`.
//  7. Solids that overlap or touch are printed as one: a layer's walls and fill are those of the union of their sections.
//     Reports keep solids apart.
//  8. Where a section crosses itself, as faces overlap a little, and its walls could not be made for that, the layer is
//     what the section winds around; the summary counts such layers.
//  9. The file has each layer's time as estimate.h has it, for the printer of the options.

#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "kernel/brep/model.h"
#include "kernel/geometry/tolerance.h"
#include "kernel/section/cutter.h"
#include "profile/profile.h"
#include "slicer/estimate.h"
#include "target/config/printer.h"

namespace lyr::slicer {

struct Options {
    lyr::profile::Profile profile;
    std::string profile_name;   // for the file's metadata, as the configuration
    std::string configuration;  // all settings as text, verbatim
    std::string source_sha256;  // of the model's file, for the print's metadata
    // Whose limits the estimates keep; none: a generic one.
    std::optional<config::Printer> printer{};
    Vector3 up = Vector3::UnitZ();
    bool allow_open = false;
    bool strict = false;   // refuse a model with geometric defects instead of healing it
    unsigned threads = 0;  // 0: as many as there are processors

    config::Printer machine() const { return printer.value_or(config::generic_printer()); }
    Tolerance tolerance() const { return {profile.slicing.tolerance_mm}; }
};

// Called from the calling thread only, with what is done of how much.
using Progress = std::function<void(const char* stage, std::size_t done, std::size_t total)>;

// Of adaptive layers. `deeper_layers` are those whose steps may be deeper than the profile's; uniform layers of
// `uniform_mm` would have steps as deep as theirs. The first layer counts in neither.
struct AdaptiveFigures {
    double thinnest_mm = 0, thickest_mm = 0;
    std::size_t deeper_layers = 0;
    double uniform_mm = 0;
    std::size_t uniform_layers = 0;
};

// Contours, lines and arcs are those of the layers' outlines, or of the sections.
struct Summary {
    std::size_t solids = 0, faces = 0, layers = 0, contours = 0, circles = 0, lines = 0, arcs = 0;
    std::size_t united_layers = 0;     // where solids overlapped or touched
    std::size_t uncrossed_layers = 0;  // whose sections crossed themselves
    std::size_t slivers = 0;  // contours left out there: gaps and leftovers within the tolerance
    std::optional<AdaptiveFigures> adaptive{};
    std::uint64_t bytes = 0;
    Eigen::AlignedBox3d box{};           // of the model, as it is printed; of copies: the first one
    std::string placed{};                // what lies where, if there are copies
    Estimate estimate{};                 // of a print
    double filament_mm = 0, mass_g = 0;  // as the file has them
};

// For people: the part's size and its layers, in a line or, of adaptive ones, two.
std::string size_text(const Summary& summary, const Options& options);

// For people: time and filament, then a line for each role that is printed.
std::string estimate_text(const Summary& summary, const std::string& printer_name);

struct SectionFigures {
    double z_mm = 0, area_mm2 = 0, length_mm = 0;
    std::size_t loops = 0, circles = 0, lines = 0, arcs = 0;
    std::uint32_t open = 0;
};

// `step_path` may be "-", standard input. `sha256`, if asked for, is that of the file (64 hexadecimal digits).
Result<Model> load(const std::string& step_path, const Options& options, Diagnostics& diagnostics,
                   std::string* sha256 = nullptr);

// One line a section: {"z":...,"area_mm2":...,"length_mm":...,"loops":...,"lines":...,"arcs":...,"open":0}
std::string to_json(const SectionFigures& figures);

// Heights from a text file or, as "-", standard input, one a line; empty lines and lines that start with # are passed
// over. Errors: not readable, not a finite number (with its line).
Result<std::vector<double>> read_heights(const std::string& path);

Result<Summary> section_at(const Model& model, const std::vector<double>& heights_mm,
                           const std::string& report_path, const Options& options,
                           const Progress& progress, Diagnostics& diagnostics);

// Writes the .lyr to `lyr_path` and, if `report_path` is not empty, the layers' figures there.
Result<Summary> print(Model model, const std::string& source_name, const std::string& lyr_path,
                      const std::string& report_path, const Options& options,
                      const Progress& progress, Diagnostics& diagnostics);

}  // namespace lyr::slicer
