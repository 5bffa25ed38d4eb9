#include "format/check/file_view.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "format/bytes.h"
#include "format/crc32c.h"

namespace lyr::format {
namespace {

Diagnostic unreadable(const std::string& name, const std::string& why) {
    return {Severity::error, ExitStatus::input, "cannot read: " + why, {.file = name}};
}

}  // namespace

Result<FileView> FileView::open(const std::string& path) {
    FileView view{std::span<const std::byte>{}};
    view.name_ = path;
    view.descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    struct stat status {};
    if (view.descriptor_ < 0 || ::fstat(view.descriptor_, &status) != 0)
        return unreadable(path, std::strerror(errno));
    if (!S_ISREG(status.st_mode)) return unreadable(path, "it is no file");
    view.size_ = static_cast<std::uint64_t>(status.st_size);
    return view;
}

FileView::FileView(FileView&& other) noexcept
    : name_(std::move(other.name_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      window_(std::move(other.window_)),
      bytes_(other.bytes_),
      begin_(other.begin_),
      size_(other.size_),
      error_(std::move(other.error_)) {}

FileView::~FileView() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

std::span<const std::byte> FileView::at(std::uint64_t begin, std::size_t count) {
    begin = std::min(begin, size_);
    count = static_cast<std::size_t>(std::min<std::uint64_t>(count, size_ - begin));
    const bool here = begin >= begin_ && begin + count <= begin_ + bytes_.size();
    if (!here) read_window(begin, std::max(count, window_bytes));
    return bytes_.subspan(static_cast<std::size_t>(begin - begin_), count);
}

void FileView::read_window(std::uint64_t begin, std::size_t count) {
    count = static_cast<std::size_t>(std::min<std::uint64_t>(count, size_ - begin));
    window_.resize(count);
    std::size_t read = 0;
    while (read < count && !error_) {
        const ssize_t got = ::pread(descriptor_, window_.data() + read, count - read,
                                    static_cast<off_t>(begin + read));
        if (got > 0) read += static_cast<std::size_t>(got);
        if (got < 0 && errno != EINTR) error_ = unreadable(name_, std::strerror(errno));
        if (got == 0) error_ = unreadable(name_, "it became shorter while it was read");
    }
    std::fill(window_.begin() + static_cast<std::ptrdiff_t>(read), window_.end(), std::byte{0});
    bytes_ = window_;
    begin_ = begin;
}

std::uint32_t FileView::u32_at(std::uint64_t begin) {
    return get_u32(at(begin, 4).data());
}

std::uint32_t FileView::crc32c_of(std::uint64_t begin, std::uint64_t end) {
    std::uint32_t crc = 0;
    while (begin < end) {
        const auto count =
            static_cast<std::size_t>(std::min<std::uint64_t>(end - begin, window_bytes));
        crc = crc32c(at(begin, count), crc);
        begin += count;
    }
    return crc;
}

}  // namespace lyr::format
