// Reading a model: Part 21 text, entities, topology, repairs, build direction.

#include "slicer/slicer.h"

#include <future>
#include <limits>

#include "base/read_text.h"
#include "kernel/brep/extent.h"
#include "kernel/brep/placement.h"
#include "parser/import/import.h"
#include "parser/part21/part21.h"
#include "slicer/layers.h"
#include "slicer/mend.h"
#include "slicer/sha256.h"

namespace lyr::slicer {
namespace {

Result<part21::File> open(const std::string& path) {
    if (path != "-") return part21::File::open(path);
    auto text = read_text(path, std::numeric_limits<std::size_t>::max());
    if (!text) return text.error();
    return part21::File::parse(standard_input_name, std::move(*text));
}

// The kernel knows instances only.
Diagnostic in_file(Diagnostic diagnostic, const part21::File& file) {
    if (diagnostic.where.file.empty()) diagnostic.where.file = file.name();
    return diagnostic;
}

}  // namespace

Result<Model> load(const std::string& step_path, const Options& options, Diagnostics& diagnostics,
                   std::string* sha256) {
    auto file = open(step_path);
    if (!file) return file.error();
    // The bytes are read once more for their hash, beside all else.
    auto hash = std::async(thread_count(options) > 1 ? std::launch::async : std::launch::deferred,
                           [&] { return sha256 ? sha256_of(file->text()) : std::string(); });
    diagnostics.insert(diagnostics.end(), file->diagnostics().begin(), file->diagnostics().end());
    Diagnostics found;
    auto model = importer::import_model(*file, found);
    Status mended = model ? check_places(*model) : Status(Done{});
    if (model && mended) mended = mend(*model, options, found);
    for (Diagnostic& diagnostic : found) diagnostics.push_back(in_file(diagnostic, *file));
    if (!model) return model.error();
    if (!mended) return in_file(mended.error(), *file);
    if (sha256) *sha256 = hash.get();
    return transformed(std::move(*model), turned_up(options.up));
}

}  // namespace lyr::slicer
