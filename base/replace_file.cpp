// Write to "<path>.<pid>.part", then rename(2): a reader sees the old file or the whole new one.

#include "base/replace_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace lyr {
namespace {

Diagnostic cannot_write(const std::string& path, int error) {
    return {Severity::error,
            ExitStatus::output,
            "cannot write: " + std::string(std::strerror(error)),
            {.file = path}};
}

// Names of open descriptors are links to whatever is open: renaming would replace the link.
bool names_descriptor(const std::string& path) {
    return path == "/dev/stdout" || path == "/dev/stderr" || path.starts_with("/dev/fd/") ||
           path.starts_with("/proc/");
}

// The file that a link leads to, so that the link stays and its target is replaced.
std::string resolved(const std::string& path) {
    const std::unique_ptr<char, decltype(&std::free)> real(::realpath(path.c_str(), nullptr),
                                                           &std::free);
    return real ? real.get() : path;
}

}  // namespace

Result<ReplaceFile> ReplaceFile::open(const std::string& path) {
    struct stat status {};
    const bool exists = ::stat(path.c_str(), &status) == 0;
    if (exists && S_ISDIR(status.st_mode)) return cannot_write(path, EISDIR);
    const bool direct = names_descriptor(path) || (exists && !S_ISREG(status.st_mode));
    if (exists && !direct && ::access(path.c_str(), W_OK) != 0) return cannot_write(path, errno);
    const std::string target = direct ? path : resolved(path);
    const std::string temporary = direct ? "" : target + '.' + std::to_string(::getpid()) + ".part";
    std::FILE* file = std::fopen(direct ? path.c_str() : temporary.c_str(), "wbe");
    if (!file) return cannot_write(path, errno);
    return ReplaceFile(target, temporary, file);
}

ReplaceFile::ReplaceFile(std::string path, std::string temporary, std::FILE* file)
    : path_(std::move(path)), temporary_(std::move(temporary)), file_(file) {}

ReplaceFile::ReplaceFile(ReplaceFile&& other) noexcept
    : path_(std::move(other.path_)),
      temporary_(std::move(other.temporary_)),
      file_(std::exchange(other.file_, nullptr)) {}

ReplaceFile::~ReplaceFile() {
    if (!file_) return;
    std::fclose(file_);
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void ReplaceFile::write(std::span<const std::byte> bytes) {
    if (!bytes.empty()) std::fwrite(bytes.data(), 1, bytes.size(), file_);
}

void ReplaceFile::write(std::string_view text) {
    write(std::as_bytes(std::span(text.data(), text.size())));
}

Status ReplaceFile::commit() {
    std::FILE* file = std::exchange(file_, nullptr);
    errno = 0;
    const bool failed_before = std::ferror(file) != 0;
    const bool flushed = std::fflush(file) == 0 && !failed_before &&
                         (temporary_.empty() || ::fsync(::fileno(file)) == 0);
    const int error = errno ? errno : EIO;
    if (std::fclose(file) != 0 || !flushed) {
        if (!temporary_.empty()) ::unlink(temporary_.c_str());
        return cannot_write(path_, error);
    }
    if (!temporary_.empty() && ::rename(temporary_.c_str(), path_.c_str()) != 0) {
        const int rename_error = errno;
        ::unlink(temporary_.c_str());
        return cannot_write(path_, rename_error);
    }
    return Done{};
}

}  // namespace lyr
