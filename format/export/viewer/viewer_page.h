// A print as one HTML page that shows it: the file itself in base64, and the scripts of this folder, which read and draw it.
//
// Contract
//  1. The page needs nothing else: it opens from a disk, without a network, and its policy forbids all requests.
//  2. What it draws comes from the file's operations, read by its own reader (bytes.js to decode.js).
//  3. The same file gives the same page, byte by byte.
//  4. The print is held in memory once, whole; its page is handed out in pieces.

#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "base/diagnostic.h"

namespace lyr::format {

// Browsers hold no text of more than half a gigabyte, and the page is 4/3 of the print.
inline constexpr std::size_t largest_shown_bytes = 300'000'000;

// The page of the print in `path` ("-": standard input). The file was found whole before the first piece is handed out.
// Errors: the reader's; input (more than largest_shown_bytes).
Status write_viewer(const std::string& path,
                    const std::function<void(std::string_view piece)>& write);

}  // namespace lyr::format
