#include "target/run/printer_identity.h"

#include <span>

#include "format/crc32c.h"

namespace lyr::run {
namespace {

class Digest {
public:
    void add(std::string_view text) {
        // With its end: "a" and "b" are not "ab" and "".
        add_bytes(std::span(text.data(), text.size()));
        add(static_cast<double>(text.size()));
    }
    void add(double number) {
        const double plain = number + 0.0;  // of the two zeros the one
        add_bytes(std::span(&plain, 1));
    }
    template <std::size_t count>
    void add(const std::array<double, count>& numbers) {
        for (const double number : numbers) add(number);
    }
    void add(const std::optional<config::Pin>& pin) {
        if (!pin) return add("");
        add(pin->chip);
        if (const auto* name = std::get_if<std::string>(&pin->line))
            add(*name);
        else
            add(static_cast<double>(std::get<std::uint32_t>(pin->line)));
        add(pin->active_low ? 1.0 : 0.0);
    }
    std::uint32_t sum() const { return sum_; }

private:
    template <class Value>
    void add_bytes(std::span<const Value> values) {
        sum_ = format::crc32c(std::as_bytes(values), sum_);
    }

    std::uint32_t sum_ = 0;
};

void add_frame(const config::DeltaFrame& frame, Digest& digest) {
    digest.add(frame.arm_mm);
    digest.add(frame.radius_mm);
    digest.add(frame.tower_angle_deg);
    digest.add(frame.reach_mm);
}

void add_bed(const config::Printer& printer, Digest& digest) {
    const config::BedMesh& mesh = printer.mesh;
    if (mesh.heights_mm.empty()) return;
    digest.add(mesh.area_mm);
    digest.add(mesh.fade_mm);
    for (const std::vector<double>& row : mesh.heights_mm)
        for (const double height_mm : row) digest.add(height_mm);
    digest.add(printer.start_mm[config::axis_x]);
    digest.add(printer.start_mm[config::axis_y]);
}

}  // namespace

PrinterIdentity identity_of(const config::Printer& printer) {
    std::array<Digest, printer_parts.size()> digests;
    auto& [name, kinematics, lines, steps, ranges, bed] = digests;
    name.add(printer.name);
    kinematics.add(static_cast<double>(printer.kinematics));
    if (printer.kinematics == config::Kinematics::delta) add_frame(printer.delta, kinematics);
    for (std::size_t i = 0; i < config::axis_e; ++i) {
        const config::Axis& axis = printer.axes[i];
        lines.add(axis.step);
        lines.add(axis.direction);
        lines.add(axis.invert ? 1.0 : 0.0);
        steps.add(axis.steps_per_mm);
        ranges.add(axis.min_mm);
        ranges.add(axis.max_mm);
    }
    add_bed(printer, bed);
    PrinterIdentity identity;
    for (std::size_t i = 0; i < digests.size(); ++i) identity.parts[i] = digests[i].sum();
    return identity;
}

std::string difference(const PrinterIdentity& a, const PrinterIdentity& b) {
    std::string names;
    for (std::size_t i = 0; i < printer_parts.size(); ++i) {
        if (a.parts[i] == b.parts[i]) continue;
        names += names.empty() ? "" : ", ";
        names += printer_parts[i];
    }
    return names;
}

}  // namespace lyr::run
