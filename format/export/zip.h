// A ZIP archive, written front to back: its files are deflated as they come (APPNOTE 6.3, without extensions).
//
// Contract
//  1. Any reader of ZIP opens it; no file's time of day is in it (1980-01-01).
//  2. A file, and the archive, has at most 4 GiB; what is larger is an error (status unsupported) of finish().

#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "base/diagnostic.h"
#include "format/export/sink.h"

namespace lyr::format {

class ZipWriter {
public:
    explicit ZipWriter(const Sink& sink);
    ~ZipWriter();
    ZipWriter(const ZipWriter&) = delete;
    ZipWriter& operator=(const ZipWriter&) = delete;

    // The next file; ends the one before.
    void begin_file(const std::string& name);
    void write(std::string_view text);
    Status finish();

private:
    class Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace lyr::format
