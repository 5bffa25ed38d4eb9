// Representations are recognised by what they are made of (a name, a list of items, a context), not by a list of
// the several dozen subtypes that application protocols define.

#include "parser/import/representations.h"

#include <array>

#include "parser/import/solids.h"

namespace lyr::importer {

namespace {

// The record that holds name, items and context.
part21::RecordIndex body(const File& file, InstanceIndex instance) {
    return file.is_complex(instance) ? file.record(instance, "REPRESENTATION")
                                     : file.record(instance, 0);
}

// What a SHAPE_DEFINITION_REPRESENTATION defines the shape of: a product definition (also by way of an aspect of its
// shape) or a usage of one. Not valid() for anything else.
struct Defined {
    InstanceIndex subject;
    bool by_aspect = false;
};

Defined defined(const File& file, InstanceIndex definition) {
    Defined result{definition};
    // A property definition's third attribute leads to what it is a property of, an aspect's to a property.
    constexpr int longest_way = 4;
    for (int i = 0; i < longest_way; ++i) {
        const std::string_view type = keyword(file, result.subject);
        const bool is_property =
            type == "PRODUCT_DEFINITION_SHAPE" || type == "PROPERTY_DEFINITION";
        // Features are aspects of further types at once.
        const part21::RecordIndex aspect = file.record(result.subject, "SHAPE_ASPECT");
        const bool is_aspect =
            type.find("SHAPE_ASPECT") != std::string_view::npos || aspect.valid();
        if (!is_property && !is_aspect) return result;
        const Result<part21::Arguments> arguments =
            aspect.valid() ? file.arguments(aspect) : file.arguments(result.subject);
        if (!arguments) return {};
        const Result<InstanceIndex> next = (*arguments)[2].as_reference();
        if (!next) return {};
        result.subject = *next;
        result.by_aspect = result.by_aspect || is_aspect;
    }
    return {};
}

}  // namespace

Result<RepresentationTable> RepresentationTable::read(const File& file) {
    RepresentationTable table;
    if (const Status status = table.read_representations(file); !status) return status.error();
    table.joined_ = DisjointSets(table.representations.size());
    if (const Status status = table.read_definitions(file); !status) return status.error();
    if (const Status status = table.read_relationships(file); !status) return status.error();
    if (const Status status = table.read_usages(file); !status) return status.error();
    table.unite_related();
    return table;
}

RepresentationId RepresentationTable::find(InstanceIndex representation) const {
    const auto found = by_instance_.find(representation.value);
    return found == by_instance_.end() ? RepresentationId() : found->second;
}

RepresentationId RepresentationTable::of_product(InstanceIndex product_definition) const {
    const auto found = by_product_.find(product_definition.value);
    return found == by_product_.end() ? RepresentationId() : found->second;
}

RepresentationId RepresentationTable::united(RepresentationId representation) const {
    return RepresentationId(joined_.of(representation.value));
}

void RepresentationTable::unite(RepresentationId a, RepresentationId b) {
    joined_.join(a.value, b.value);
}

Status RepresentationTable::read_representations(const File& file) {
    const auto names_representation = [](std::string_view keyword) {
        return keyword.find("REPRESENTATION") != std::string_view::npos;
    };
    for (const InstanceIndex instance : file.instances_where(names_representation)) {
        bool is_shape = false;
        for (std::size_t k = 0; k < file.record_count(instance); ++k) {
            const part21::KeywordId id = file.keyword_of(file.record(instance, k));
            is_shape |= file.keyword(id).find("SHAPE_REPRESENTATION") != std::string_view::npos;
        }
        const Status status = read_representation(file, instance, is_shape);
        if (!status) return status;
    }
    return Done{};
}

Status RepresentationTable::read_representation(const File& file, InstanceIndex instance,
                                                bool is_shape) {
    const part21::RecordIndex record = body(file, instance);
    if (!record.valid()) return Done{};
    const Result<part21::Arguments> arguments = file.arguments(record);
    if (!arguments) return is_shape ? Status(arguments.error()) : Status(Done{});
    if (arguments->count() < 3 || !(*arguments)[1].is_list() || !(*arguments)[2].is_reference())
        return Done{};
    Representation representation;
    representation.instance = instance;
    representation.is_shape = is_shape;
    const Result<InstanceIndex> context = (*arguments)[2].as_reference();
    if (!context) return is_shape ? Status(context.error()) : Status(Done{});
    representation.context = *context;
    const Result<part21::List> items = (*arguments)[1].as_list();
    if (!items) return items.error();
    for (const part21::Value& value : *items) {
        if (!value.is_reference()) continue;
        const Result<InstanceIndex> item = value.as_reference();
        if (!item) {
            if (is_shape) return item.error();
            continue;
        }
        if (kind_of(file, *item) != ItemKind::other) representation.items.push_back(*item);
        if (keyword(file, *item) == "AXIS2_PLACEMENT_3D")
            representation.placements.push_back(*item);
    }
    by_instance_.emplace(instance.value, RepresentationId(representations.size()));
    representations.push_back(std::move(representation));
    return Done{};
}

Status RepresentationTable::read_definitions(const File& file) {
    for (const InstanceIndex instance : file.instances_of("SHAPE_DEFINITION_REPRESENTATION")) {
        Fields fields(file, instance, 2);
        const InstanceIndex definition = fields.reference(0);
        const InstanceIndex used = fields.reference(1);
        if (!fields.ok()) return fields.error();
        const RepresentationId representation = find(used);
        if (!representation.valid()) return unexpected(file, instance, "a representation", used);
        representations[representation.value].is_shape = true;
        const auto [subject, by_aspect] = defined(file, definition);
        if (!subject.valid()) continue;
        if (file.is(subject, "NEXT_ASSEMBLY_USAGE_OCCURRENCE"))
            representations[representation.value].usage = subject;
        if (!keyword(file, subject).starts_with("PRODUCT_DEFINITION")) continue;
        Representation& r = representations[representation.value];
        r.is_of_aspect = by_aspect && (!r.product.valid() || r.is_of_aspect);
        r.product = subject;
        const auto [first, is_new] = by_product_.emplace(subject.value, representation);
        if (!is_new) unite(first->second, representation);
    }
    return Done{};
}

Status RepresentationTable::read_relationships(const File& file) {
    constexpr std::array types{"REPRESENTATION_RELATIONSHIP", "SHAPE_REPRESENTATION_RELATIONSHIP",
                               "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION"};
    std::unordered_map<std::uint32_t, std::size_t> known;
    for (const std::string_view type : types) {
        for (const InstanceIndex instance : file.instances_of(type)) {
            if (!known.emplace(instance.value, relationships.size()).second) continue;
            const bool transforms =
                file.is(instance, "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION");
            const std::size_t own = transforms && !file.is_complex(instance) ? 5 : 4;
            Attributes a(file, instance, "REPRESENTATION_RELATIONSHIP", 0, own);
            const InstanceIndex first = a.fields.reference(2), second = a.fields.reference(3);
            if (!a.fields.ok()) return a.fields.error();
            Relationship relationship{instance, find(first), find(second), {}, {}};
            if (transforms) {
                Attributes t(file, instance, "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION", 4,
                             1);
                relationship.transformation = t.fields.reference(t.first);
                if (!t.fields.ok()) return t.fields.error();
            }
            relationships.push_back(relationship);
        }
    }
    for (const InstanceIndex instance :
         file.instances_of("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION")) {
        Fields fields(file, instance, 2);
        const InstanceIndex relationship = fields.reference(0), property = fields.reference(1);
        if (!fields.ok()) return fields.error();
        const auto found = known.find(relationship.value);
        if (found == known.end()) {
            return unexpected(file, instance, "REPRESENTATION_RELATIONSHIP", relationship);
        }
        Fields property_fields(file, property, 3);
        relationships[found->second].usage = property_fields.reference(2);
        if (!property_fields.ok()) return property_fields.error();
    }
    return Done{};
}

Status RepresentationTable::read_usages(const File& file) {
    for (const InstanceIndex instance : file.instances_of("NEXT_ASSEMBLY_USAGE_OCCURRENCE")) {
        const std::size_t count = file.is_complex(instance) ? 5 : 6;
        Attributes a(file, instance, "PRODUCT_DEFINITION_RELATIONSHIP", 0, count);
        const InstanceIndex parent = a.fields.reference(3), child = a.fields.reference(4);
        if (!a.fields.ok()) return a.fields.error();
        usages.push_back({instance, parent, child});
    }
    return Done{};
}

void RepresentationTable::unite_related() {
    for (const Relationship& r : relationships) {
        if (r.transformation.valid() || r.usage.valid() || !r.first.valid() || !r.second.valid())
            continue;
        if ((*this)[r.first].is_shape && (*this)[r.second].is_shape) unite(r.first, r.second);
    }
}

std::string product_name(const File& file, InstanceIndex product_definition) {
    if (!product_definition.valid()) return {};
    // PRODUCT_DEFINITION(id, description, formation, ..), formation(id, description, product, ..),
    // PRODUCT(id, name, ..)
    InstanceIndex instance = product_definition;
    for (int i = 0; i < 2; ++i) {
        const Result<part21::Arguments> arguments = file.arguments(instance);
        if (!arguments) return {};
        const Result<InstanceIndex> next = (*arguments)[2].as_reference();
        if (!next) return {};
        instance = *next;
    }
    if (keyword(file, instance) != "PRODUCT") return {};
    const Result<part21::Arguments> arguments = file.arguments(instance);
    if (!arguments) return {};
    const Result<std::string> id = (*arguments)[0].as_string(), name = (*arguments)[1].as_string();
    if (name && !name->empty()) return *name;
    return id ? *id : std::string();
}

}  // namespace lyr::importer
