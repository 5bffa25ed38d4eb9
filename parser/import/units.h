// The units in which a representation states its lengths and angles.
//
// Contract
//  1. A length of the representation times length_mm is in millimetres, an angle times angle_rad in radians.
//  2. A degree given with few digits (0.01745329) is the degree.
//  3. A context without a length unit is taken to be in millimetres, with a warning; without an angle unit, in
//     radians. Each context is read, and warned about, once.

#pragma once

#include <optional>
#include <unordered_map>

#include "parser/import/entity.h"

namespace lyr::importer {

struct Units {
    double length_mm = 1;
    double angle_rad = 1;
    double uncertainty_mm = 0;  // 0: not stated
    int dimension =
        3;  // of points and directions; 2 within the parameters of a surface: read with z = 0
};

class UnitTable {
public:
    UnitTable(const File& file, Diagnostics& diagnostics);

    // `context`: the representation's context_of_items. Not valid(): of an item in no representation, which gets
    // the only context of the file that states units, if there is one only.
    Result<Units> of_context(InstanceIndex context);

private:
    enum class Quantity { length, angle, other };
    struct Unit {
        Quantity quantity;
        double factor;  // to millimetres or radians
    };

    Result<Units> read_context(InstanceIndex context);
    Status read_uncertainties(InstanceIndex context, Units& units);
    Result<Unit> read_unit(InstanceIndex unit);
    Result<Unit> read_si_unit(InstanceIndex unit);
    InstanceIndex only_context() const;

    const File* file_;
    Diagnostics* diagnostics_;
    part21::Trail trail_;
    std::unordered_map<std::uint32_t, Units> known_;
};

}  // namespace lyr::importer
