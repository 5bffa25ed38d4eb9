// See fields.h.

#include "parser/part21/fields.h"

namespace lyr::part21 {

Fields::Fields(const File& file, RecordIndex record, std::size_t count) {
    take(file.arguments(record), count);
}

Fields::Fields(const File& file, InstanceIndex instance, std::size_t count) {
    take(file.arguments(instance), count);
}

void Fields::take(const Result<Arguments>& arguments, std::size_t count) {
    if (!arguments) return fail(arguments.error());
    arguments_ = *arguments;
    if (const Status status = arguments_.expect_count(count); !status) fail(status.error());
}

void Fields::fail(Diagnostic error) {
    if (!error_) error_ = std::move(error);
}

// After an error there may be no arguments to look into.
Value Fields::value(std::size_t index) const {
    return error_ ? Value() : arguments_[index];
}

template <class T>
T Fields::keep(std::size_t index, Result<T> (Value::*convert)() const, T otherwise) {
    if (error_) return otherwise;
    Result<T> result = (arguments_[index].*convert)();
    if (result) return std::move(*result);
    error_ = result.error();
    return otherwise;
}

template <class T>
std::vector<T> Fields::collect(std::size_t index, Status (Value::*append)(std::vector<T>&) const) {
    std::vector<T> values;
    if (error_) return values;
    if (const Status status = (arguments_[index].*append)(values); !status) {
        error_ = status.error();
        values.clear();
    }
    return values;
}

double Fields::real(std::size_t index) {
    return keep(index, &Value::as_real, 0.0);
}

std::int64_t Fields::integer(std::size_t index) {
    return keep(index, &Value::as_integer, std::int64_t{0});
}

bool Fields::boolean(std::size_t index) {
    return keep(index, &Value::as_boolean, false);
}

Logical Fields::logical(std::size_t index) {
    return keep(index, &Value::as_logical, Logical::unknown);
}

Name Fields::enumeration(std::size_t index) {
    return keep(index, &Value::as_enumeration, Name{});
}

std::string Fields::string(std::size_t index) {
    return keep(index, &Value::as_string, std::string());
}

InstanceIndex Fields::reference(std::size_t index) {
    return keep(index, &Value::as_reference, InstanceIndex());
}

InstanceIndex Fields::optional_reference(std::size_t index) {
    if (error_) return {};
    const Value value = arguments_[index];
    const bool given = index >= arguments_.count() || (!value.is_unset() && !value.is_derived());
    return given ? reference(index) : InstanceIndex();
}

std::vector<double> Fields::reals(std::size_t index) {
    return collect(index, &Value::append_reals);
}

std::vector<std::int64_t> Fields::integers(std::size_t index) {
    return collect(index, &Value::append_integers);
}

std::vector<InstanceIndex> Fields::references(std::size_t index) {
    return collect(index, &Value::append_references);
}

List Fields::list(std::size_t index) {
    return keep(index, &Value::as_list, List());
}

}  // namespace lyr::part21
