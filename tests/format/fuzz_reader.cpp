// libFuzzer target: whatever the bytes, reading them ends with the end of the print or an error,
// positions stay within their limit, and the reader in C says the same but for the metadata's text.
// Checksums are put right first, so that mutations get past them.

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "c_reader.h"
#include "format/bytes.h"
#include "format/crc32c.h"

namespace {

using namespace lyr::format;

void put_crc(std::vector<std::byte>& file, std::size_t begin, std::size_t end) {
    const std::uint32_t crc = crc32c(std::span<const std::byte>(file).subspan(begin, end - begin));
    for (std::size_t i = 0; i < block_crc_bytes; ++i)
        file[end + i] = static_cast<std::byte>((crc >> (8 * i)) & 0xff);
}

void put_crcs_right(std::vector<std::byte>& file) {
    if (file.size() < prologue_bytes) return;
    put_crc(file, 0, prologue_bytes - block_crc_bytes);
    for (std::size_t begin = prologue_bytes; begin + block_frame_bytes <= file.size();) {
        const std::size_t length = get_u32(file.data() + begin) >> 8;
        const std::size_t end = begin + block_head_bytes + length;
        if (end + block_crc_bytes > file.size()) return;
        put_crc(file, begin, end);
        begin = end + block_crc_bytes;
    }
}

void check(const Point& point) {
    for (const std::int64_t value : {point.x, point.y, point.z})
        if (value < -coordinate_limit || value > coordinate_limit) std::abort();
}

void read_on(Reader& reader) {
    while (const Operation* operation = reader.read())
        std::visit(
            [](const auto& o) {
                if constexpr (requires { o.to; }) check(o.to);
            },
            *operation);
}

// C knows nothing of the text of the metadata, nor of the number of layers that it states.
void compare_in_c(const std::vector<std::byte>& file, lyr::Result<Reader> reader) {
    if (!reader) return;
    const std::string difference = test::difference(file, std::move(reader));
    const bool by_text = difference.find("another number of layers, chunks") != std::string::npos;
    if (!difference.empty() && !by_text) {
        std::fprintf(stderr, "%s\n", difference.c_str());
        std::abort();
    }
}

// From anywhere, with a buffer that not all blocks fit.
void seek_in_c(const std::vector<std::byte>& file, std::uint64_t offset) {
    test::Memory memory{file};
    test::CReader c(memory, 4096);
    if (!c.open() || !lyr_seek_layer(&c.reader, 1, offset)) return;
    while (lyr_next(&c.reader, &c.operation)) {
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto* bytes = reinterpret_cast<const std::byte*>(data);
    std::vector<std::byte> file(bytes, bytes + size);
    put_crcs_right(file);
    const int descriptor = ::memfd_create("fuzz", MFD_CLOEXEC);
    if (descriptor < 0) std::abort();
    if (!file.empty() &&
        ::write(descriptor, file.data(), file.size()) != static_cast<ssize_t>(file.size()))
        std::abort();
    ::lseek(descriptor, 0, SEEK_SET);
    const int again = ::dup(descriptor);
    {
        auto reader = Reader::from_descriptor(descriptor, "fuzz");
        if (reader) read_on(*reader);
        if (reader && reader->seek_layer(1)) read_on(*reader);
    }
    ::lseek(again, 0, SEEK_SET);
    compare_in_c(file, Reader::from_descriptor(
                           again, "fuzz", {.keep_thumbnails = false, .keep_configuration = false}));
    if (file.size() > prologue_bytes + 4)
        seek_in_c(file, get_u32(file.data() + prologue_bytes) % file.size());
    return 0;
}
