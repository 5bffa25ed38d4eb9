// One pass over the operations. What a layer states is compared with what the machine was told last, so that a print from
// the first layer on has no command twice.

#include "format/export/gcode.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "format/export/fixed_point.h"
#include "format/export/gcode_frame.h"
#include "format/export/gcode_motion.h"
#include "format/export/gcode_progress.h"
#include "format/export/gcode_roles.h"

namespace lyr::format {
namespace {

constexpr std::size_t piece_bytes = std::size_t{1} << 16;

double distance_mm(const Point& a, const Point& b, Quantum quantum) {
    return quantum.mm(1) * std::hypot(static_cast<double>(b.x - a.x),
                                      static_cast<double>(b.y - a.y),
                                      static_cast<double>(b.z - a.z));
}

class Export {
public:
    Export(const Reader& reader, const GcodeOptions& options, Diagnostics& diagnostics)
        : reader_(reader),
          options_(options),
          diagnostics_(diagnostics),
          quantum_(reader.header().quantum),
          motion_(options, quantum_, out_),
          progress_(reader.header().summary) {
        const double diameter_mm = reader.header().metadata.filament_diameter_mm;
        filament_mm2_ = std::numbers::pi / 4 * diameter_mm * diameter_mm;
    }

    void take(const Operation& operation) {
        std::visit([&](const auto& one) { count(one); }, operation);
    }
    Status begin() {
        const auto head = gcode_head(reader_, options_);
        if (!head) return head.error();
        out_ += *head;
        first_ = reader_.layer();
        temperatures_ = first_.state.temperatures;
        tool_ = first_.state.tool;
        return Done{};
    }
    Status end() {
        label_object(0);
        const auto foot =
            gcode_foot(reader_.header(), first_, height_mm_,
                       {.z_mm = quantum_.mm(at_.z), .tool = tool_, .chamber = chamber_}, options_);
        if (!foot) return foot.error();
        out_ += *foot;
        return Done{};
    }
    std::string& text() { return out_; }

private:
    const PathStyle& style() const { return reader_.path(); }

    void note(bool& noted, const std::string& message) {
        if (std::exchange(noted, true)) return;
        const int layer = static_cast<int>(reader_.layer().index) + 1;
        out_ += "; " + message + '\n';
        diagnostics_.push_back(
            {Severity::note, ExitStatus::ok, message + "; first here", {.layer = layer}});
    }

    void count(const LayerStart& start) {
        const Layer& layer = reader_.layer();
        const LayerState& state = layer.state;
        if (layer.index > 0 || height_mm_ == 0) height_mm_ = state.height_mm;
        out_ += ";LAYER_CHANGE\n;Z:";
        append_rounded(out_, state.z_mm, 4);
        out_ += "\n;HEIGHT:";
        append_rounded(out_, state.height_mm, 4);
        // Print servers learn the print's height from this one.
        out_ += "\n;BEFORE_LAYER_CHANGE\n;";
        append_rounded(out_, state.z_mm, 4);
        out_ += '\n';
        shown_ = {};
        shown_height_mm_ = state.height_mm;
        progress_.begin_layer(layer, out_);
        motion_.reset_filament();
        for (const HeaterTarget& target : state.temperatures)
            heat(target.heater, target.target_c, false);
        for (const Fan& fan : state.fans) count(fan);
        count(Tool{state.tool});
        label_object(state.object);
        retract_mm_s_ = state.retract_speed_mm_s;
        unretract_mm_s_ =
            state.unretract_speed_mm_s > 0 ? state.unretract_speed_mm_s : state.retract_speed_mm_s;
        travel_mm_s_ = state.travel_speed_mm_s;
        count(TravelAcceleration{state.travel_acceleration_mm_s2});
        draw_back(state.retracted_mm);
        const Point to = start.start;
        if (!std::exchange(placed_, true)) {
            motion_.begin_at(to, travel_mm_s_);
            at_ = to;
            return;
        }
        travel_to(to.z > at_.z ? Point{at_.x, at_.y, to.z} : Point{to.x, to.y, at_.z});
        travel_to(to);
    }

    void show_style() {
        const PathStyle& style = this->style();
        if (!shown_ || shown_->role != style.role) {
            out_ += ";TYPE:";
            out_ += gcode_name_of(style.role);
            out_ += '\n';
            if (role_of_gcode(gcode_name_of(style.role)) != style.role) {
                out_ += ";ROLE:";
                out_ += name_of(style.role);
                out_ += '\n';
            }
        }
        if (!shown_ || shown_->width_mm != style.width_mm) {
            out_ += ";WIDTH:";
            append_rounded(out_, style.width_mm, 4);
            out_ += '\n';
        }
        if (shown_height_mm_ != style.height_mm) {
            out_ += ";HEIGHT:";
            append_rounded(out_, style.height_mm, 4);
            out_ += '\n';
        }
        shown_ = style;
        shown_height_mm_ = style.height_mm;
    }

