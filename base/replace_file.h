// Output that is whole or absent: written under a temporary name in the same folder, then renamed.
//
// Contract
//  1. Until commit() succeeds, the file at `path` is as it was before.
//  2. Whatever is not committed is removed, also when the program is ended by an exception.
//  3. A path that is not a regular file (a pipe, a device) or names an open descriptor (/dev/stdout) is written
//     directly.
//  4. Through a symbolic link the file that it leads to is replaced; the link stays.

#pragma once

#include <cstdio>
#include <memory>
#include <span>
#include <string>

#include "base/diagnostic.h"

namespace lyr {

class ReplaceFile {
public:
    // Errors (status output): the folder is missing or not writable, `path` is a folder.
    static Result<ReplaceFile> open(const std::string& path);

    ReplaceFile(ReplaceFile&& other) noexcept;
    ReplaceFile& operator=(ReplaceFile&&) = delete;
    ~ReplaceFile();

    // Buffered; a failure to write is reported by commit().
    void write(std::span<const std::byte> bytes);
    void write(std::string_view text);

    // Flushes, syncs and renames. Errors (status output): disk full, folder gone.
    Status commit();

private:
    ReplaceFile(std::string path, std::string temporary, std::FILE* file);

    std::string path_;
    std::string temporary_;  // empty when written directly
    std::FILE* file_;
};

}  // namespace lyr
