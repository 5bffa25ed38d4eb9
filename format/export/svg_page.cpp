// From the top: title, drawing, scale bar, legend. All sizes are multiples of the text's height.

#include "format/export/svg_page.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "format/export/svg.h"
#include "format/export/svg_text.h"

namespace lyr::format {
namespace {

// The text's height is this share of the drawing's longer side, within limits (mm).
constexpr double text_share = 1.0 / 42, least_text_mm = 0.25, most_text_mm = 12;
// Around the drawing there is room for the width of its strands.
constexpr double least_margin_mm = 1;
// In heights: mean advance of a letter of a sans serif type, and the width that a title needs.
constexpr double letter_advance = 0.56, least_page_width = 26;
// So many rows of the legend are always there, so that pictures of layers are of one size.
constexpr std::size_t least_legend_rows = 2;
constexpr double legend_row = 1.7, swatch = 1.6, title_room = 3.6, scale_room = 2.4;

double text_height_mm(const PageFrame& frame) {
    const double longer =
        std::max(frame.high_x_mm - frame.low_x_mm, frame.high_y_mm - frame.low_y_mm);
    return std::clamp(longer * text_share, least_text_mm, most_text_mm);
}

std::string number(double value) {
    std::string text;
    append_number(text, std::round(value * 1e4) / 1e4);
    return text;
}

std::string length_text(double length_mm) {
    char text[40];
    if (length_mm < 1000)
        std::snprintf(text, sizeof text, "%.1f mm", length_mm);
    else
        std::snprintf(text, sizeof text, "%.2f m", length_mm / 1e3);
    return text;
}

class Page {
public:
    Page(const PageFrame& frame, const PageContent& content)
        : content_(content), text_(text_height_mm(frame)) {
        const double margin = std::max(text_, least_margin_mm);
        left_ = frame.low_x_mm - margin;
        width_ = std::max(frame.high_x_mm + margin - left_, least_page_width * text_);
        top_ = -frame.high_y_mm - margin - title_room * text_;
        scale_y_ = -frame.low_y_mm + margin;
        place_legend();
        const std::size_t rows = std::max(least_legend_rows, rows_);
        height_ = scale_y_ + (scale_room + static_cast<double>(rows) * legend_row) * text_ - top_;
    }

    std::string text() {
        append_head();
        append_title();
        out_ += content_.drawing;
        append_scale();
        append_legend();
        return out_ + "</svg>\n";
    }

private:
    struct Place {
        double x = 0;
        std::size_t row = 0;
    };

    std::string label(const LegendEntry& entry) const {
        return entry.name + "  " + length_text(entry.length_mm);
    }

    // Entries stand side by side as long as there is room.
    void place_legend() {
        double x = 0;
        for (const LegendEntry& entry : content_.legend) {
            const double letters = static_cast<double>(label(entry).size());
            const double wide = (swatch + 2 + letters * letter_advance) * text_;
            if (x > 0 && x + wide > width_ - text_) {
                x = 0;
                ++rows_;
            }
            places_.push_back({x, rows_});
            x += wide;
        }
        ++rows_;
    }

    void append_head() {
        out_ +=
            "<svg xmlns=\"http://www.w3.org/2000/svg\" "
            "xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"" +
            number(width_) + "mm\" height=\"" + number(height_) + "mm\" viewBox=\"" +
            number(left_) + ' ' + number(top_) + ' ' + number(width_) + ' ' + number(height_) +
            "\" font-family=\"Helvetica, Arial, sans-serif\" font-size=\"" + number(text_) +
            "\" fill=\"#22262a\">\n<title>" + title() + "</title>\n<rect x=\"" + number(left_) +
            "\" y=\"" + number(top_) + "\" width=\"" + number(width_) + "\" height=\"" +
            number(height_) + "\" fill=\"#ffffff\"/>\n";
    }

    std::string title() const {
        char z[64];
        std::snprintf(z, sizeof z, "z = %.3f mm", content_.shown.state.z_mm);
        std::string text = "Layer " + std::to_string(std::uint64_t{content_.layer} + 1);
        if (content_.header.summary.layers > 0)
            text += " of " + std::to_string(content_.header.summary.layers);
        return text + ", " + z;
    }

    std::string subtitle() const {
        std::string text = escaped_xml(content_.name);
        if (!text.empty()) text += ", ";
        return text + number(content_.shown.state.height_mm) + " mm thick";
    }

    void append_text(double x, double y, const std::string& text, const std::string& style = {}) {
        out_ += "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\"" + style + '>' + text +
                "</text>\n";
    }

    void append_title() {
        const double x = left_ + text_;
        append_text(x, top_ + 1.8 * text_, title(),
                    " font-weight=\"bold\" font-size=\"" + number(1.3 * text_) + '"');
        append_text(x, top_ + 3.1 * text_, subtitle(), " fill=\"#5c646c\"");
    }

