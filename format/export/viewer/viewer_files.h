// The sources of the page, as they are in this folder: page.html, viewer.css, then the scripts in their order.

#pragma once

#include <span>
#include <string_view>

namespace lyr::format {

struct ViewerFile {
    std::string_view name, text;
};

std::span<const ViewerFile> viewer_files();

}  // namespace lyr::format
