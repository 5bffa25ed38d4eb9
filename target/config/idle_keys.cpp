// A table of keys, of whether they are idle in this printer, and of what they would need.

#include "target/config/idle_keys.h"

namespace lyr::config {
namespace {

struct Idle {
    std::string key;
    bool idle;
    std::string why;
};

void append_shapers(const Given& given, std::vector<Idle>& keys) {
    for (std::size_t i = axis_x; i <= axis_z; ++i) {
        const std::string path = "shaper." + std::string(axis_names[i]);
        keys.push_back({path, !given(path + ".kind"),
                        "without " + path + ".kind; `kind = \"none\"` switches it off"});
    }
}

void append_endstops(const Printer& printer, bool has_probe, std::vector<Idle>& keys) {
    for (std::size_t i = 0; i < printer.endstops.size(); ++i) {
        const std::string axis = "axis." + std::string(axis_names[i]) + '.';
        const bool by_probe = i == axis_z && has_probe && printer.kinematics != Kinematics::delta;
        for (const char* key :
             {"endstop_end", "endstop_mm", "home_speed_mm_s", "home_slow_mm_s", "home_back_off_mm"})
            keys.push_back(
                {axis + key, !printer.endstops[i].input,
                 "without " + axis + "endstop" + (by_probe ? "; z is homed as [probe] says" : "")});
    }
}

void append_homing(const Printer& printer, bool has_probe, std::vector<Idle>& keys) {
    bool has_contact = has_probe;
    for (const Endstop& endstop : printer.endstops) has_contact = has_contact || endstop.input;
    const auto append = [&](const char* key) {
        keys.push_back({key, !has_contact, "without an endstop or probe.input"});
    };
    for (const char* key : {"homing.order", "homing.lift_mm", "homing.margin_mm",
                            "homing.tolerance_mm", "homing.settle_ms"})
        append(key);
    if (printer.homing.before_print) append("homing.before_print");
    for (const char* key : {"homing.order", "homing.lift_mm"})
        keys.push_back({key, printer.kinematics == Kinematics::delta,
                        "on a delta, which homes all towers at once and upwards"});
}

void append_probe_and_bed(const Printer& printer, bool has_probe, std::vector<Idle>& keys) {
    keys.push_back({"probe", !has_probe, "without probe.input"});
    for (const char* key : {"simulate.probe_noise_mm", "simulate.probe_offset_mm"})
        keys.push_back({key, !has_probe, "without probe.input"});
    for (const char* key : {"mesh.area_mm", "mesh.points", "mesh.fade_mm"})
        keys.push_back({key, !has_probe && printer.mesh.heights_mm.empty(),
                        "without probe.input, to measure the bed by, or mesh.heights_mm"});
    for (const char* key : {"simulate.arm_error_mm", "simulate.radius_error_mm",
                            "simulate.angle_error_deg", "simulate.endstop_error_mm"})
        keys.push_back({key, printer.kinematics != Kinematics::delta, "but on a delta"});
}

void append_channels(const Printer& printer, std::vector<Idle>& keys) {
    const auto append = [&](const std::string& section, const std::string& pwm) {
        keys.push_back({section + ".cycle_s", !pwm.empty(),
                        "beside " + section + ".pwm, whose folder has a period of its own"});
    };
    for (std::size_t i = 0; i < heater_count; ++i)
        if (const auto& heater = printer.heaters[i])
            append("heater." + std::string(heater_names[i]), heater->pwm);
    if (const auto& fan = printer.part_fan) append("fan.part", fan->pwm);
}

}  // namespace

Problems idle_problems(const Printer& printer, const Given& given) {
    const bool has_probe = printer.probe && printer.probe->input;
    std::vector<Idle> keys{
        {"pressure_advance.smooth_s", !given("pressure_advance.advance_s"),
         "without pressure_advance.advance_s"},
        {"timing.write_us", !printer.timing.late_ns, "without timing.late_us"},
        {"watchdog.timeout_s", printer.watchdog.device.empty(), "without watchdog.device"}};
    append_shapers(given, keys);
    append_endstops(printer, has_probe, keys);
    append_homing(printer, has_probe, keys);
    append_probe_and_bed(printer, has_probe, keys);
    append_channels(printer, keys);
    Problems problems;
    for (const Idle& key : keys)
        if (key.idle && given(key.key)) problems.emplace_back(key.key, ": does nothing " + key.why);
    return problems;
}

}  // namespace lyr::config