    // The longest of 1, 2, 5, 10, ... mm within a quarter of the width.
    double scale_length_mm() const {
        const double room = width_ / 4, decade = std::pow(10, std::floor(std::log10(room)));
        return decade * (room >= 5 * decade ? 5 : room >= 2 * decade ? 2 : 1);
    }

    void append_scale() {
        const double length = scale_length_mm(), x = left_ + text_, y = scale_y_ + text_;
        const double tick = 0.4 * text_;
        out_ += "<path d=\"M" + number(x) + ' ' + number(y - tick) + 'V' + number(y + tick) + 'M' +
                number(x) + ' ' + number(y) + 'H' + number(x + length) + 'M' + number(x + length) +
                ' ' + number(y - tick) + 'V' + number(y + tick) +
                "\" fill=\"none\" stroke=\"#22262a\" stroke-width=\"" + number(text_ / 8) +
                "\"/>\n";
        append_text(x + length + 0.6 * text_, y + 0.35 * text_, number(length) + " mm");
    }

    void append_legend() {
        for (std::size_t i = 0; i < places_.size(); ++i) {
            const LegendEntry& entry = content_.legend[i];
            const double x = left_ + text_ + places_[i].x;
            const double row = static_cast<double>(places_[i].row) + 0.5;
            const double y = scale_y_ + (scale_room + row * legend_row) * text_;
            const double from = x + 0.3 * text_, to = x + (swatch - 0.3) * text_;
            const std::string line = "<path d=\"M" + number(from) + ' ' + number(y) + 'H' +
                                     number(to) + "\" fill=\"none\" stroke=\"";
            if (entry.dashed) {
                out_ += line + entry.color + "\" stroke-width=\"" + number(0.12 * text_) +
                        "\" stroke-dasharray=\"" + number(0.3 * text_) + "\"/>\n";
            } else {
                const std::string cap = "\" stroke-linecap=\"round\"/>\n";
                out_ +=
                    line + darker(entry.color) + "\" stroke-width=\"" + number(0.6 * text_) + cap;
                out_ += line + entry.color + "\" stroke-width=\"" + number(0.42 * text_) + cap;
            }
            append_text(x + (swatch + 0.4) * text_, y + 0.35 * text_, label(entry));
        }
    }

    const PageContent& content_;
    double text_;
    double left_ = 0, top_ = 0, width_ = 0, height_ = 0, scale_y_ = 0;
    std::vector<Place> places_;
    std::size_t rows_ = 0;
    std::string out_;
};

}  // namespace

std::string darker(std::string_view color) {
    constexpr double kept = 0.62;
    std::string out = "#";
    for (std::size_t i = 1; i + 1 < color.size(); i += 2) {
        const int value = std::stoi(std::string(color.substr(i, 2)), nullptr, 16);
        char text[8];
        std::snprintf(text, sizeof text, "%02x", static_cast<unsigned>(kept * value) & 0xffu);
        out += text;
    }
    return out;
}

std::string_view color_of(Role role) {
    constexpr std::array<std::string_view, role_count> colors{
        "#8a8f94", "#e2641f", "#f2b134", "#8e44ad", "#c08552", "#9aa0a6", "#4f8fc4",
        "#6dbfb8", "#d64f6a", "#7b6cc0", "#2e9e6b", "#66b88f", "#ef9fb0", "#9bb84a",
        "#62892b", "#7f8c8d", "#b8a68c", "#8d7b68", "#5d7380"};
    const auto index = static_cast<std::size_t>(role);
    return colors[index < colors.size() ? index : 0];
}

double thin_line_mm(const PageFrame& frame) {
    return text_height_mm(frame) / 25;
}

std::string page_head(const PageFrame& frame, const std::string& title) {
    const double margin = text_height_mm(frame);
    const auto text = [](double value) {
        std::string out;
        append_number(out, value);
        return out;
    };
    const std::string width = text(frame.high_x_mm - frame.low_x_mm + 2 * margin);
    const std::string height = text(frame.high_y_mm - frame.low_y_mm + 2 * margin);
    const std::string left = text(frame.low_x_mm - margin), top = text(-frame.high_y_mm - margin);
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" "
           "xmlns:xlink=\"http://www.w3.org/1999/xlink\" "
           "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" width=\"" +
           width + "mm\" height=\"" + height + "mm\" viewBox=\"" + left + ' ' + top + ' ' + width +
           ' ' + height + "\">\n<title>" + title + "</title>\n<rect x=\"" + left + "\" y=\"" + top +
           "\" width=\"" + width + "\" height=\"" + height + "\" fill=\"#ffffff\"/>\n";
}

std::string page_text(const PageFrame& frame, const PageContent& content) {
    return Page(frame, content).text();
}

}  // namespace lyr::format
