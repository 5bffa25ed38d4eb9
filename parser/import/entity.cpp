// Names and attributes of entity instances.

#include "parser/import/entity.h"

#include <algorithm>
#include <array>

namespace lyr::importer {

namespace {

constexpr std::array supertypes{std::string_view("REPRESENTATION_ITEM"),
                                std::string_view("GEOMETRIC_REPRESENTATION_ITEM"),
                                std::string_view("BOUNDED_CURVE"),
                                std::string_view("BOUNDED_SURFACE"),
                                std::string_view("CURVE"),
                                std::string_view("SURFACE"),
                                std::string_view("B_SPLINE_CURVE"),
                                std::string_view("B_SPLINE_SURFACE"),
                                std::string_view("NAMED_UNIT"),
                                std::string_view("SOLID_MODEL")};

part21::RecordIndex record_of(const File& file, InstanceIndex instance, std::string_view type) {
    return file.is_complex(instance) ? file.record(instance, type) : file.record(instance, 0);
}

}  // namespace

std::string named(const File& file, InstanceIndex instance) {
    const std::string id = " #" + std::to_string(file.id(instance));
    if (!file.is_complex(instance)) return file.type_name(instance) + id;
    // Of a complex instance, what is not a mere supertype that its like all have.
    std::string name;
    for (std::size_t i = 0; i < file.record_count(instance); ++i) {
        const std::string_view type = file.keyword(file.keyword_of(file.record(instance, i)));
        if (std::find(supertypes.begin(), supertypes.end(), type) != supertypes.end()) continue;
        if (!name.empty()) name += ' ';
        name += type;
    }
    return (name.empty() ? file.type_name(instance) : name) + id;
}

Diagnostic unexpected(const File& file, InstanceIndex user, std::string_view expected,
                      InstanceIndex found) {
    return file.error(user, file.type_name(user) + ": expected " + std::string(expected) +
                                ", found " + named(file, found));
}

Diagnostic unsupported(const File& file, InstanceIndex instance, std::string_view role) {
    return file.error(instance,
                      named(file, instance) + ", as " + std::string(role) + ", is not supported",
                      ExitStatus::unsupported);
}

Diagnostic warning(const File& file, InstanceIndex instance, std::string message,
                   ExitStatus status) {
    Diagnostic diagnostic = file.error(instance, std::move(message), status);
    diagnostic.severity = Severity::warning;
    return diagnostic;
}

std::string_view keyword(const File& file, InstanceIndex instance) {
    const part21::KeywordId id = file.keyword_of(instance);
    return id.valid() ? file.keyword(id) : std::string_view();
}

Attributes::Attributes(const File& file, InstanceIndex instance, std::string_view type,
                       std::size_t inherited, std::size_t own)
    : fields(file, record_of(file, instance, type),
             file.is_complex(instance) ? own : inherited + own),
      first(file.is_complex(instance) ? 0 : inherited) {}

}  // namespace lyr::importer
