// The keys, section by section, with the field's names, ranges that no machine of this kind leaves, and a line of help.

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "profile/keys.h"
#include "profile/section.h"

namespace lyr::profile {
namespace {

using Names = std::span<const std::string_view>;

constexpr std::string_view degrees_also[] = {"\u00b0", "degrees"};
constexpr std::string_view celsius_also[] = {"C", "\u00b0C"};
constexpr std::string_view mm_s2_also[] = {"mm/s^2", "mm/s\u00b2"};
constexpr std::string_view mm2_also[] = {"mm^2", "mm\u00b2"};
constexpr std::string_view mm3_s_also[] = {"mm^3/s", "mm\u00b3/s"};
constexpr std::string_view g_cm3_also[] = {"g/cm^3", "g/cm\u00b3"};

constexpr Unit mm{"mm"}, mm_s{"mm/s"}, seconds{"s"}, plain{""};
constexpr Unit mm_s2{"mm/s2", mm_s2_also}, mm2{"mm2", mm2_also}, mm3_s{"mm3/s", mm3_s_also};
constexpr Unit degrees{"deg", degrees_also}, celsius{"deg C", celsius_also};
constexpr Unit g_cm3{"g/cm3", g_cm3_also};

constexpr Range height_mm{0.001, 10}, width_mm{0.01, 20}, angle_deg{-360, 360};
constexpr Range speed_mm_s{0.1, 2000}, acceleration_mm_s2{0, 1e6};
constexpr Range part{0, 1}, flow{0.1, 3};
constexpr Range heat_c{0, 500}, bed_c{0, 200};
constexpr Range layers{0, 100'000};
// As far as a printer's axes may reach (docs/configuration.md).
constexpr Range bed_mm{-10'000, 10'000};

constexpr std::string_view wall_names[] = {"inner", "outer"};
constexpr std::string_view seam_names[] = {"nearest", "rear", "aligned", "sharp"};
constexpr std::string_view corner_names[] = {"round", "mitre"};
constexpr std::string_view skin_names[] = {"rectilinear", "aligned", "concentric"};
constexpr std::string_view infill_names[] = {"rectilinear", "aligned",   "grid",   "triangles",
                                             "concentric",  "honeycomb", "gyroid", "cubic"};
constexpr std::string_view support_names[] = {"none", "grid", "tree"};
constexpr std::string_view adhesion_names[] = {"none", "skirt", "brim", "raft"};
constexpr std::string_view flavor_names[] = {"marlin", "klipper"};
constexpr std::string_view extrusion_names[] = {"relative", "absolute"};

// Lengths that follow from others are whole nanometres, so that 3/4 of 0.4 is 0.3.
double times(double length_mm, double factor) {
    return std::round(length_mm * factor * nm_per_mm) / nm_per_mm;
}

void add_nozzle(std::vector<Key>& keys) {
    Section(keys, "nozzle", &Profile::nozzle)
        .number("diameter", &Nozzle::diameter_mm, mm, {0.05, 10}, "Bore of the nozzle");
}

void add_filament(std::vector<Key>& keys) {
    Section(keys, "filament", &Profile::filament)
        .text("material", &Filament::material, "What it is made of, for people")
        .number("diameter", &Filament::diameter_mm, mm, {0.1, 10}, "Diameter of the filament")
        .number("density", &Filament::density_g_cm3, g_cm3, {0, 25},
                "For the print's mass; 0: not stated")
        .number("cost", &Filament::cost_per_kg, plain, {0, 1e6},
                "Price of a kilogram, in your currency; 0: not stated")
        .number("max_volumetric_speed", &Filament::max_volumetric_speed_mm3_s, mm3_s, {0, 1000},
                "Most that the hot end melts; speeds are lowered to it; 0: no limit")
        .fraction("flow", &Filament::flow, flow, "Extrusion multiplier of everything");
}

void add_layer(std::vector<Key>& keys) {
    Section(keys, "layer", &Profile::layer)
        .number("height", &Layer::height_mm, mm, height_mm, "Thickness of a layer")
        .number("first_height", &Layer::first_height_mm, mm, height_mm,
                "Thickness of the first layer")
        .otherwise("as layer.height",
                   [](Profile& p) { p.layer.first_height_mm = p.layer.height_mm; })
        .flag("adaptive", &Layer::adaptive,
              "Layers as thick as layer.cusp allows, which end on level faces")
        .number("cusp", &Layer::cusp_mm, mm, height_mm,
                "Adaptive layers: how deep the steps between them may be, across the surface")
        .number("min_height", &Layer::min_height_mm, mm, height_mm, "Adaptive layers: the thinnest")
        .otherwise("1/4 of nozzle.diameter",
                   [](Profile& p) { p.layer.min_height_mm = times(p.nozzle.diameter_mm, 0.25); })
        .number("max_height", &Layer::max_height_mm, mm, height_mm, "Adaptive layers: the thickest")
        .otherwise("3/4 of nozzle.diameter",
                   [](Profile& p) { p.layer.max_height_mm = times(p.nozzle.diameter_mm, 0.75); });
}

// Two walls side by side do not fit into what is narrower than 7/4 of their width (kernel/toolpath/walls.h): one line has to,
// as far as a nozzle lays it.
void set_max_width(Profile& p) {
    const double nozzle_mm = p.nozzle.diameter_mm;
    const double needed_mm = times(p.perimeters.width_mm, 1.75);
    p.perimeters.max_width_mm =
        std::max(times(nozzle_mm, 2), std::min({needed_mm, times(nozzle_mm, 3), width_mm.high}));
}

void add_perimeters(std::vector<Key>& keys) {
    Section(keys, "perimeters", &Profile::perimeters)
        .count("count", &Perimeters::count, {0, 1000}, "How many walls")
        .number("width", &Perimeters::width_mm, mm, width_mm, "Width of a wall's line")
        .otherwise("9/8 of nozzle.diameter",
                   [](Profile& p) { p.perimeters.width_mm = times(p.nozzle.diameter_mm, 1.125); })
        .choice("first", &Perimeters::first, Names(wall_names),
                "Which walls are printed first; outer is more exact, inner hangs over better")
        .fraction("overlap", &Perimeters::overlap, part,
                  "How much of their rounded flanks neighbouring lines share: 100% leaves no gap, "
                  "0% spaces them by their width")
        .flag("thin_walls", &Perimeters::thin_walls,
              "One line of varying width where two walls do not fit")
        .flag("gap_fill", &Perimeters::gap_fill, "Fill gaps between walls that no line fits into")
        .number("min_width", &Perimeters::min_width_mm, mm, width_mm,
                "Thinnest line that is printed for a thin wall")
        .otherwise("1/2 of nozzle.diameter",
                   [](Profile& p) { p.perimeters.min_width_mm = times(p.nozzle.diameter_mm, 0.5); })
        .number("min_gap", &Perimeters::min_gap_mm, mm, width_mm,
                "Narrowest gap between walls that is filled")
        .otherwise("1/4 of nozzle.diameter",
                   [](Profile& p) { p.perimeters.min_gap_mm = times(p.nozzle.diameter_mm, 0.25); })
        .number("max_width", &Perimeters::max_width_mm, mm, width_mm,
                "Widest line of thin walls and gap fill")
        .otherwise("2 x nozzle.diameter, or what perimeters.width asks for", set_max_width)
        .choice("seam", &Perimeters::seam, Names(seam_names),
                "Where walls begin: near the last one's end, at the rear, above each other, at "
                "sharp corners")
        .choice("corner", &Perimeters::corner, Names(corner_names), "What walls do around corners");
}

void add_fill(std::vector<Key>& keys) {
    Section(keys, "skin", &Profile::skin)
        .count("top_layers", &Skin::top_layers, layers, "Solid layers under upper surfaces")
        .count("bottom_layers", &Skin::bottom_layers, layers, "Solid layers over lower surfaces")
        .number("width", &Skin::width_mm, mm, width_mm, "Width of a line of solid fill")
        .otherwise("as perimeters.width",
                   [](Profile& p) { p.skin.width_mm = p.perimeters.width_mm; })
        .choice("pattern", &Skin::pattern, Names(skin_names),
                "Lines across each other, lines all along, or rings")
        .number("angle", &Skin::angle_deg, degrees, angle_deg,
                "Of the first layer's lines from the x axis, counter-clockwise")
        .number("min_area", &Skin::min_area_mm2, mm2, {0, 1e6},
                "Sparse fill of less than this is made solid");
    Section(keys, "infill", &Profile::infill)
        .fraction("density", &Infill::density, part, "Share of the inside that is filled")
        .choice("pattern", &Infill::pattern, Names(infill_names), "Of the sparse fill")
        .number("width", &Infill::width_mm, mm, width_mm, "Width of a line of sparse fill")
        .otherwise("as perimeters.width",
                   [](Profile& p) { p.infill.width_mm = p.perimeters.width_mm; })
        .number("angle", &Infill::angle_deg, degrees, angle_deg,
                "Of the first layer's lines from the x axis, counter-clockwise")
        .fraction("overlap", &Infill::overlap, part,
                  "How far fill reaches into the innermost wall, of the line's width");
    Section(keys, "bridge", &Profile::bridge)
        .flag("walls", &Bridge::walls, "Print walls as bridges where they run over air")
        .fraction("flow", &Bridge::flow, flow, "Extrusion multiplier of bridges")
        .fraction("fan", &Bridge::fan, part, "Duty of the part's fan on bridges");
}

void add_support(std::vector<Key>& keys) {
    Section(keys, "support", &Profile::support)
        .choice("kind", &Support::kind, Names(support_names), "What supports overhangs")
        .number("angle", &Support::angle_deg, degrees, {0, 90},
                "What leans out further than this from the vertical is supported")
        .number("gap_z", &Support::gap_z_mm, mm, {0, 10}, "Between support and the part over it")
        .number("gap_xy", &Support::gap_xy_mm, mm, {0, 10}, "Between support and the part's walls")
        .count("interface_layers", &Support::interface_layers, layers,
               "Dense layers where support meets the part")
        .fraction("density", &Support::density, part, "Share of the support that is filled")
        .flag("on_bed_only", &Support::on_bed_only, "No support that stands on the part")
        .list("blockers", &Support::blockers,
              "Faces that are not supported: their names in the STEP file, or #id");
    Section(keys, "adhesion", &Profile::adhesion)
        .choice("kind", &Adhesion::kind, Names(adhesion_names), "What is printed around the part")
        .count("skirt_loops", &Adhesion::skirt_loops, {1, 1000}, "How many loops a skirt has")
        .number("skirt_distance", &Adhesion::skirt_distance_mm, mm, {0, 1000},
                "From the part to the skirt")
        .number("brim_width", &Adhesion::brim_width_mm, mm, {0, 1000}, "Width of the brim")
        .count("raft_layers", &Adhesion::raft_layers, {1, 1000}, "How many layers a raft has")
        .number("raft_gap", &Adhesion::raft_gap_mm, mm, {0, 10}, "Between the raft and the part");
}

void add_speed(std::vector<Key>& keys) {
    Section(keys, "speed", &Profile::speed)
        .number("outer_wall", &Speed::outer_wall_mm_s, mm_s, speed_mm_s, "Outermost walls")
        .number("inner_wall", &Speed::inner_wall_mm_s, mm_s, speed_mm_s, "Walls within")
        .number("small", &Speed::small_mm_s, mm_s, speed_mm_s, "Walls shorter than 40 mm")
        .number("gap_fill", &Speed::gap_fill_mm_s, mm_s, speed_mm_s, "Thin walls and gap fill")
        .number("solid_infill", &Speed::solid_infill_mm_s, mm_s, speed_mm_s, "Solid fill")
        .number("sparse_infill", &Speed::sparse_infill_mm_s, mm_s, speed_mm_s, "Sparse fill")
        .number("top_skin", &Speed::top_skin_mm_s, mm_s, speed_mm_s, "The topmost solid layer")
        .number("bridge", &Speed::bridge_mm_s, mm_s, speed_mm_s, "Bridges")
        .number("support", &Speed::support_mm_s, mm_s, speed_mm_s, "Support")
        .number("first_layer", &Speed::first_layer_mm_s, mm_s, speed_mm_s,
                "The most at which anything of the first layer is printed")
        .number("travel", &Speed::travel_mm_s, mm_s, speed_mm_s, "Travel");
}

void add_acceleration(std::vector<Key>& keys) {
    Section section(keys, "acceleration", &Profile::acceleration);
    const auto add = [&](const char* name, double Acceleration::*field, const char* help) {
        section.number(name, field, mm_s2, acceleration_mm_s2, help);
    };
    add("outer_wall", &Acceleration::outer_wall_mm_s2, "Outermost walls; 0: the machine's own");
    add("inner_wall", &Acceleration::inner_wall_mm_s2, "Walls within; 0: the machine's own");
    add("solid_infill", &Acceleration::solid_infill_mm_s2, "Solid fill; 0: the machine's own");
    add("sparse_infill", &Acceleration::sparse_infill_mm_s2, "Sparse fill; 0: the machine's own");
    add("top_skin", &Acceleration::top_skin_mm_s2, "The topmost solid layer; 0: the machine's own");
    add("bridge", &Acceleration::bridge_mm_s2, "Bridges; 0: the machine's own");
    add("support", &Acceleration::support_mm_s2, "Support; 0: the machine's own");
    add("first_layer", &Acceleration::first_layer_mm_s2,
        "All of the first layer; 0: as on other layers");
    add("travel", &Acceleration::travel_mm_s2, "Travel; 0: the machine's own");
}

void add_travel(std::vector<Key>& keys) {
    Section(keys, "travel", &Profile::travel)
        .number("retract_length", &Travel::retract_length_mm, mm, {0, 20},
                "How far the filament is drawn back; 0: not at all")
        .number("retract_speed", &Travel::retract_speed_mm_s, mm_s, {0.1, 500}, "Drawing it back")
        .number("unretract_speed", &Travel::unretract_speed_mm_s, mm_s, {0.1, 500},
                "Pushing it forward again")
        .otherwise("as travel.retract_speed",
                   [](Profile& p) { p.travel.unretract_speed_mm_s = p.travel.retract_speed_mm_s; })
        .number("retract_min_travel", &Travel::retract_min_travel_mm, mm, {0, 1000},
                "Shorter travels do without")
        .number("retract_inside", &Travel::retract_inside_mm, mm, {0, 1e5},
                "Travels that stay inside the part retract from this length on; 0: none does")
        .number("wipe", &Travel::wipe_mm, mm, {0, 100},
                "How far the nozzle goes back along what it printed while it retracts; 0: not")
        .fraction(
            "retract_before_wipe", &Travel::retract_before_wipe, part,
            "How much of a retraction comes before the wipe; more where the wipe is too short "
            "for the rest")
        .number("z_hop", &Travel::z_hop_mm, mm, {0, 10},
                "How far the nozzle is raised where it retracts; 0: not")
        .flag("avoid_crossing", &Travel::avoid_crossing, "Travel around walls where that is near");
}

void add_heat(std::vector<Key>& keys) {
    Section(keys, "temperature", &Profile::temperature)
        .number("nozzle", &Temperature::nozzle_c, celsius, heat_c, "Nozzle; 0: off")
        .number("nozzle_first_layer", &Temperature::nozzle_first_layer_c, celsius, heat_c,
                "Nozzle on the first layer")
        .otherwise("as temperature.nozzle",
                   [](Profile& p) { p.temperature.nozzle_first_layer_c = p.temperature.nozzle_c; })
        .number("bed", &Temperature::bed_c, celsius, bed_c, "Bed; 0: off")
        .number("bed_first_layer", &Temperature::bed_first_layer_c, celsius, bed_c,
                "Bed on the first layer")
        .otherwise("as temperature.bed",
                   [](Profile& p) { p.temperature.bed_first_layer_c = p.temperature.bed_c; })
        .number("chamber", &Temperature::chamber_c, celsius, bed_c, "Chamber; 0: off");
    Section(keys, "fan", &Profile::fan)
        .fraction("min", &Fan::min, part, "Duty on layers that take long")
        .fraction("max", &Fan::max, part, "Duty on the quickest layers")
        .count("off_layers", &Fan::off_layers, layers, "So many first layers have it off")
        .number("ramp_time", &Fan::ramp_time_s, seconds, {0, 3600},
                "Quicker layers have more than fan.min")
        .number("min_layer_time", &Fan::min_layer_time_s, seconds, {0, 3600},
                "Quicker layers have fan.max and are slowed down to take so long; 0: not")
        .number("min_speed", &Fan::min_speed_mm_s, mm_s, speed_mm_s,
                "Nothing is slowed down further");
}

void add_plate(std::vector<Key>& keys) {
    Section(keys, "plate", &Profile::plate)
        .count("copies", &Plate::copies, {1, 10'000}, "How many of the part")
        .number("spacing", &Plate::spacing_mm, mm, {0, 1000}, "Between copies, or their brims")
        .flag("sequential", &Plate::sequential, "One copy after the other, not layer by layer")
        .number(
            "clearance_radius", &Plate::clearance_radius_mm, mm, {0, 1000},
            "Sequential: how far the head reaches around the nozzle; no copy is nearer to another")
        .number(
            "clearance_height", &Plate::clearance_height_mm, mm, {0, 10'000},
            "Sequential: height of the gantry over the nozzle; higher copies lie one behind the "
            "other")
        .point("at", &Plate::at_mm, mm, bed_mm, "Where the first copy's lower left corner lies")
        .point("size", &Plate::size_mm, mm, {0, bed_mm.high},
               "Size of the bed, on which all copies must lie; [0, 0]: not stated");
    Section(keys, "slicing", &Profile::slicing)
        .number("tolerance", &Slicing::tolerance_mm, mm, {1e-5, 1},
                "Greatest distance of the printed contour from the exact section");
}

void add_gcode(std::vector<Key>& keys) {
    Section(keys, "gcode", &Profile::gcode)
        .choice("flavor", &Gcode::flavor, Names(flavor_names), "The firmware that it is for")
        .choice("extrusion", &Gcode::extrusion, Names(extrusion_names),
                "Filament counted anew in each move, or from the layer's start")
        .list("start", &Gcode::start, "Lines before the print, with {placeholders}; []: built-in")
        .list("end", &Gcode::end, "Lines after the print; []: built-in");
}

std::vector<Key> make_keys() {
    std::vector<Key> keys;
    for (const auto add :
         {add_nozzle, add_filament, add_layer, add_perimeters, add_fill, add_support, add_speed,
          add_acceleration, add_travel, add_heat, add_plate, add_gcode})
        add(keys);
    return keys;
}

}  // namespace

const std::vector<Key>& keys() {
    static const std::vector<Key> table = make_keys();
    return table;
}

}  // namespace lyr::profile
