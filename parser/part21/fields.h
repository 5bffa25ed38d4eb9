// The arguments of a record read one after the other, with one test for errors at the end.
//
//     part21::Fields fields(file, instance, 3);               // CIRCLE(name, position, radius)
//     const InstanceIndex position = fields.reference(1);
//     const double radius_file_units = fields.real(2);
//     if (!fields.ok()) return fields.error();
//
// Contract
//  1. The first error stays: after it every accessor gives an empty value (0, false, "", not
//     valid()).
//  2. Errors are those of Value; too few or too many arguments are one ("expected 3 arguments,
//     found 2").
//  3. Arguments count from 0 here as in Arguments, from 1 in messages.

#pragma once

#include <optional>

#include "parser/part21/part21.h"

namespace lyr::part21 {

class Fields {
public:
    Fields(const File& file, RecordIndex record, std::size_t count);
    Fields(const File& file, InstanceIndex instance, std::size_t count);  // of its only record

    bool ok() const { return !error_; }
    const Diagnostic& error() const { return *error_; }  // only when !ok()
    // An error of the caller's own, kept if it is the first.
    void fail(Diagnostic error);

    Value value(std::size_t index) const;
    double real(std::size_t index);
    std::int64_t integer(std::size_t index);
    bool boolean(std::size_t index);
    Logical logical(std::size_t index);
    Name enumeration(std::size_t index);
    std::string string(std::size_t index);
    InstanceIndex reference(std::size_t index);
    InstanceIndex optional_reference(std::size_t index);  // not valid() for $ and *
    std::vector<double> reals(std::size_t index);
    std::vector<std::int64_t> integers(std::size_t index);
    std::vector<InstanceIndex> references(std::size_t index);
    List list(std::size_t index);

private:
    void take(const Result<Arguments>& arguments, std::size_t count);
    template <class T>
    T keep(std::size_t index, Result<T> (Value::*convert)() const, T otherwise);
    template <class T>
    std::vector<T> collect(std::size_t index, Status (Value::*append)(std::vector<T>&) const);

    Arguments arguments_;
    std::optional<Diagnostic> error_;
};

}  // namespace lyr::part21
