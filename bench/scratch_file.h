// A file with a given text in the folder for temporary files, removed at the end of its scope.

#pragma once

#include <string>

#include "base/diagnostic.h"

namespace lyr::bench {

class ScratchFile {
public:
    // Errors (status output): no room, or the folder is not writable.
    static Result<ScratchFile> with(const std::string& text);

    ScratchFile(ScratchFile&& other) noexcept;
    ScratchFile& operator=(ScratchFile&&) = delete;
    ~ScratchFile();

    const std::string& path() const { return path_; }

private:
    explicit ScratchFile(std::string path);
    std::string path_;  // empty: moved from
};

}  // namespace lyr::bench
