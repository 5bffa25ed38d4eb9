// The arguments of a record: checked once as a whole, then read by position.

#include <algorithm>

#include "parser/part21/scan.h"
#include "parser/part21/table.h"
#include "parser/part21/walk.h"

namespace lyr::part21 {

Result<Arguments> Table::arguments(RecordIndex record) const {
    Arguments arguments;
    arguments.table_ = this;
    arguments.record_ = record;
    arguments.start_ = record_places[record.value];
    const RecordCheck check = check_record(at(arguments.start_), end(), arguments.places_);
    if (check.fault) {
        std::string message(keywords.text(record_keywords[record.value]));
        if (check.count > 0) message += " argument " + std::to_string(check.count);
        message += ": expected " + check.expected + ", found " + found_at(check.fault, end());
        return Diagnostic{Severity::error, ExitStatus::input, std::move(message),
                          location(offset_of(check.fault), record)};
    }
    arguments.count_ = check.count;
    arguments.end_ = offset_of(check.closing);
    return arguments;
}

Value Arguments::operator[](std::size_t index) const {
    if (index >= count_) return Value::missing(table_, end_, record_, index + 1);
    const char* p = table_->at(start_ + places_[std::min(index, direct - 1)]);
    for (std::size_t i = direct - 1; i < index; ++i) p = next_value(p, table_->end());
    return Value(table_, table_->offset_of(p), record_, index + 1);
}

List::Iterator Arguments::begin() const {
    if (count_ == 0) return {};
    const Value first = (*this)[0];
    return List::Iterator(first, table_->at(first.offset_), 1, 1);
}

Status Arguments::expect_count(std::size_t expected) const {
    if (count_ == expected) return Done{};
    const auto number = [](std::size_t count) {
        return std::to_string(count) + (count == 1 ? " argument" : " arguments");
    };
    return Diagnostic{Severity::error, ExitStatus::input,
                      std::string(table_->keywords.text(table_->record_keywords[record_.value])) +
                          ": expected " + number(expected) + ", found " + std::to_string(count_),
                      table_->location(start_, record_)};
}

}  // namespace lyr::part21
