// Layers of items as layers of a print. How a layer begins, that is where the head goes to first, shows only behind its
// first motions; those before belong to the layer below. So each layer waits for the next one. Private to this room.

#pragma once

#include <array>
#include <optional>
#include <vector>

#include "base/diagnostic.h"
#include "format/import/gcode_items.h"
#include "format/writer.h"

namespace lyr::format {

class GcodeLayers {
public:
    GcodeLayers(Writer& writer, Quantum quantum, double filament_diameter_mm);

    // The next one. What comes before the first that extrudes is taken for its state only. Errors: the writer's.
    Status add(GcodeLayer layer);
    // Behind the last.
    Status finish();

    // Filament of motions that round to none, or are too short for so much.
    double lost_filament_mm() const { return lost_filament_mm_; }
    // Retractions of one layer, of which a print has one speed, do.
    bool speeds_differ() const { return speeds_differ_; }
    // A heater or a fan that a layer's state has no room for.
    bool left_out() const { return left_out_; }

private:
    // What the machine is set to.
    struct Machine {
        Bounded<HeaterTarget, 16> temperatures{};
        std::vector<Fan> fans{};
        std::uint32_t tool = 0, object = 0;
        double drawn_back_mm = 0;
        double retract_mm_s = 0, unretract_mm_s = 0, retract_length_mm = 0;
    };
    // With its state known.
    struct Begun {
        LayerState state{};
        std::vector<GcodeItem> items{};
        PathStyle style{};
        double travel_mm_s = 0, travel_mm_s2 = 0;
        GcodePoint at{};
    };

    Begun begin(GcodeLayer layer);
    double layer_z_mm(const GcodeLayer& layer) const;
    std::vector<GcodeItem> begin_items(GcodeLayer& layer, double z_mm, LayerState& state);
    void note_speeds(const std::vector<GcodeItem>& items);
    void set(const Operation& operation);
    Status write(Begun layer);
    void encode(const GcodeItem& item, LayerEncoder& encoder, Begun& layer);
    void encode_extrusion(const GcodeGo& go, LayerEncoder& encoder, Begun& layer);
    void encode_arc(const GcodeGo& go, LayerEncoder& encoder);
    void encode_travel(const GcodeGo& go, LayerEncoder& encoder, Begun& layer);
    void encode_wipe(const GcodeGo& go, LayerEncoder& encoder, Begun& layer);
    void set_travel(const GcodeGo& go, LayerEncoder& encoder, Begun& layer);

    Writer& writer_;
    Quantum quantum_;
    double filament_area_mm2_;
    Machine machine_{};
    std::optional<Begun> waits_{};
    double below_z_mm_ = 0;
    double lost_filament_mm_ = 0;
    bool speeds_differ_ = false, left_out_ = false;
    std::vector<WipePiece> wipe_{};
    double wipe_depth_mm_ = 0;
    bool wiped_ = false;  // and not travelled since
};

}  // namespace lyr::format
