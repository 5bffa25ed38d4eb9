// The file of a print, which is read several times: it is inspected, told apart from others and printed, and must be the
// same each time.
//
// Contract
//  1. reader() reads the file that open() found. One that was replaced or written to since is an error (status input).
//  2. Until check() finds it changed, all that was read of it are the bytes that it had at open().

#pragma once

#include <sys/stat.h>

#include <cstdint>
#include <string>

#include "format/reader.h"

namespace lyr::run {

class PrintFile {
public:
    static Result<PrintFile> open(const std::string& path);
    PrintFile(PrintFile&& other) noexcept;
    PrintFile& operator=(PrintFile&&) = delete;
    ~PrintFile();

    const std::string& path() const { return path_; }
    // From a layer on, counted from 0; nothing is kept that a printer does not need.
    Result<format::Reader> reader(std::uint32_t first_layer = 0) const;
    Status check() const;

private:
    PrintFile(std::string path, int descriptor, const struct stat& found)
        : path_(std::move(path)), descriptor_(descriptor), found_(found) {}
    Status check(int descriptor) const;

    std::string path_;
    int descriptor_;  // held, so that no other file can get this one's number
    struct stat found_;
};

}  // namespace lyr::run
