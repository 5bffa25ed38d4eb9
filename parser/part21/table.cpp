// Questions to the table that need more than an array access.

#include "parser/part21/table.h"

#include <algorithm>

namespace lyr::part21 {

InstanceIndex Table::instance_of(RecordIndex record) const {
    const auto after = std::upper_bound(first_record.begin(), first_record.end(), record.value);
    if (after == first_record.begin()) return {};
    return InstanceIndex(static_cast<std::size_t>(after - first_record.begin()) - 1);
}

const Table::External* Table::external(std::uint64_t id) const {
    const auto found =
        std::lower_bound(externals.begin(), externals.end(), id,
                         [](const External& e, std::uint64_t i) { return e.id < i; });
    return found != externals.end() && found->id == id ? &*found : nullptr;
}

Location Table::location(std::size_t offset) const {
    const LineColumn place = lines.locate(source.text(), offset);
    return {.file = name, .line = place.line, .column = place.column};
}

Location Table::location(std::size_t offset, RecordIndex record) const {
    Location where = location(offset);
    const InstanceIndex instance = record.valid() ? instance_of(record) : InstanceIndex();
    if (instance.valid()) where.entity = ids[instance.value];
    return where;
}

}  // namespace lyr::part21
