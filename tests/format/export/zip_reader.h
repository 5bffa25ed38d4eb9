// Reads a ZIP archive back by its directory, with zlib's own inflate; nothing of the writer's is used.

#pragma once

#include <doctest/doctest.h>
#include <zlib.h>

#include <cstdint>
#include <map>
#include <string>

namespace lyr::format::test {

inline std::uint32_t zip_number(const std::string& bytes, std::size_t at, int count) {
    std::uint32_t value = 0;
    for (int i = 0; i < count; ++i)
        value |= static_cast<std::uint32_t>(
                     static_cast<unsigned char>(bytes.at(at + static_cast<std::size_t>(i))))
                 << (8 * i);
    return value;
}

inline std::string inflated(const std::string& packed, std::size_t size) {
    std::string out(size + 1, '\0');
    z_stream stream{};
    REQUIRE(inflateInit2(&stream, -15) == Z_OK);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    stream.avail_in = static_cast<uInt>(packed.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    CHECK(inflate(&stream, Z_FINISH) == Z_STREAM_END);
    CHECK(stream.avail_in == 0);
    inflateEnd(&stream);
    return out.substr(0, out.size() - stream.avail_out);
}

inline std::map<std::string, std::string> read_zip(const std::string& bytes) {
    std::map<std::string, std::string> files;
    const std::size_t end = bytes.rfind("PK\5\6");
    REQUIRE(end != std::string::npos);
    const std::uint32_t count = zip_number(bytes, end + 10, 2);
    std::size_t entry = zip_number(bytes, end + 16, 4);
    CHECK(entry + zip_number(bytes, end + 12, 4) == end);
    CHECK(end + 22 == bytes.size());
    for (std::uint32_t i = 0; i < count; ++i) {
        REQUIRE(bytes.substr(entry, 4) == "PK\1\2");
        const std::uint32_t crc = zip_number(bytes, entry + 16, 4);
        const std::uint32_t packed = zip_number(bytes, entry + 20, 4);
        const std::uint32_t size = zip_number(bytes, entry + 24, 4);
        const std::uint32_t name = zip_number(bytes, entry + 28, 2);
        const std::size_t local = zip_number(bytes, entry + 42, 4);
        REQUIRE(bytes.substr(local, 4) == "PK\3\4");
        CHECK(bytes.substr(local + 30, name) == bytes.substr(entry + 46, name));
        const std::string text = inflated(bytes.substr(local + 30 + name, packed), size);
        CHECK(text.size() == size);
        CHECK(crc32(0, reinterpret_cast<const Bytef*>(text.data()),
                    static_cast<uInt>(text.size())) == crc);
        CHECK(bytes.substr(local + 30 + name + packed, 4) == "PK\7\10");
        files[bytes.substr(entry + 46, name)] = text;
        entry += 46 + name;
    }
    return files;
}

}  // namespace lyr::format::test
