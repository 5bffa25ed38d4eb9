// Bytes as text of 64 letters (RFC 4648), piece by piece.

#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>

namespace lyr {

class Base64 {
public:
    // Appends what is complete: four letters for every three bytes.
    void append(std::span<const std::byte> bytes, std::string& out);
    // The one or two bytes that are left, with padding.
    void finish(std::string& out);

private:
    std::array<std::byte, 3> kept_{};
    std::size_t count_ = 0;
};

std::string base64(std::span<const std::byte> bytes);

}  // namespace lyr
