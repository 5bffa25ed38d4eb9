// What every reader of this room needs: the attributes of an entity in either mapping, and errors that name it.
//
// Contract
//  1. Attributes finds the attributes that an entity type declares itself, in a simple instance behind those that
//     it inherits, in a complex one in the type's own record.
//  2. Errors name the entity, its #id and what refers to it.

#pragma once

#include <string>
#include <string_view>

#include "parser/part21/fields.h"
#include "parser/part21/part21.h"
#include "parser/part21/trail.h"

namespace lyr::importer {

using part21::Fields;
using part21::File;
using part21::InstanceIndex;

// "CIRCLE #12"
std::string named(const File& file, InstanceIndex instance);

// "expected a curve, found PLANE #7", at the instance that refers to it.
Diagnostic unexpected(const File& file, InstanceIndex user, std::string_view expected,
                      InstanceIndex found);

// "PLANE #7, as the surface of a face, is not supported", status unsupported.
Diagnostic unsupported(const File& file, InstanceIndex instance, std::string_view role);

Diagnostic warning(const File& file, InstanceIndex instance, std::string message,
                   ExitStatus status = ExitStatus::input);

// The keyword of a simple instance, "" for a complex one.
std::string_view keyword(const File& file, InstanceIndex instance);

class Attributes {
public:
    Attributes(const File& file, InstanceIndex instance, std::string_view type,
               std::size_t inherited, std::size_t own);

    Fields fields;
    std::size_t first;  // the number of the first own attribute among the fields
};

}  // namespace lyr::importer
