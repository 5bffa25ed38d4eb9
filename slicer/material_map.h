// Where in a layer too little or too much is laid down: what its section asks for, and what strands lay, summed up around
// every place.
//
// Cost: what is asked for in rows of samples, and what is laid, its length in samples.

#pragma once

#include <cstddef>
#include <vector>

#include "kernel/region/curve.h"
#include "kernel/toolpath/hatch_runs.h"
#include "kernel/toolpath/strand.h"

namespace lyr::slicer {

class MaterialMap {
public:
    // Runs are as wide as that.
    MaterialMap(const region::Box2& box, double run_width_mm);

    // What has a share of -1 is taken away again.
    void ask_for(Region region, double share);
    // So much of the width is not laid, as neighbours lap over it.
    void lay(const Strand& strand, double lapped_mm, double flow);
    void lay(const HatchRun& run, double lapped_mm, double flow);

    // Where the most is missing, or the most is too much.
    Point2 most_missing() const { return most(1); }
    Point2 most_surplus() const { return most(-1); }

private:
    double& missing_at(const Point2& point);
    void lay_line(const Point2& from, const Segment& segment, double laid_mm);
    Point2 most(double sign) const;

    double run_width_mm_, edge_mm_;
    Point2 corner_;
    std::size_t columns_, rows_;
    std::vector<double> missing_mm2_;  // of squares one beside the other
};

}  // namespace lyr::slicer
