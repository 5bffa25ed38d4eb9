// How far from the middle a curve gets: what a delta's arms must reach.
//
// Contract
//  1. farthest_mm() is the largest distance in x and y from the middle of the bed on the curve, between its
//     ends too.
//  2. check_reach() is an error (status machine) with layer and distance where a delta's reach_mm does not
//     suffice; other machines have no reach.

#pragma once

#include <string>

#include "target/config/printer.h"
#include "target/run/path_check.h"

namespace lyr::run {

double farthest_mm(const PathCurve& curve);

Status check_reach(const PathCurve& curve, const std::string& path, const config::Printer& printer);

}  // namespace lyr::run
