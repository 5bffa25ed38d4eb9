// libmd's, which Debian's own package manager brings along.

#include "slicer/sha256.h"

#include <sha256.h>

#include <array>

namespace lyr::slicer {

std::string sha256_of(std::string_view bytes) {
    SHA256_CTX state;
    SHA256Init(&state);
    SHA256Update(&state, reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    std::array<char, SHA256_DIGEST_STRING_LENGTH> digits{};
    return SHA256End(&state, digits.data());
}

}  // namespace lyr::slicer