    // The filament for a motion of the current path.
    double extruded(double length_mm) {
        if (!shown_ || shown_->role != style().role || shown_->width_mm != style().width_mm ||
            shown_height_mm_ != style().height_mm)
            show_style();
        if (style().speed_mm_s == 0)
            note(noted_speed_, "a path leaves its speed to the machine: it keeps the last one");
        accelerate('P', style().acceleration_mm_s2);
        progress_.pass(length_mm, style().speed_mm_s, out_);
        return length_mm * cross_section_mm2(style()) / filament_mm2_;
    }

    void count(const PathStart&) {}
    void count(const Line& line) {
        const double filament_mm = extruded(distance_mm(line.from, line.to, quantum_));
        motion_.line(line.to, filament_mm, style().speed_mm_s);
        at_ = line.to;
    }
    void count(const Arc& arc) {
        const double length_mm = std::hypot(quantum_.mm(1) * arc_shape(arc).length(),
                                            quantum_.mm(arc.to.z - arc.from.z));
        const double filament_mm = extruded(length_mm);
        motion_.arc(arc, filament_mm, style().speed_mm_s);
        at_ = arc.to;
    }
    void count(const Circle& circle) {
        const Point center{circle.center_x, circle.center_y, circle.from.z};
        const double turn_mm = 2 * std::numbers::pi * distance_mm(center, circle.from, quantum_);
        const double filament_mm =
            extruded(std::hypot(turn_mm, quantum_.mm(circle.to.z - circle.from.z)));
        motion_.circle(circle, filament_mm, style().speed_mm_s);
        at_ = circle.to;
    }
    void count(const Travel& travel) { travel_to(travel.to); }

    void travel_to(const Point& to) {
        end_wipe();
        accelerate('T', travel_mm_s2_);
        progress_.pass(distance_mm(at_, to, quantum_), travel_mm_s_, out_);
        motion_.travel(to, travel_mm_s_);
        at_ = to;
    }

    // As fast as the filament allows, which is drawn back evenly.
    void count(const Wipe& wipe) {
        const Arc piece{wipe.from, wipe.to, wipe.sagitta};
        const double length_mm = wipe.sagitta == 0 ? distance_mm(wipe.from, wipe.to, quantum_)
                                                   : quantum_.mm(1) * arc_shape(piece).length();
        const bool is_last = wipe.left_mm - length_mm < quantum_.mm(1) / 2;
        const double share = is_last ? 1 : length_mm / wipe.left_mm;
        const double filament_mm = share * (drawn_back_mm_ - wipe.depth_mm);
        const double own_mm_s = filament_mm < 0 ? retract_mm_s_ : unretract_mm_s_;
        const double slowed_mm_s =
            filament_mm != 0 && own_mm_s > 0
                ? std::min(travel_mm_s_, own_mm_s * length_mm / std::abs(filament_mm))
                : travel_mm_s_;
        if (!std::exchange(wipes_, true)) out_ += ";WIPE_START\n";
        accelerate('T', travel_mm_s2_);
        progress_.pass(length_mm, slowed_mm_s, out_);
        if (wipe.sagitta == 0)
            motion_.line(wipe.to, filament_mm, slowed_mm_s);
        else
            motion_.arc(piece, filament_mm, slowed_mm_s);
        drawn_back_mm_ = is_last ? wipe.depth_mm : drawn_back_mm_ - filament_mm;
        at_ = wipe.to;
    }
    void end_wipe() {
        if (std::exchange(wipes_, false)) out_ += ";WIPE_END\n";
    }

    void draw_back(double depth_mm) {
        end_wipe();
        const double filament_mm = drawn_back_mm_ - depth_mm;
        motion_.push(filament_mm, filament_mm < 0 ? retract_mm_s_ : unretract_mm_s_);
        drawn_back_mm_ = depth_mm;
    }
    void count(const Retract& retract) { draw_back(retract.depth_mm); }

    void count(const HatchStart&) {}
    void count(const Width&) {}
    void count(const Speed&) {}
    void count(const Acceleration&) {}
    void count(const TravelSpeed& speed) { travel_mm_s_ = speed.speed_mm_s; }
    void count(const TravelAcceleration& acceleration) {
        travel_mm_s2_ = acceleration.acceleration_mm_s2;
    }

    // Marlin has one for printing and one for travels, Klipper one for all.
    void accelerate(char kind, double mm_s2) {
        const bool is_klipper = options_.flavor == GcodeFlavor::klipper;
        double& known = kind == 'P' || is_klipper ? known_mm_s2_ : known_travel_mm_s2_;
        if (mm_s2 == known) return;
        if (mm_s2 == 0) {
            note(noted_acceleration_,
                 "an acceleration is left to the machine behind one that is stated: it stays");
            return;
        }
        known = mm_s2;
        out_ += is_klipper ? "SET_VELOCITY_LIMIT ACCEL=" : std::string("M204 ") + kind;
        append_rounded(out_, mm_s2, 0);
        out_ += '\n';
    }

