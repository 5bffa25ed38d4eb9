// Where a file name leads: through links, to a file that need not be there yet, or to an open descriptor.

#pragma once

#include <optional>
#include <string>

namespace lyr {

struct FilePlace {
    std::string path;  // its folder without links; itself no link, except in /proc
    int descriptor =
        -1;  // if the name is that of one of this process (/dev/stdout, /dev/fd/3), its number
};

// None: the links lead in a circle. A folder that is missing is not an error here: opening the path will be.
std::optional<FilePlace> place_of(const std::string& path);

// Whether what is written to one name is what the other names: one file, through whatever links, or one that neither
// has yet. Nothing is ever found in /dev/null, so that it is not the same as itself.
bool same_file(const std::string& a, const std::string& b);

// A terminal or a socket: what is written to it does not meet what is read from it.
bool is_two_way(const std::string& path);

// A file that can be read twice.
bool is_regular_file(const std::string& path);

}  // namespace lyr
