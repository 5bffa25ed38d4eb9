// Each pass has a descriptor of its own, with a place of its own in the file. That it leads to the file of the first is
// told by device and number, that nobody has written there by length and time.

#include "target/run/print_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace lyr::run {
namespace {

Diagnostic unreadable(const std::string& path) {
    return {Severity::error,
            ExitStatus::input,
            std::string("cannot read: ") + std::strerror(errno),
            {.file = path}};
}

}  // namespace

Result<PrintFile> PrintFile::open(const std::string& path) {
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    struct stat found {};
    if (descriptor < 0) return unreadable(path);
    PrintFile file(path, descriptor, found);
    if (::fstat(descriptor, &file.found_) != 0) return unreadable(path);
    return file;
}

PrintFile::PrintFile(PrintFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      found_(other.found_) {}

PrintFile::~PrintFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

Result<format::Reader> PrintFile::reader(std::uint32_t first_layer) const {
    const int descriptor = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) return unreadable(path_);
    if (const Status same = check(descriptor); !same) {
        ::close(descriptor);
        return same.error();
    }
    Result<format::Reader> reader = format::Reader::from_descriptor(
        descriptor, path_, {.keep_thumbnails = false, .keep_configuration = false});
    if (!reader || first_layer == 0) return reader;
    if (const Status sought = reader->seek_layer(first_layer); !sought) return sought.error();
    return reader;
}

Status PrintFile::check() const {
    return check(descriptor_);
}

Status PrintFile::check(int descriptor) const {
    struct stat now {};
    if (::fstat(descriptor, &now) == 0 && now.st_dev == found_.st_dev &&
        now.st_ino == found_.st_ino && now.st_size == found_.st_size &&
        now.st_mtim.tv_sec == found_.st_mtim.tv_sec &&
        now.st_mtim.tv_nsec == found_.st_mtim.tv_nsec)
        return Done{};
    return Diagnostic{Severity::error,
                      ExitStatus::input,
                      "the file was changed after it was inspected: print it anew",
                      {.file = path_}};
}

}  // namespace lyr::run
