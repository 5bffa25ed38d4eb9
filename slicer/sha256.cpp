// Nettle's, which uses the processor's own instructions where it has them.

#include "slicer/sha256.h"

#include <nettle/sha2.h>

#include <array>

#include "base/text.h"

namespace lyr::slicer {

std::string sha256_of(std::string_view bytes) {
    sha256_ctx state;
    sha256_init(&state);
    sha256_update(&state, bytes.size(), reinterpret_cast<const std::uint8_t*>(bytes.data()));
    std::array<std::uint8_t, SHA256_DIGEST_SIZE> digest{};
    sha256_digest(&state, digest.size(), digest.data());
    std::string digits;
    for (const std::uint8_t byte : digest) digits += formatted("%02x", byte);
    return digits;
}

}  // namespace lyr::slicer
