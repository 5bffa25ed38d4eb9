// Three files in a ZIP archive: what kinds of file there are, which is the model, and the model, layer by layer.

#include "format/export/slice_3mf.h"

#include <optional>
#include <string>

#include "base/text.h"
#include "format/export/cli.h"
#include "format/export/fixed_point.h"
#include "format/export/polylines.h"
#include "format/export/slice_outline.h"
#include "format/export/svg_text.h"
#include "format/export/zip.h"

namespace lyr::format {
namespace {

constexpr int decimals = 4;
constexpr double digit_mm = 1e-4;

constexpr std::string_view content_types =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">"
    "<Default Extension=\"rels\" "
    "ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>"
    "<Default Extension=\"model\" "
    "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>\n";
constexpr std::string_view relationships =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
    "<Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
    "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>\n";
constexpr std::string_view left_out =
    "fill, supports, open walls and all of extrusion are left out; the mesh is only a box";

std::string number(double value) {
    std::string text;
    append_rounded(text, value, decimals);
    return text;
}

std::string model_head(const FileHeader& header, double tolerance_mm, double bottom_mm) {
    const auto metadata = [](const std::string& name, const std::string& value) {
        return "<metadata name=\"" + name + "\">" + escaped_xml(value) + "</metadata>\n";
    };
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
           "<model unit=\"millimeter\" xml:lang=\"en-US\" "
           "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" "
           "xmlns:s=\"http://schemas.microsoft.com/3dmanufacturing/slice/2015/07\" "
           "requiredextensions=\"s\">\n" +
           metadata("Title", header.metadata.source_name) +
           metadata("Application", header.metadata.generator) +
           metadata("Description", "outlines of the layers, arcs as chords within " +
                                       shortest(tolerance_mm) + " mm; " + std::string(left_out)) +
           "<resources>\n<s:slicestack id=\"1\" zbottom=\"" + number(bottom_mm) + "\">\n";
}

// The eight corners of a box and its twelve triangles, which look outwards.
std::string box_mesh(const PlaneBox& box, double bottom_mm, double top_mm) {
    std::string text = "<mesh><vertices>";
    for (int corner = 0; corner < 8; ++corner)
        text += "<vertex x=\"" + number(corner & 1 ? box.high[0] : box.low[0]) + "\" y=\"" +
                number(corner & 2 ? box.high[1] : box.low[1]) + "\" z=\"" +
                number(corner & 4 ? top_mm : bottom_mm) + "\"/>";
    text += "</vertices><triangles>";
    constexpr int triangles[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                      {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                      {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    for (const auto& [a, b, c] : triangles)
        text += "<triangle v1=\"" + std::to_string(a) + "\" v2=\"" + std::to_string(b) +
                "\" v3=\"" + std::to_string(c) + "\"/>";
    return text + "</triangles></mesh>";
}

std::string slice(double top_mm, const std::vector<std::vector<PlanePoint>>& outline) {
    std::string text = "<s:slice ztop=\"" + number(top_mm) + '"';
    if (outline.empty()) return text + "/>\n";
    text += "><s:vertices>";
    for (const auto& polygon : outline)
        for (const PlanePoint& p : polygon)
            text += "<s:vertex x=\"" + number(p[0]) + "\" y=\"" + number(p[1]) + "\"/>";
    text += "</s:vertices>";
    std::size_t first = 0;
    for (const auto& polygon : outline) {
        text += "<s:polygon startv=\"" + std::to_string(first) + "\">";
        for (std::size_t i = 1; i <= polygon.size(); ++i)
            text += "<s:segment v2=\"" + std::to_string(first + i % polygon.size()) + "\"/>";
        text += "</s:polygon>";
        first += polygon.size();
    }
    return text + "</s:slice>\n";
}

class Slices {
public:
    Slices(const FileHeader& header, ZipWriter& zip)
        : header_(header),
          zip_(zip),
          tolerance_mm_(chord_tolerance_mm(header.metadata)),
          collector_(header.quantum, tolerance_mm_) {}

    Status begin_layer(const Layer& layer) {
        end_layer();
        const double top_mm = layer.state.z_mm;
        if (top_mm_ && top_mm <= *top_mm_)
            return Diagnostic{
                Severity::error,
                ExitStatus::unsupported,
                "3MF has one stack of slices, which rises; here parts are printed one "
                "after the other",
                {.layer = static_cast<int>(layer.index) + 1}};
        if (!top_mm_) {
            bottom_mm_ = std::max(0.0, top_mm - layer.state.height_mm);
            zip_.write(model_head(header_, tolerance_mm_, bottom_mm_));
        }
        top_mm_ = top_mm;
        return Done{};
    }
    void take(const Operation& operation, const PathStyle& style) {
        if (style.role == Role::outer_wall || style.role == Role::overhang_wall ||
            style.role == Role::thin_wall)
            collector_.take(operation, style);
    }
    void end() {
        end_layer();
        zip_.write("</s:slicestack>\n<object id=\"2\" type=\"model\" name=\"" +
                   escaped_xml(header_.metadata.source_name) +
                   "\" s:meshresolution=\"lowres\" s:slicestackid=\"1\">" +
                   box_mesh(box_, bottom_mm_, top_mm_.value_or(0)) +
                   "</object>\n</resources>\n<build><item objectid=\"2\"/></build>\n</model>\n");
    }
    std::size_t open_walls() const { return open_walls_; }
    double tolerance_mm() const { return tolerance_mm_; }
    bool has_layers() const { return top_mm_.has_value(); }
    bool has_polygons() const { return !box_.empty(); }

private:
    void end_layer() {
        if (!top_mm_) return;
        std::vector<Polyline> walls = collector_.finish();
        open_walls_ += static_cast<std::size_t>(
            std::erase_if(walls, [](const Polyline& wall) { return !wall.closed; }));
        const auto outline = outline_of(std::move(walls), digit_mm);
        for (const auto& polygon : outline)
            for (const PlanePoint& point : polygon) box_.add(point);
        zip_.write(slice(*top_mm_, outline));
    }

    const FileHeader& header_;
    ZipWriter& zip_;
    double tolerance_mm_;
    PolylineCollector collector_;
    std::optional<double> top_mm_;
    double bottom_mm_ = 0;
    std::size_t open_walls_ = 0;
    PlaneBox box_;
};

}  // namespace

Status write_slice_3mf(Reader& reader, const Sink& sink, Diagnostics& diagnostics) {
    ZipWriter zip(sink);
    zip.begin_file("[Content_Types].xml");
    zip.write(content_types);
    zip.begin_file("_rels/.rels");
    zip.write(relationships);
    zip.begin_file("3D/3dmodel.model");
    Slices slices(reader.header(), zip);
    while (const Operation* operation = reader.read()) {
        if (std::holds_alternative<LayerStart>(*operation))
            if (Status begun = slices.begin_layer(reader.layer()); !begun) return begun;
        slices.take(*operation, reader.path());
    }
    if (reader.error()) return *reader.error();
    if (!slices.has_layers())
        return Diagnostic{Severity::error, ExitStatus::input, "the print has no layers", {}};
    slices.end();
    if (!slices.has_polygons())
        return Diagnostic{Severity::error,
                          ExitStatus::unsupported,
                          "3MF slices are outlines, and the print has none: no outer wall of it is "
                          "a closed ring",
                          {}};
    diagnostics.push_back({Severity::note,
                           ExitStatus::ok,
                           "3MF slices are outlines, arcs as chords within " +
                               shortest(slices.tolerance_mm()) + " mm; " + std::string(left_out),
                           {}});
    if (slices.open_walls() > 0)
        diagnostics.push_back({Severity::warning,
                               ExitStatus::ok,
                               counted(slices.open_walls(), "wall") +
                                   " that are no rings have no place in 3MF slices",
                               {}});
    return zip.finish();
}

}  // namespace lyr::format
