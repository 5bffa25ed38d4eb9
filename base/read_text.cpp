// By read(2), which tells a folder from a file and ends at the limit whatever the input is.

#include "base/read_text.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "base/text.h"

namespace lyr {
namespace {

constexpr std::size_t piece_bytes = std::size_t{1} << 16;

Diagnostic input_error(const std::string& message, const std::string& name) {
    return {Severity::error, ExitStatus::input, message, {.file = name}};
}

// Doubled, but for no more than there may be.
void make_room(std::string& text, std::size_t bytes, std::size_t most_bytes) {
    if (text.capacity() >= bytes) return;
    text.reserve(std::max(bytes, std::min(2 * bytes, most_bytes)));
}

Result<std::string> read_all(int descriptor, const std::string& name, std::size_t most_bytes,
                             const HeadCheck& check) {
    std::string text;
    for (bool checked = !check.wrong;;) {
        const std::size_t begin = text.size();
        make_room(text, begin + piece_bytes, most_bytes);
        text.resize(begin + piece_bytes);
        const ssize_t count = ::read(descriptor, text.data() + begin, piece_bytes);
        const int error = errno;
        text.resize(begin + static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
        if (!checked && (count == 0 || text.size() >= check.bytes)) {
            if (const auto wrong = check.wrong(text)) return input_error(*wrong, name);
            checked = true;
        }
        if (count == 0) return text;
        if (count < 0 && error != EINTR)
            return input_error(std::string("cannot read: ") + std::strerror(error), name);
        if (text.size() > most_bytes)
            return input_error("longer than " + counted(most_bytes, "byte"), name);
    }
}

}  // namespace

Result<std::string> read_text(const std::string& path, std::size_t most_bytes,
                              const HeadCheck& check) {
    if (path == "-") return read_all(STDIN_FILENO, standard_input_name, most_bytes, check);
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) return input_error(std::string("cannot read: ") + std::strerror(errno), path);
    auto text = read_all(file, path, most_bytes, check);
    ::close(file);
    return text;
}

std::size_t most_readable_bytes(const std::string& path) {
    struct stat status {};
    const bool known =
        path == "-" ? ::fstat(STDIN_FILENO, &status) == 0 : ::stat(path.c_str(), &status) == 0;
    return known && S_ISREG(status.st_mode) ? std::numeric_limits<std::size_t>::max()
                                            : most_streamed_bytes;
}

}  // namespace lyr
