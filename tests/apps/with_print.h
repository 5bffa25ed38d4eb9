// A folder with a print.

#pragma once

#include <string>

#include "apps/program.h"
#include "target/run/print_files.h"

namespace lyr::tests {

// Of three layers, a.lyr.
inline Folder with_print(const std::string& name) {
    Folder folder(name);
    fs::copy_file(write_print(name, {draw_square, draw_arcs, draw_hatch}), folder / "a.lyr");
    return folder;
}

}  // namespace lyr::tests
