// The path that a .lyr file describes, as curves in the machine's own axes, for checking what was made
// of it. Reads the file by itself and shares no code with the interpreter that feeds the planner: the
// circle of an arc is drawn through its three points here, and the filament is added up here.
//
// Contract
//  1. Curves follow each other without gaps from `start_mm` on; motions of no length are left out.
//  2. The extruder's coordinate is the length of filament fed since the start, less what is drawn back.
//  3. When next() has returned false, totals() and demands() are those of the whole file.

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "format/reader.h"
#include "target/run/path_check.h"

namespace lyr::run {

struct PathTotals {
    double extruded_mm = 0;  // of the head's way
    double travelled_mm = 0;
    double filament_mm = 0;  // fed for extrusion, retraction not counted
    std::uint32_t layers = 0;
    std::uint64_t motions = 0;
};

// What the file asks of the machine beside motion.
struct Demands {
    std::vector<format::HeaterTarget> hottest;  // each heater with a target above 0, once
    std::vector<std::uint32_t> fans;            // each fan that is ever on, once
    std::uint32_t highest_tool = 0;
    std::uint32_t pauses = 0;
    // The lowest temperature that the tool is sure to have where filament is pushed: that of the last wait, or of a
    // lower target since. None: no filament is.
    std::optional<double> coldest_extrusion_c;
    std::uint32_t coldest_layer = 0;           // from 1
    std::optional<std::uint32_t> still_layer;  // from 1: the first with a path whose speed is 0
};

class FilePath {
public:
    FilePath(format::Reader reader, const std::array<double, 3>& start_mm,
             double filament_diameter_mm);

    // The filament is drawn back so far, and not as the first layer has it. Before the first next().
    void begin_drawn_back(double mm) { begins_drawn_back_mm_ = mm; }

    // The next curve, or false at the end; then `curve` is as it was.
    Result<bool> next(PathCurve& curve);
    const PathTotals& totals() const { return totals_; }
    const Demands& demands() const { return demands_; }

private:
    void visit(const format::LayerStart& layer);
    void visit(const format::Line& line);
    void visit(const format::Arc& arc);
    void visit(const format::Circle& circle);
    void visit(const format::Travel& travel);
    void visit(const format::Retract& retract);
    void visit(const format::Wipe& wipe);
    void visit(const format::Temperature& temperature);
    void visit(const format::Fan& fan);
    void visit(const format::Tool& tool);
    void visit(const format::Pause& pause);
    template <class Other>
    void visit(const Other&) {}

    AxisValues position(const format::Point& point) const;
    // The circle through an arc's ends and its middle.
    PathCurve bent(const format::Point& from, const format::Point& to, std::int64_t sagitta) const;
    void draw_back(double depth_mm);
    void straight(const AxisValues& to_mm, bool extrudes);
    void turn(PathCurve curve, const format::Point& to);
    void append(const PathCurve& curve);
    // Filament is pushed at the temperature that the tool has now.
    void note_pushing();
    // Sets the extruder's end for a curve of this length.
    void extrude(PathCurve& curve, double way_mm);
    // The extruder's coordinate after this much more; compensated summation, so that hundreds of
    // thousands of roundings do not add up to parts of a step.
    double fed_mm(double feed_mm);

    format::Reader reader_;
    format::Quantum quantum_;
    double filament_area_mm2_;
    AxisValues at_mm_{};
    double feed_error_mm_ = 0;
    double drawn_back_mm_ = 0;
    std::optional<double> begins_drawn_back_mm_;
    bool first_layer_ = true;
    double sure_tool_c_ = 0;
    PathTotals totals_;
    Demands demands_;
    std::array<PathCurve, 4> waiting_;  // one operation makes no more
    std::size_t waiting_from_ = 0, waiting_to_ = 0;
};

}  // namespace lyr::run
