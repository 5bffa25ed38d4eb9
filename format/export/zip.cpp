// Sizes and checksums follow each file's data, as these are not known before.

#include "format/export/zip.h"

#include <zlib.h>

#include <array>
#include <limits>
#include <vector>

namespace lyr::format {
namespace {

constexpr std::uint16_t version_needed = 20, sizes_follow = 0x0008, deflated = 8;
constexpr std::uint16_t first_date = 1 << 5 | 1;  // 1980-01-01
constexpr int raw_deflate = -15, memory_level = 8;

void put(std::string& out, std::uint64_t value, int bytes) {
    for (; bytes > 0; --bytes, value >>= 8) out += static_cast<char>(value & 0xff);
}

}  // namespace

class ZipWriter::Implementation {
public:
    explicit Implementation(const Sink& sink) : sink_(sink) {}
    ~Implementation() {
        if (open_) deflateEnd(&stream_);
    }

    void begin_file(const std::string& name) {
        end_file();
        files_.push_back({.name = name, .offset = offset_});
        stream_ = {};
        open_ = deflateInit2(&stream_, Z_DEFAULT_COMPRESSION, Z_DEFLATED, raw_deflate, memory_level,
                             Z_DEFAULT_STRATEGY) == Z_OK;
        failed_ = failed_ || !open_;
        std::string head = "PK\3\4";
        put(head, version_needed, 2);
        put_common(head, files_.back(), false);
        put(head, name.size(), 2);
        put(head, 0, 2);
        out(head + name);
    }
    void write(std::string_view text) {
        constexpr std::size_t most = std::numeric_limits<uInt>::max() / 2;
        for (; text.size() > most; text.remove_prefix(most))
            deflate_some(text.substr(0, most), Z_NO_FLUSH);
        deflate_some(text, Z_NO_FLUSH);
    }
    Status finish() {
        end_file();
        const std::uint64_t begin = offset_;
        for (const File& file : files_) out(directory_entry(file));
        std::string end = "PK\5\6";
        put(end, 0, 4);
        put(end, files_.size(), 2);
        put(end, files_.size(), 2);
        put(end, offset_ - begin, 4);
        put(end, begin, 4);
        put(end, 0, 2);
        constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
        bool is_too_large = offset_ > most;
        for (const File& file : files_) is_too_large = is_too_large || file.size > most;
        out(end);
        if (is_too_large)
            return Diagnostic{Severity::error,
                              ExitStatus::unsupported,
                              "an archive of more than 4 GiB is not written",
                              {}};
        if (failed_)
            return Diagnostic{Severity::error, ExitStatus::internal, "zlib has failed", {}};
        return Done{};
    }

private:
    struct File {
        std::string name{};
        std::uint64_t offset = 0, size = 0, packed = 0;
        std::uint32_t crc = 0;
    };

    void out(std::string_view bytes) {
        offset_ += bytes.size();
        sink_(bytes);
    }

    static void put_common(std::string& text, const File& file, bool with_sizes) {
        put(text, sizes_follow, 2);
        put(text, deflated, 2);
        put(text, 0, 2);
        put(text, first_date, 2);
        put(text, with_sizes ? file.crc : 0, 4);
        put(text, with_sizes ? file.packed : 0, 4);
        put(text, with_sizes ? file.size : 0, 4);
    }

    static std::string directory_entry(const File& file) {
        std::string entry = "PK\1\2";
        put(entry, version_needed, 2);
        put(entry, version_needed, 2);
        put_common(entry, file, true);
        put(entry, file.name.size(), 2);
        put(entry, 0, 12);  // no extra field, no comment, first disk, no attributes
        put(entry, file.offset, 4);
        return entry + file.name;
    }

    void deflate_some(std::string_view text, int flush) {
        if (!open_) return;
        File& file = files_.back();
        file.size += text.size();
        // Of nothing at no address zlib gives the checksum to begin with.
        if (!text.empty())
            file.crc = static_cast<std::uint32_t>(crc32(file.crc,
                                                        reinterpret_cast<const Bytef*>(text.data()),
                                                        static_cast<uInt>(text.size())));
        stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
        stream_.avail_in = static_cast<uInt>(text.size());
        std::array<char, 1 << 15> packed{};
        do {
            stream_.next_out = reinterpret_cast<Bytef*>(packed.data());
            stream_.avail_out = static_cast<uInt>(packed.size());
            failed_ = deflate(&stream_, flush) == Z_STREAM_ERROR || failed_;
            const std::size_t count = packed.size() - stream_.avail_out;
            file.packed += count;
            out({packed.data(), count});
        } while (stream_.avail_out == 0);
    }

    void end_file() {
        if (!open_) return;
        deflate_some({}, Z_FINISH);
        deflateEnd(&stream_);
        open_ = false;
        const File& file = files_.back();
        std::string sizes = "PK\7\10";
        put(sizes, file.crc, 4);
        put(sizes, file.packed, 4);
        put(sizes, file.size, 4);
        out(sizes);
    }

    const Sink& sink_;
    std::vector<File> files_;
    std::uint64_t offset_ = 0;
    z_stream stream_{};
    bool open_ = false, failed_ = false;
};

ZipWriter::ZipWriter(const Sink& sink) : implementation_(std::make_unique<Implementation>(sink)) {}
ZipWriter::~ZipWriter() = default;

void ZipWriter::begin_file(const std::string& name) {
    implementation_->begin_file(name);
}

void ZipWriter::write(std::string_view text) {
    implementation_->write(text);
}

Status ZipWriter::finish() {
    return implementation_->finish();
}

}  // namespace lyr::format
