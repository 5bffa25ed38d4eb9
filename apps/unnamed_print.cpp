#include "apps/unnamed_print.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

namespace lyr::command_line {

Result<UnnamedPrint> UnnamedPrint::create() {
    std::FILE* const file = std::tmpfile();
    const int descriptor = file ? ::fcntl(::fileno(file), F_DUPFD_CLOEXEC, 0) : -1;
    const int error = errno;
    if (file) std::fclose(file);
    if (descriptor >= 0) return UnnamedPrint(descriptor);
    return Diagnostic{Severity::error,
                      ExitStatus::output,
                      std::string("cannot make a temporary file: ") + std::strerror(error),
                      {}};
}

UnnamedPrint::UnnamedPrint(UnnamedPrint&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

UnnamedPrint::~UnnamedPrint() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

std::string UnnamedPrint::path() const {
    return "/dev/fd/" + std::to_string(descriptor_);
}

Result<format::Reader> UnnamedPrint::read() {
    ::lseek(descriptor_, 0, SEEK_SET);
    return format::Reader::from_descriptor(std::exchange(descriptor_, -1), "the print");
}

}  // namespace lyr::command_line
