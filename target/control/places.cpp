#include "target/control/places.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace lyr::control {

std::vector<std::string> socket_folders() {
    std::vector<std::string> folders{machine_socket_folder};
    // Of the user who is logged in; where nobody is, as for a service, there is none.
    const char* own = std::getenv("XDG_RUNTIME_DIR");
    if (own && *own == '/') folders.push_back(std::string(own) + "/lyr");
    return folders;
}

std::vector<std::string> sockets() {
    std::vector<std::string> found;
    for (const std::string& folder : socket_folders()) {
        std::error_code error;
        for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
             entry.increment(error))
            if (entry->path().extension() == ".sock" && entry->is_socket(error))
                found.push_back(entry->path().string());
    }
    std::ranges::sort(found);
    return found;
}

}  // namespace lyr::control
