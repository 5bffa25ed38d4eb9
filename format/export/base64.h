// Bytes as letters (RFC 4648).

#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace lyr::format {

std::string base64(std::span<const std::byte> bytes);

}  // namespace lyr::format
