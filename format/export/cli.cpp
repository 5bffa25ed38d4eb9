#include "format/export/cli.h"

#include <algorithm>
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

// Commas and slashes mean something here. A letter that ASCII does not have becomes one sign, however many bytes it is.
std::string label(const std::string& text) {
    std::string out;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        const bool goes_on = (byte & 0xc0) == 0x80;
        if (c == ',' || c == '/' || c == '$')
            out += '_';
        else if (byte >= ' ' && byte <= '~')
            out += c;
        else if (!goes_on)
            out += '?';
    }
    return out;
}

// What is extruded, with its width and from its lowest layer's bottom on.
struct Extent {
    PlaneBox box;
    double bottom_mm = 0, top_mm = 0;

    void add(const Polyline& line) {
        for (const PlanePoint& p : line.points) box.add(p, line.width_mm / 2);
    }
};

std::string head(const FileHeader& header, const Extent& extent, std::uint32_t layers,
                 double tolerance_mm) {
    const PlanePoint low = extent.box.empty() ? PlanePoint{} : extent.box.low;
    const PlanePoint high = extent.box.empty() ? PlanePoint{} : extent.box.high;
    const std::string name = label(header.metadata.source_name);
    return "$$HEADERSTART\n$$ASCII\n$$UNITS/1.000000\n$$VERSION/200\n$$LABEL/1," +
           (name.empty() ? "part" : name) + "\n$$LABEL/2,support\n$$LABEL/3,around\n$$DIMENSION/" +
           number(low[0]) + ',' + number(low[1]) + ',' + number(extent.bottom_mm) + ',' +
           number(high[0]) + ',' + number(high[1]) + ',' + number(extent.top_mm) + "\n$$LAYERS/" +
           std::to_string(layers) + "\n// arcs are chords within " + number(tolerance_mm, 6) +
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
    PolylineCollector collector(reader.header().quantum, tolerance_mm);
    Extent extent;
    std::uint32_t layers = 0;
    std::string text;  // behind the head, which states the box of all of it
    const auto end_layer = [&] {
        for (const Polyline& line : collector.finish()) {
            append(text, line);
            extent.add(line);
        }
    };
    const auto begin_layer = [&](const LayerState& state) {
        const auto start = [&](double z_mm) {
            text += "$$LAYER/" + number(z_mm) + '\n';
            ++layers;
        };
        const double bottom_mm = std::max(0.0, state.z_mm - state.height_mm);
        if (layers == 0) {
            extent.bottom_mm = bottom_mm;
            start(bottom_mm);
        }
        extent.bottom_mm = std::min(extent.bottom_mm, bottom_mm);
        extent.top_mm = std::max(extent.top_mm, state.z_mm);
        start(state.z_mm);
    };
    while (const Operation* operation = reader.read()) {
        if (std::holds_alternative<LayerStart>(*operation)) {
            end_layer();
            begin_layer(reader.layer().state);
        }
        collector.take(*operation, reader.path());
    }
    if (reader.error()) return *reader.error();
    end_layer();
    sink(head(reader.header(), extent, layers, tolerance_mm));
    sink(text);
    sink("$$GEOMETRYEND\n");
    diagnostics.push_back({Severity::note,
                           ExitStatus::ok,
                           "CLI has no arcs: they are chords within " + number(tolerance_mm, 6) +
                               " mm; widths, speeds, amounts and temperatures are left out",
                           {}});
    return Done{};
}

}  // namespace lyr::format
