// Links are followed one by one: realpath(3) knows neither files that are not there nor what a descriptor is.

#include "base/file_place.h"

#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <charconv>
#include <filesystem>

namespace lyr {
namespace {

namespace fs = std::filesystem;

// As many as Linux follows.
constexpr int most_links = 40;

// Linux's numbers of /dev/null.
constexpr unsigned null_major = 1, null_minor = 3;

using FileStatus = struct stat;

std::optional<FileStatus> status_of(const std::string& path) {
    FileStatus status{};
    if (::stat(path.c_str(), &status) != 0) return std::nullopt;
    return status;
}

bool is_null_device(const FileStatus& status) {
    return S_ISCHR(status.st_mode) && status.st_rdev == makedev(null_major, null_minor);
}

// The number that names a descriptor in this process's folder of them, or -1.
int own_descriptor(const fs::path& folder, const std::string& name) {
    if (folder != "/proc/" + std::to_string(::getpid()) + "/fd") return -1;
    int number = -1;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    return error == std::errc() && end == name.data() + name.size() ? number : -1;
}

}  // namespace

std::optional<FilePlace> place_of(const std::string& path) {
    fs::path place = path;
    for (int links = 0; links <= most_links; ++links) {
        std::error_code none;
        const fs::path parent = place.has_parent_path() ? place.parent_path() : fs::path(".");
        const fs::path folder = fs::canonical(parent, none);
        if (none) return FilePlace{place};
        place = folder / place.filename();
        // Links in /proc are more than their text: they open what has no name, too.
        if (place.string().starts_with("/proc/"))
            return FilePlace{place, own_descriptor(folder, place.filename())};
        const fs::path target = fs::read_symlink(place, none);
        if (none) return FilePlace{place};
        place = folder / target;
    }
    return std::nullopt;
}

bool same_file(const std::string& a, const std::string& b) {
    const auto status_a = status_of(a), status_b = status_of(b);
    if (status_a && status_b)
        return status_a->st_dev == status_b->st_dev && status_a->st_ino == status_b->st_ino &&
               !is_null_device(*status_a);
    if (status_a || status_b) return false;
    const auto place_a = place_of(a), place_b = place_of(b);
    return place_a && place_b && place_a->path == place_b->path;
}

bool is_two_way(const std::string& path) {
    const auto status = status_of(path);
    return status && (S_ISCHR(status->st_mode) || S_ISSOCK(status->st_mode));
}

bool is_regular_file(const std::string& path) {
    const auto status = status_of(path);
    return status && S_ISREG(status->st_mode);
}

}  // namespace lyr