    void heat(const Heater& heater, double target_c, bool wait) {
        const auto known =
            std::find_if(temperatures_.begin(), temperatures_.end(),
                         [&](const HeaterTarget& target) { return target.heater == heater; });
        if (known != temperatures_.end() && known->target_c == target_c && !wait) return;
        // A list of what it was told, in which the later wins.
        Bounded<HeaterTarget, 16> told;
        for (const HeaterTarget& target : temperatures_)
            if (!(target.heater == heater)) told.push_back(target);
        told.push_back({heater, target_c});
        temperatures_ = told;
        chamber_ = chamber_ || heater.kind == HeaterKind::chamber;
        out_ += temperature_command(heater, target_c, wait);
    }
    void count(const Temperature& temperature) {
        heat(temperature.heater, temperature.target_c, temperature.wait);
    }

    void count(const Fan& fan) {
        const auto known = std::find_if(fans_.begin(), fans_.end(),
                                        [&](const Fan& other) { return other.fan == fan.fan; });
        if (known != fans_.end() && known->duty == fan.duty) return;
        if (known != fans_.end())
            known->duty = fan.duty;
        else
            fans_.push_back(fan);
        const bool is_klipper = options_.flavor == GcodeFlavor::klipper;
        if (fan.fan > 0 && is_klipper) {
            out_ += "SET_FAN_SPEED FAN=fan" + std::to_string(fan.fan) + " SPEED=";
            append_rounded(out_, fan.duty, 3);
        } else {
            out_ += fan.duty > 0 ? "M106" : "M107";
            if (fan.fan > 0) out_ += " P" + std::to_string(fan.fan);
            if (fan.duty > 0) {
                out_ += " S";
                append_rounded(out_, fan.duty * full_fan, 1);
            }
        }
        out_ += '\n';
    }

    void count(const Dwell& dwell) { out_ += "G4 P" + std::to_string(dwell.time_ms) + '\n'; }
    void count(const Tool& tool) {
        if (tool.tool == tool_) return;
        tool_ = tool.tool;
        out_ += 'T' + std::to_string(tool_) + '\n';
    }
    void count(const Pause& pause) {
        const bool is_klipper = options_.flavor == GcodeFlavor::klipper;
        if (pause.reason == PauseReason::filament_change)
            out_ += "M600\n";
        else
            out_ += is_klipper ? "PAUSE\n" : "M0\n";
    }

    void count(const Object& object) { label_object(object.object); }
    void label_object(std::uint32_t object) {
        if (object == object_) return;
        const Metadata& data = reader_.header().metadata;
        if (options_.flavor == GcodeFlavor::marlin) {
            out_ += "M486 S" + (object > 0 ? std::to_string(object - 1) : "-1") + '\n';
        } else {
            if (object_ > 0)
                out_ += "EXCLUDE_OBJECT_END NAME=" + object_label(data, object_) + '\n';
            if (object > 0)
                out_ += "EXCLUDE_OBJECT_START NAME=" + object_label(data, object) + '\n';
        }
        object_ = object;
    }

    static constexpr double full_fan = 255;

    const Reader& reader_;
    const GcodeOptions& options_;
    Diagnostics& diagnostics_;
    Quantum quantum_;
    std::string out_;
    GcodeMotion motion_;
    GcodeProgress progress_;
    double filament_mm2_ = 0;
    Layer first_;
    double height_mm_ = 0;  // of a layer, not of the first if there are others
    Point at_{};
    // What the machine was told last, and what its next travels need.
    std::optional<PathStyle> shown_;
    double shown_height_mm_ = 0;
    double drawn_back_mm_ = 0;
    double retract_mm_s_ = 0, unretract_mm_s_ = 0, travel_mm_s_ = 0, travel_mm_s2_ = 0;
    double known_mm_s2_ = 0, known_travel_mm_s2_ = 0;
    Bounded<HeaterTarget, 16> temperatures_;
    std::vector<Fan> fans_;
    std::uint32_t tool_ = 0, object_ = 0;
    bool placed_ = false, chamber_ = false, wipes_ = false;
    bool noted_speed_ = false, noted_acceleration_ = false;
};

}  // namespace

Status write_gcode(Reader& reader, const GcodeOptions& options, const Sink& sink,
                   Diagnostics& diagnostics) {
    Export text(reader, options, diagnostics);
    bool begun = false;
    while (const Operation* operation = reader.read()) {
        if (!std::exchange(begun, true))
            if (Status status = text.begin(); !status) return status;
        text.take(*operation);
        if (text.text().size() < piece_bytes) continue;
        sink(text.text());
        text.text().clear();
    }
    if (reader.error()) return *reader.error();
    if (!begun)
        return Diagnostic{Severity::error, ExitStatus::input, "the print has no layers", {}};
    if (Status status = text.end(); !status) return status;
    sink(text.text());
    return Done{};
}

}  // namespace lyr::format
