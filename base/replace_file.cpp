// Write to "<path>.<pid>.part", then rename(2): a reader sees the old file or the whole new one.

#include "base/replace_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <mutex>
#include <set>

#include "base/file_place.h"

namespace lyr {
namespace {

// The temporaries that this process has made and not yet renamed or removed. A signal ends the process with all of
// them, whoever made them; so the list is as global as the process.
std::mutex temporaries_lock;
std::set<std::string> temporaries;

Diagnostic cannot_write(const std::string& name, int error) {
    return {Severity::error,
            ExitStatus::output,
            "cannot write: " + std::string(std::strerror(error)),
            {.file = name}};
}

// A descriptor, or -1 with errno. A leftover of an earlier process of the same number is removed, never written into: the
// name may lead elsewhere by now.
int make_new(const std::string& path) {
    const int flags = O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC;
    const int made = ::open(path.c_str(), flags, 0666);
    if (made >= 0 || errno != EEXIST || ::unlink(path.c_str()) != 0) return made;
    return ::open(path.c_str(), flags, 0666);
}

}  // namespace

Result<ReplaceFile> ReplaceFile::open(const std::string& path) {
    if (path == "-") return on_descriptor(STDOUT_FILENO, standard_output_name);
    const std::optional<FilePlace> place = place_of(path);
    if (!place) return cannot_write(path, ELOOP);
    if (place->descriptor >= 0) return on_descriptor(place->descriptor, path);
    struct stat status {};
    const bool exists = ::stat(path.c_str(), &status) == 0;
    if (exists && S_ISDIR(status.st_mode)) return cannot_write(path, EISDIR);
    const bool in_proc = place->path.starts_with("/proc/");  // a descriptor of another process
    if (in_proc || (exists && !S_ISREG(status.st_mode))) {
        std::FILE* const file = std::fopen(path.c_str(), "wbe");
        if (!file) return cannot_write(path, errno);
        return ReplaceFile(path, file);
    }
    if (exists && ::access(path.c_str(), W_OK) != 0) return cannot_write(path, errno);
    return beside(place->path, path);
}

Result<ReplaceFile> ReplaceFile::on_descriptor(int descriptor, const std::string& name) {
    // fdopen(3) on its own would call a descriptor that is open for reading an invalid argument.
    const int flags = ::fcntl(descriptor, F_GETFL);
    if (flags < 0 || (flags & O_ACCMODE) == O_RDONLY) return cannot_write(name, EBADF);
    const int own = ::fcntl(descriptor, F_DUPFD_CLOEXEC, 0);
    if (own < 0) return cannot_write(name, errno);
    std::FILE* const file = ::fdopen(own, "wb");
    if (!file) {
        const int error = errno;
        ::close(own);
        return cannot_write(name, error);
    }
    return ReplaceFile(name, file);
}

Result<ReplaceFile> ReplaceFile::beside(const std::string& target, const std::string& name) {
    const std::string temporary = target + '.' + std::to_string(::getpid()) + ".part";
    const std::lock_guard lock(temporaries_lock);
    const int descriptor = make_new(temporary);
    if (descriptor < 0) return cannot_write(name, errno);
    temporaries.insert(temporary);
    struct stat replaced {};
    if (::stat(target.c_str(), &replaced) == 0) ::fchmod(descriptor, replaced.st_mode & 0777);
    ReplaceFile made(name, ::fdopen(descriptor, "wb"));
    made.target_ = target;
    made.temporary_ = temporary;
    return made;
}

ReplaceFile::ReplaceFile(ReplaceFile&& other) noexcept
    : name_(std::move(other.name_)),
      target_(std::move(other.target_)),
      temporary_(std::move(other.temporary_)),
      file_(std::exchange(other.file_, nullptr)),
      error_(other.error_) {}

ReplaceFile::~ReplaceFile() {
    if (!file_) return;
    std::fclose(file_);
    discard();
}

void ReplaceFile::discard() {
    if (direct()) return;
    const std::lock_guard lock(temporaries_lock);
    ::unlink(temporary_.c_str());
    temporaries.erase(temporary_);
}

void ReplaceFile::note(bool succeeded) {
    if (!succeeded && error_ == 0) error_ = errno ? errno : EIO;
}

void ReplaceFile::write(std::span<const std::byte> bytes) {
    if (bytes.empty() || error_ != 0) return;
    errno = 0;
    note(std::fwrite(bytes.data(), 1, bytes.size(), file_) == bytes.size());
}

void ReplaceFile::write(std::string_view text) {
    write(std::as_bytes(std::span(text.data(), text.size())));
}

Status ReplaceFile::flush() {
    errno = 0;
    note(std::fflush(file_) == 0);
    if (!direct() && error_ == 0) note(::fsync(::fileno(file_)) == 0);
    if (error_ != 0) return cannot_write(name_, error_);
    return Done{};
}

Status ReplaceFile::commit() {
    // A failure stays in error_.
    static_cast<void>(flush());
    note(std::fclose(std::exchange(file_, nullptr)) == 0);
    if (!direct() && error_ == 0) {
        const std::lock_guard lock(temporaries_lock);
        note(::rename(temporary_.c_str(), target_.c_str()) == 0);
        if (error_ == 0) temporaries.erase(temporary_);
    }
    if (error_ == 0) return Done{};
    discard();
    return cannot_write(name_, error_);
}

void end_process(ExitStatus status) {
    // The lock is kept: what waits for it must not commit any more.
    temporaries_lock.lock();
    for (const std::string& temporary : temporaries) ::unlink(temporary.c_str());
    ::_exit(static_cast<int>(status));
}

}  // namespace lyr
