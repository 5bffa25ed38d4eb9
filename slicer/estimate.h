// How long a print takes and what it lays down, by the planner that the printer itself runs.
//
// Contract
//  1. A layer's operations are taken from its bytes, as the printer reads them, and planned within the printer's
//     limits. Waiting for heaters is not counted: it depends on the room.
//  2. A layer is planned by itself, from its start to its end and at rest at both. The way to its start, from where the
//     layer before ended, is added when layers follow each other, and belongs to the layer that it leads to.
//  3. The times of the roles, of travel and of standing still add up to the print's.

#pragma once

#include <array>
#include <cstdint>

#include "format/writer.h"
#include "target/config/printer.h"
#include "target/moves/move_maker.h"

namespace lyr::slicer {

struct RoleEstimate {
    double length_mm = 0, volume_mm3 = 0, time_s = 0;
};

struct Estimate {
    std::array<RoleEstimate, format::role_count> roles{};
    double travel_mm = 0;
    double travel_time_s = 0;  // retraction and rests included

    double time_s() const;
    Estimate& operator+=(const Estimate& other);
};

struct LayerEstimate {
    Estimate estimate;
    moves::Head end;  // where it leaves the machine
};

// `file_diameter_mm`: of the filament, as the file states it.
class Estimator {
public:
    Estimator(const config::Printer& printer, double file_diameter_mm);

    // `index` from 0. Errors (status machine): the printer cannot do a move; (internal): bytes that are no layer.
    Result<LayerEstimate> layer(const format::EncodedLayer& layer, std::uint32_t index) const;

    // The way from `from` to the layer's start.
    Result<Estimate> approach(const moves::Head& from, const format::EncodedLayer& layer,
                              std::uint32_t index) const;

    moves::Head start() const { return moves::head_at_start(printer_); }

private:
    config::Printer printer_;
    double diameter_mm_;
};

}  // namespace lyr::slicer
