// mmap(2) for regular files, read(2) for pipes and the like.

#include "parser/part21/source.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace lyr::part21 {
namespace {

Diagnostic cannot_read(const std::string& path, int error) {
    return {Severity::error,
            ExitStatus::input,
            "cannot read: " + std::string(std::strerror(error)),
            {.file = path}};
}

class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (number_ >= 0) ::close(number_);
    }
    int number() const { return number_; }

private:
    int number_;
};

// 0, or the errno of what failed.
int read_all(int descriptor, std::string& text) {
    constexpr std::size_t step = 1 << 16;
    while (true) {
        const std::size_t size = text.size();
        text.resize(size + step);
        const ssize_t count = ::read(descriptor, text.data() + size, step);
        text.resize(size + static_cast<std::size_t>(count > 0 ? count : 0));
        if (count == 0) return 0;
        if (count < 0 && errno != EINTR) return errno;
    }
}

}  // namespace

Source::~Source() {
    if (mapping_) ::munmap(mapping_, text_.size());
}

void Source::hold(std::string text) {
    held_ = std::move(text);
    text_ = held_;
}

Status Source::map(const std::string& path) {
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    struct stat status {};
    if (file.number() < 0 || ::fstat(file.number(), &status) != 0) return cannot_read(path, errno);
    if (S_ISDIR(status.st_mode)) return cannot_read(path, EISDIR);
    if (!S_ISREG(status.st_mode) || status.st_size == 0) {
        std::string text;
        if (const int error = read_all(file.number(), text)) return cannot_read(path, error);
        hold(std::move(text));
        return Done{};
    }
    const auto size = static_cast<std::size_t>(status.st_size);
    void* mapping = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE | MAP_POPULATE, file.number(), 0);
    if (mapping == MAP_FAILED) return cannot_read(path, errno);
    mapping_ = mapping;
    text_ = {static_cast<const char*>(mapping), size};
    return Done{};
}

}  // namespace lyr::part21
