// The bytes of a file: mapped, or held in memory when they cannot be mapped.
//
// Contract
//  1. text() stays where it is until the Source is destroyed; it cannot be copied or moved.
//  2. Errors (status input) say why the file cannot be read: missing, a folder, no permission.
//
// A mapped file must not be shortened by another program while it is read: the system then ends the
// reader with SIGBUS. CAD programs replace files by renaming, which is safe.

#pragma once

#include <string>
#include <string_view>

#include "base/diagnostic.h"

namespace lyr::part21 {

class Source {
public:
    Source() = default;
    Source(const Source&) = delete;
    Source& operator=(const Source&) = delete;
    ~Source();

    Status map(const std::string& path);
    void hold(std::string text);

    std::string_view text() const { return text_; }

private:
    std::string held_;
    void* mapping_ = nullptr;
    std::string_view text_;
};

}  // namespace lyr::part21
