// Decodes every argument of every instance of a file, for tests that feed the reader whatever there
// is.

#pragma once

#include <cmath>
#include <cstdint>

#include "parser/part21/part21.h"

namespace lyr::part21 {

struct Decoded {
    std::size_t records = 0, values = 0, references = 0, strings = 0, reals = 0;
    double sum_of_reals = 0;
    std::size_t deepest = 0;
    std::size_t errors = 0;
    Diagnostics first_errors;  // at most 100, of all kinds

    bool operator==(const Decoded& other) const {
        return records == other.records && values == other.values && strings == other.strings &&
               references == other.references && reals == other.reals && deepest == other.deepest &&
               sum_of_reals == other.sum_of_reals && errors == other.errors;
    }
};

class DecodeAll {
public:
    explicit DecodeAll(const File& file) : file_(file) {}

    Decoded run() {
        for (std::size_t i = 0; i < file_.instance_count(); ++i) {
            const InstanceIndex instance(i);
            for (std::size_t r = 0; r < file_.record_count(instance); ++r) {
                record(file_.record(instance, r));
            }
        }
        return std::move(decoded_);
    }

private:
    void record(RecordIndex record) {
        ++decoded_.records;
        const Result<Arguments> arguments = file_.arguments(record);
        if (!arguments) return error(arguments.error());
        for (const Value& argument : *arguments) value(argument, 1);
    }

    void value(const Value& value, std::size_t depth) {
        ++decoded_.values;
        decoded_.deepest = std::max(decoded_.deepest, depth);
        switch (value.kind()) {
            case Kind::unset:
            case Kind::derived:
                return;
            case Kind::integer:
                check(value.as_integer());
                return;
            case Kind::real:
                real(value);
                return;
            case Kind::string:
                ++decoded_.strings;
                check(value.as_string());
                return;
            case Kind::binary:
                check(value.as_binary());
                return;
            case Kind::enumeration:
                check(value.as_enumeration());
                return;
            case Kind::value_reference:
            case Kind::constant:
            case Kind::reference:
                ++decoded_.references;
                check(value.as_reference());
                return;
            case Kind::list: {
                const Result<List> list = value.as_list();
                for (const Value& member : *list) this->value(member, depth + 1);
                return;
            }
            case Kind::typed:
                this->value(value.as_typed()->value, depth + 1);
                return;
        }
    }

    void real(const Value& value) {
        ++decoded_.reals;
        const Result<double> number = value.as_real();
        check(number);
        if (number && std::isfinite(*number)) decoded_.sum_of_reals += *number;
    }

    template <class T>
    void check(const Result<T>& result) {
        if (!result) error(result.error());
    }

    void error(const Diagnostic& diagnostic) {
        ++decoded_.errors;
        if (decoded_.first_errors.size() < 100) decoded_.first_errors.push_back(diagnostic);
    }

    const File& file_;
    Decoded decoded_;
};

inline Decoded decode_all(const File& file) {
    return DecodeAll(file).run();
}

}  // namespace lyr::part21
