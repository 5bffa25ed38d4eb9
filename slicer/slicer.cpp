// Reading a model: Part 21 text, entities, topology, build direction.

#include "slicer/slicer.h"

#include <limits>

#include "base/read_text.h"
#include "kernel/brep/placement.h"
#include "kernel/brep/validity.h"
#include "parser/import/import.h"
#include "parser/part21/part21.h"

namespace lyr::slicer {
namespace {

Result<part21::File> open(const std::string& path) {
    if (path != "-") return part21::File::open(path);
    auto text = read_text(path, std::numeric_limits<std::size_t>::max());
    if (!text) return text.error();
    return part21::File::parse(standard_input_name, std::move(*text));
}

}  // namespace

Result<Model> load(const std::string& step_path, const Options& options, Diagnostics& diagnostics) {
    auto file = open(step_path);
    if (!file) return file.error();
    diagnostics.insert(diagnostics.end(), file->diagnostics().begin(), file->diagnostics().end());
    auto model = importer::import_model(*file, diagnostics);
    if (!model) return model.error();
    for (Diagnostic& found : validate(*model)) {
        found.where.file = file->name();
        diagnostics.push_back(std::move(found));
    }
    return transformed(std::move(*model), turned_up(options.up));
}

}  // namespace lyr::slicer
