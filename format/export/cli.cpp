#include "format/export/cli.h"

#include <optional>
#include <string>

#include "base/text.h"
#include "format/export/fixed_point.h"
#include "format/export/polylines.h"

namespace lyr::format {
namespace {

constexpr double usual_tolerance_mm = 0.005;
constexpr int decimals = 4;

std::string number(double value, int digits = decimals) {
    std::string text;
    append_rounded(text, value, digits);
    return text;
}

int model_of(Role role) {
    switch (role) {
        case Role::support:
        case Role::support_interface:
        case Role::raft:
            return 2;
        case Role::skirt:
        case Role::brim:
        case Role::prime_tower:
            return 3;
        default:
            return 1;
    }
}

// Commas and slashes mean something here.
std::string label(std::string text) {
    for (char& c : text)
        if (c == ',' || c == '/' || c == '$') c = '_';
    return escaped(text);
}

std::string head(const FileHeader& header, double tolerance_mm) {
    const Summary& sum = header.summary;
    const std::string name = label(header.metadata.source_name);
    return "$$HEADERSTART\n$$ASCII\n$$UNITS/1.000000\n$$VERSION/200\n$$LABEL/1," +
           (name.empty() ? "part" : name) + "\n$$LABEL/2,support\n$$LABEL/3,around\n$$DIMENSION/" +
           number(sum.low_x_mm) + ',' + number(sum.low_y_mm) + ',' + number(sum.low_z_mm) + ',' +
           number(sum.high_x_mm) + ',' + number(sum.high_y_mm) + ',' + number(sum.high_z_mm) +
           "\n$$LAYERS/" + std::to_string(sum.layers) + "\n// arcs are chords within " +
           number(tolerance_mm, 6) +
           " mm //\n// polylines and hatches are the middles of strands; widths, speeds, amounts, "
           "temperatures and objects are left out //\n$$HEADEREND\n$$GEOMETRYSTART\n";
}

void append(std::string& out, const Polyline& line) {
    const std::string model = std::to_string(model_of(line.role));
    if (line.hatch) {
        out += "$$HATCHES/" + model + ',' + std::to_string(line.points.size() / 2);
    } else {
        const int direction = !line.closed ? 2 : area_mm2(line.points) > 0 ? 1 : 0;
        out += "$$POLYLINE/" + model + ',' + std::to_string(direction) + ',' +
               std::to_string(line.points.size() + (line.closed ? 1 : 0));
    }
    const auto point = [&](const PlanePoint& p) {
        out += ',';
        append_rounded(out, p[0], decimals);
        out += ',';
        append_rounded(out, p[1], decimals);
    };
    for (const PlanePoint& p : line.points) point(p);
    if (line.closed) point(line.points.front());
    out += '\n';
}

}  // namespace

double chord_tolerance_mm(const Metadata& metadata) {
    return metadata.tolerance_mm > 0 ? metadata.tolerance_mm : usual_tolerance_mm;
}

Status write_cli(Reader& reader, const Sink& sink, Diagnostics& diagnostics) {
    const double tolerance_mm = chord_tolerance_mm(reader.header().metadata);
    sink(head(reader.header(), tolerance_mm));
    PolylineCollector collector(reader.header().quantum, tolerance_mm);
    const auto end_layer = [&] {
        std::string text;
        for (const Polyline& line : collector.finish()) append(text, line);
        sink(text);
    };
    while (const Operation* operation = reader.read()) {
        if (std::holds_alternative<LayerStart>(*operation)) {
            end_layer();
            sink("$$LAYER/" + number(reader.layer().state.z_mm) + '\n');
        }
        collector.take(*operation, reader.path());
    }
    if (reader.error()) return *reader.error();
    end_layer();
    sink("$$GEOMETRYEND\n");
    diagnostics.push_back({Severity::note,
                           ExitStatus::ok,
                           "CLI has no arcs: they are chords within " + number(tolerance_mm, 6) +
                               " mm; widths, speeds, amounts and temperatures are left out",
                           {}});
    return Done{};
}

}  // namespace lyr::format
