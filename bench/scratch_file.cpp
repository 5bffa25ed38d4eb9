#include "bench/scratch_file.h"

#include <stdlib.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace lyr::bench {

ScratchFile::ScratchFile(std::string path) : path_(std::move(path)) {}

ScratchFile::ScratchFile(ScratchFile&& other) noexcept : path_(std::exchange(other.path_, {})) {}

ScratchFile::~ScratchFile() {
    if (!path_.empty()) unlink(path_.c_str());
}

Result<ScratchFile> ScratchFile::with(const std::string& text) {
    std::string path = std::filesystem::temp_directory_path() / "lyr_bench_XXXXXX";
    const int descriptor = mkstemp(path.data());
    const auto failed = [&] {
        return Diagnostic{Severity::error,
                          ExitStatus::output,
                          std::string("cannot write: ") + std::strerror(errno),
                          {.file = path}};
    };
    if (descriptor < 0) return failed();
    close(descriptor);
    ScratchFile file(path);
    std::ofstream out(path, std::ios::binary);
    out << text << std::flush;
    if (!out) return failed();
    return file;
}

}  // namespace lyr::bench
