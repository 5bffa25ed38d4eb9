// Reading a model: Part 21 text, entities, topology, build direction.

#include "slicer/slicer.h"

#include "kernel/brep/placement.h"
#include "kernel/brep/validity.h"
#include "parser/import/import.h"
#include "parser/part21/part21.h"

namespace lyr::slicer {

Result<Model> load(const std::string& step_path, const Options& options, Diagnostics& diagnostics) {
    auto file = part21::File::open(step_path);
    if (!file) return file.error();
    diagnostics.insert(diagnostics.end(), file->diagnostics().begin(), file->diagnostics().end());
    auto model = importer::import_model(*file, diagnostics);
    if (!model) return model.error();
    for (Diagnostic& found : validate(*model)) {
        found.where.file = step_path;
        diagnostics.push_back(std::move(found));
    }
    return transformed(std::move(*model), turned_up(options.up));
}

}  // namespace lyr::slicer
