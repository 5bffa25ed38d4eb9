// The bytes of a print: those that are in memory, or those of a file that may be larger than memory.
//
// Contract
//  1. at() gives the bytes of a place, fewer only at the end. They stay valid until the next call.
//  2. A file is read through one buffer of `window_bytes`, or of what is asked for if that is more.
//  3. What cannot be read, or is gone because the file was cut meanwhile, reads as zeros; error() says why.

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/diagnostic.h"

namespace lyr::format {

class FileView {
public:
    static constexpr std::size_t window_bytes = std::size_t{1} << 18;

    explicit FileView(std::span<const std::byte> bytes) : bytes_(bytes), size_(bytes.size()) {}
    // Of a regular file. Errors (status input): it cannot be read.
    static Result<FileView> open(const std::string& path);
    FileView(FileView&& other) noexcept;
    FileView& operator=(FileView&&) = delete;
    ~FileView();

    std::uint64_t size() const { return size_; }
    std::span<const std::byte> at(std::uint64_t begin, std::size_t count);
    std::uint32_t u32_at(std::uint64_t begin);
    // Of a range of any size, as crc32c() has it.
    std::uint32_t crc32c_of(std::uint64_t begin, std::uint64_t end);

    const std::optional<Diagnostic>& error() const { return error_; }

private:
    void read_window(std::uint64_t begin, std::size_t count);

    std::string name_;
    int descriptor_ = -1;
    std::vector<std::byte> window_;
    std::span<const std::byte> bytes_;  // all that there is, or the window's
    std::uint64_t begin_ = 0, size_ = 0;
    std::optional<Diagnostic> error_;
};

}  // namespace lyr::format
