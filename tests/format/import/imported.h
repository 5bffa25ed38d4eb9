// What comes of G-code, for tests of the import.

#pragma once

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "../files.h"
#include "format/import/gcode_import.h"

namespace lyr::format::test {

struct GivenOperation {
    Operation operation{};
    Layer layer{};
    PathStyle style{};
};

struct Imported {
    FileHeader header{};
    std::vector<Layer> layers{};
    std::vector<GivenOperation> operations{};
    Diagnostics diagnostics{};

    template <class T>
    std::vector<T> all() const {
        std::vector<T> found;
        for (const GivenOperation& given : operations)
            if (const T* one = std::get_if<T>(&given.operation)) found.push_back(*one);
        return found;
    }
    double volume_mm3() const {
        double sum = 0;
        for (const Layer& layer : layers) sum += layer.totals.volume_mm3;
        return sum;
    }
};

inline Imported read_print(const std::string& path) {
    Imported print;
    auto reader = Reader::open(path);
    REQUIRE_MESSAGE(reader.ok(), to_string(reader.error()));
    print.header = reader->header();
    while (const Operation* operation = reader->read()) {
        if (std::holds_alternative<LayerStart>(*operation)) print.layers.push_back(reader->layer());
        print.operations.push_back({*operation, reader->layer(), reader->path()});
    }
    REQUIRE(!reader->error());
    return print;
}

inline Imported imported(const std::string& text) {
    const std::string path = scratch("imported");
    Diagnostics diagnostics;
    const auto totals = import_gcode(text, "a.gcode", "a.gcode", path, {}, diagnostics);
    REQUIRE_MESSAGE(totals.ok(), to_string(totals.error()));
    Imported print = read_print(path);
    print.diagnostics = diagnostics;
    return print;
}

}  // namespace lyr::format::test
