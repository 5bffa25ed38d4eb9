// Groups of two lines each, a code and a value. An arc of DXF always turns counter-clockwise from its first angle.

#include "format/export/dxf.h"

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "base/text.h"
#include "format/arc.h"
#include "format/export/svg_text.h"

namespace lyr::format {
namespace {

constexpr std::size_t piece_bytes = std::size_t{1} << 16;
constexpr double degrees_per_rad = 180 / std::numbers::pi;
constexpr int angle_digits = 12;

// AutoCAD's colour numbers, one for each role and 8, grey, for travels.
constexpr std::array<int, role_count> colors{7, 30, 40, 6,  32, 9,   5,  4,  1,  170,
                                             3, 94, 11, 62, 74, 252, 33, 35, 141};
constexpr int travel_color = 8;

std::string layer_name(const std::string& prefix, std::string_view role) {
    std::string name = prefix;
    for (const char c : role)
        name += c == ' ' ? '_' : static_cast<char>(c >= 'a' ? c - 'a' + 'A' : c);
    return name;
}

class Drawing {
public:
    Drawing(const FileHeader& header, const DxfOptions& options, const Sink& sink)
        : header_(header), options_(options), sink_(sink) {}

    void begin() {
        const Summary& sum = header_.summary;
        comment("unit: mm; made by lyrview from " + escaped(header_.metadata.source_name));
        comment("lines are the middles of what is extruded; their widths are not in a DXF");
        pair(0, "SECTION");
        pair(2, "HEADER");
        pair(9, "$ACADVER");
        pair(1, "AC1009");
        variable_point("$EXTMIN", sum.low_x_mm, sum.low_y_mm);
        variable_point("$EXTMAX", sum.high_x_mm, sum.high_y_mm);
        pair(0, "ENDSEC");
        tables();
        pair(0, "SECTION");
        pair(2, "ENTITIES");
    }
    void end() {
        pair(0, "ENDSEC");
        pair(0, "EOF");
        sink_(out_);
    }

    void begin_layer(const Layer& layer) {
        std::string z;
        append_number(z, layer.state.z_mm);
        comment("layer " + std::to_string(layer.index + 1) + ", z = " + z + " mm");
        if (!options_.layer) prefix_ = std::to_string(layer.index + 1) + '_';
    }
    void add(const Operation& operation, Role role) {
        if (const auto* line = std::get_if<Line>(&operation)) {
            add_line(name_of(role), line->from, line->to);
        } else if (const auto* arc = std::get_if<Arc>(&operation)) {
            add_arc(name_of(role), *arc);
        } else if (const auto* circle = std::get_if<Circle>(&operation)) {
            add_circle(name_of(role), *circle);
        } else if (const auto* travel = std::get_if<Travel>(&operation)) {
            if (options_.travels) add_line("TRAVEL", travel->from, travel->to);
        } else if (const auto* wipe = std::get_if<Wipe>(&operation)) {
            if (!options_.travels) return;
            if (wipe->sagitta == 0)
                add_line("TRAVEL", wipe->from, wipe->to);
            else
                add_arc("TRAVEL", Arc{wipe->from, wipe->to, wipe->sagitta});
        }
        if (out_.size() < piece_bytes) return;
        sink_(out_);
        out_.clear();
    }

private:
    void pair(int code, std::string_view value) {
        out_ += std::to_string(code);
        out_ += '\n';
        out_ += value;
        out_ += '\n';
    }
    void comment(const std::string& text) { pair(999, text); }
    void number(int code, double value) {
        std::string text;
        append_number(text, value);
        pair(code, text);
    }
    void angle(int code, double rad) {
        double degrees = rad * degrees_per_rad;
        while (degrees < 0) degrees += 360;
        while (degrees >= 360) degrees -= 360;
        std::array<char, 32> text{};
        std::snprintf(text.data(), text.size(), "%.*g", angle_digits, degrees);
        pair(code, text.data());
    }
    void quanta(int code, std::int64_t value) {
        std::string text;
        append_mm(text, value, header_.quantum);
        pair(code, text);
    }
    void variable_point(std::string_view name, double x, double y) {
        pair(9, name);
        number(10, x);
        number(20, y);
    }

    void table_layer(const std::string& name, int color) {
        pair(0, "LAYER");
        pair(2, name);
        pair(70, "0");
        pair(62, std::to_string(color));
        pair(6, "CONTINUOUS");
    }
    void tables() {
        pair(0, "SECTION");
        pair(2, "TABLES");
        pair(0, "TABLE");
        pair(2, "LTYPE");
        pair(70, "1");
        pair(0, "LTYPE");
        pair(2, "CONTINUOUS");
        pair(70, "0");
        pair(3, "Solid line");
        pair(72, "65");
        pair(73, "0");
        pair(40, "0");
        pair(0, "ENDTAB");
        pair(0, "TABLE");
        pair(2, "LAYER");
        const std::uint32_t layers = options_.layer ? 1 : header_.summary.layers;
        pair(70, std::to_string(layers * (role_count + 1)));
        for (std::uint32_t layer = 1; layer <= layers; ++layer) {
            const std::string prefix = options_.layer ? "" : std::to_string(layer) + '_';
            for (std::size_t role = 0; role < role_count; ++role)
                table_layer(layer_name(prefix, name_of(static_cast<Role>(role))), colors[role]);
            table_layer(prefix + "TRAVEL", travel_color);
        }
        pair(0, "ENDTAB");
        pair(0, "ENDSEC");
    }

    void begin_entity(const char* kind, std::string_view layer) {
        pair(0, kind);
        pair(8, layer_name(prefix_, layer));
    }
    void add_line(std::string_view layer, const Point& from, const Point& to) {
        if (from.x == to.x && from.y == to.y) return;
        begin_entity("LINE", layer);
        quanta(10, from.x);
        quanta(20, from.y);
        quanta(11, to.x);
        quanta(21, to.y);
    }
    void add_circle(std::string_view layer, const Circle& circle) {
        begin_entity("CIRCLE", layer);
        quanta(10, circle.center_x);
        quanta(20, circle.center_y);
        number(40, header_.quantum.mm(1) *
                       std::hypot(static_cast<double>(circle.from.x - circle.center_x),
                                  static_cast<double>(circle.from.y - circle.center_y)));
    }
    void add_arc(std::string_view layer, const Arc& arc) {
        const ArcShape shape = arc_shape(arc);
        const double end = shape.start_angle_rad + shape.sweep_rad;
        const double unit = header_.quantum.mm(1);
        begin_entity("ARC", layer);
        number(10, shape.center_x * unit);
        number(20, shape.center_y * unit);
        number(40, shape.radius * unit);
        angle(50, shape.sweep_rad > 0 ? shape.start_angle_rad : end);
        angle(51, shape.sweep_rad > 0 ? end : shape.start_angle_rad);
    }

    const FileHeader& header_;
    const DxfOptions& options_;
    const Sink& sink_;
    std::string prefix_, out_;
};

}  // namespace

Status write_dxf(Reader& reader, const DxfOptions& options, const Sink& sink) {
    if (options.layer)
        if (Status sought = reader.seek_layer(*options.layer); !sought) return sought;
    Drawing drawing(reader.header(), options, sink);
    drawing.begin();
    bool begun = false;
    while (const Operation* operation = reader.read()) {
        if (std::holds_alternative<LayerStart>(*operation)) {
            if (begun && options.layer) break;
            begun = true;
            drawing.begin_layer(reader.layer());
        }
        drawing.add(*operation, reader.path().role);
    }
    if (reader.error()) return *reader.error();
    drawing.end();
    return Done{};
}

}  // namespace lyr::format
