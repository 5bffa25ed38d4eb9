// Reads a .lyr file front to back, from a file or a pipe, in bounded memory.
//
//     Result<Reader> reader = Reader::open("part.lyr");
//     for (;;) {
//         Result<std::optional<Operation>> next = reader->next();
//         if (!next) return next.error();
//         if (!*next) break;  // the end, complete
//         std::visit(..., **next);
//     }
//
// Contract
//  1. No operation is given out before the CRC of its chunk was found right, nor a layer's state
//     before the CRC of its block. After an error the reader stays at it: next() gives the same
//     error again, until seek_layer() starts anew elsewhere.
//  2. After open() no memory is taken from the heap, except by an error's own text; the buffer is
//     64 KiB.
//  3. The end is given only after the end block was found right: counts of layers, chunks and
//     operations, the index, and nothing behind it. A file that stops earlier is an error that
//     names the last whole layer.
//  4. Unknown blocks that may be skipped are skipped (their CRC is checked all the same); an
//     unknown block that may not is an error (status unsupported), as is a newer major version.
//  5. No input makes it crash, read out of bounds or loop. Errors carry layer and chunk (from 1, as
//     people count) and byte offset in their message.
//  6. Nothing is needed but read(2); lseek(2) only in seek_layer(), which does without in a pipe.

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "base/diagnostic.h"
#include "format/metadata.h"
#include "format/operation.h"

namespace lyr::format {

struct FileHeader {
    std::uint32_t major = 0, minor = 0;
    Quantum quantum;
    Metadata metadata;
    Summary summary;
};

struct ReadOptions {
    // Otherwise these are checked and skipped (a printer has no use for them).
    bool keep_thumbnails = true;
    bool keep_configuration = true;
};

// Where in the file the operation given out last was; at the end: the file's end.
struct ReadPosition {
    std::optional<std::uint32_t> layer;  // from 0
    std::uint32_t chunk = 0;             // of the layer, from 0
    std::uint64_t offset = 0;            // of its first byte, from the file's start
    std::uint64_t end = 0;               // behind its last byte
};

class Reader {
public:
    // Reads up to the first layer. "-" is standard input. Errors: input, unsupported (newer major
    // version).
    static Result<Reader> open(const std::string& path, ReadOptions options = {});
    // Takes over the descriptor. `name` stands for it in messages.
    static Result<Reader> from_descriptor(int descriptor, const std::string& name,
                                          ReadOptions options = {});

    Reader(Reader&&) noexcept;
    Reader& operator=(Reader&&) noexcept;
    ~Reader();

    const FileHeader& header() const;

    // The next operation, or none at the end.
    Result<std::optional<Operation>> next();
    // The same without a copy, for those in a hurry: valid until the next call; null at the end and
    // after an error, which error() then has.
    const Operation* read();
    const std::optional<Diagnostic>& error() const;

    // Of the layer that LayerStart was given out for last.
    const Layer& layer() const;
    // As of the operation given out last: Width, Speed and Acceleration are in it.
    const PathStyle& path() const;
    ReadPosition position() const;

    // The next operation will be LayerStart of this layer (from 0). In a file it goes there by the
    // index, which must be whole; the end is then checked without counts and index. A file that is
    // cut short, without an end block, it reads from the first layer on. In a pipe it reads on to
    // the layer, which must not have begun. Errors: input, and the reader stays at it.
    Status seek_layer(std::uint32_t index);

private:
    class Implementation;
    explicit Reader(std::unique_ptr<Implementation> implementation);
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace lyr::format
