// The sheet around a drawing: its frame in mm, a title, a scale bar and a legend. Everything on it
// is as large as the frame asks for, so that a ring of 5 mm and a bed of 300 mm read alike.

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "format/operation.h"
#include "format/reader.h"

namespace lyr::format {

struct PageFrame {
    double low_x_mm = 0, low_y_mm = 0, high_x_mm = 0, high_y_mm = 0;
};

struct LegendEntry {
    std::string name, color;
    double length_mm = 0;
    bool dashed = false;
};

struct PageContent {
    std::uint32_t layer = 0;  // from 0
    const FileHeader& header;
    const Layer& shown;
    std::string name;  // of what is shown
    std::vector<LegendEntry> legend;
    std::string drawing;  // SVG elements, y already pointing down
};

inline constexpr std::string_view travel_color = "#3a3f44", wipe_color = "#c0392b";

// "#rrggbb" towards black.
std::string darker(std::string_view color);

// Of what has no width of its own.
double thin_line_mm(const PageFrame& frame);

// The beginning of a picture without title and legend, which "</svg>" ends. `title` is XML already.
std::string page_head(const PageFrame& frame, const std::string& title);

std::string page_text(const PageFrame& frame, const PageContent& content);

}  // namespace lyr::format
