#include "base/base64.h"

namespace lyr {
namespace {

constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

}  // namespace

void Base64::append(std::span<const std::byte> bytes, std::string& out) {
    for (const std::byte byte : bytes) {
        kept_[count_++] = byte;
        if (count_ < kept_.size()) continue;
        const unsigned three = std::to_integer<unsigned>(kept_[0]) << 16 |
                               std::to_integer<unsigned>(kept_[1]) << 8 |
                               std::to_integer<unsigned>(kept_[2]);
        for (int shift = 18; shift >= 0; shift -= 6) out += letters[three >> shift & 63u];
        count_ = 0;
    }
}

void Base64::finish(std::string& out) {
    const std::size_t left = count_;
    if (left == 0) return;
    constexpr std::array<std::byte, 2> zeros{};
    append(std::span(zeros).first(kept_.size() - left), out);
    for (std::size_t i = left; i < kept_.size(); ++i) out[out.size() - (i - left) - 1] = '=';
}

std::string base64(std::span<const std::byte> bytes) {
    Base64 encoder;
    std::string out;
    encoder.append(bytes, out);
    encoder.finish(out);
    return out;
}

}  // namespace lyr
