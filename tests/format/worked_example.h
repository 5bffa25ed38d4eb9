// The small print that docs/lyr-format.md takes apart byte by byte.

#pragma once

#include <string>

#include "format/writer.h"

namespace lyr::format::test {

inline Result<EncodedLayer> worked_layer(Quantum quantum) {
    LayerState state;
    state.z_mm = 0.2;
    state.height_mm = 0.2;
    state.start_x_mm = 10;
    state.start_y_mm = 10;
    state.retract_length_mm = 0.8;
    state.retract_speed_mm_s = 35;
    state.unretract_speed_mm_s = 25;
    state.temperatures.push_back({{HeaterKind::bed, 0}, 60});
    state.temperatures.push_back({{HeaterKind::tool, 0}, 210});
    state.fans.push_back({0, 0.5});
    LayerEncoder layer(quantum, state);
    PathStyle style;
    style.role = Role::outer_wall;
    style.width_mm = 0.45;
    style.height_mm = 0.2;
    style.speed_mm_s = 60;
    layer.begin_path(style);
    layer.line_to(20, 10);
    layer.arc_to(20, 20, 5);
    layer.line_to(10, 20);
    layer.line_to(10, 10);
    layer.retract();
    layer.travel_to(16, 15);
    layer.unretract();
    layer.circle(15, 15, true);
    layer.travel_to(10.4, 10.4);
    style.role = Role::inner_wall;
    layer.begin_path(style);
    layer.line_to(20, 10.4);
    layer.arc_to(20, 19.6, 4.6);
    layer.line_to(10.4, 19.6);
    layer.line_to(10.4, 10.4);
    layer.travel_to(13, 12);
    style.role = Role::other;
    layer.begin_path(style);
    layer.arc_to(15, 14, 0.586);
    layer.arc_to(13, 16, 0.586);
    layer.arc_to(11, 18, -0.586);
    style.role = Role::solid_infill;
    style.speed_mm_s = 80;
    layer.begin_path(style);
    const HatchRow rows[] = {{1, false}, {1, true}, {1, true}};
    const HatchInterval intervals[] = {{11, 19}, {11, 19}, {11.5, 18.5}};
    HatchRun run;
    run.offset_mm = 11;
    run.pitch_mm = 0.5;
    run.rows = rows;
    run.intervals = intervals;
    layer.hatch(run);
    return layer.finish();
}

inline Status write_worked_example(const std::string& path) {
    Metadata metadata;
    metadata.source_name = "plate.step";
    const Quantum quantum{1000};
    auto writer = Writer::create(path, quantum, metadata);
    if (!writer) return writer.error();
    const auto layer = worked_layer(quantum);
    if (!layer) return layer.error();
    if (Status appended = writer->append(*layer); !appended) return appended.error();
    const auto totals = writer->finish();
    if (!totals) return totals.error();
    return Done{};
}

}  // namespace lyr::format::test
