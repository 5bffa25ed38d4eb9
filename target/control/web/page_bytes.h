// The page as one HTML file, compressed by gzip. Made at build time of page.html and what it needs of the viewer.

#pragma once

#include <string_view>

namespace lyr::control {

std::string_view page_bytes();

}  // namespace lyr::control
