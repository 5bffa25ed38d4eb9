// How fast is the reader? Joins STEP files to one exchange structure with ids of their own, then
// measures indexing, and decoding of every argument, in MB (10^6 bytes) a second on one core.
//
//     bench_part21 joined.stp file.step...      writes joined.stp and measures it
//     bench_part21 joined.stp                   measures it again

#include <chrono>
#include <cstdio>
#include <fstream>
#include <string>

#include "parser/part21/decode_all.h"

namespace {

using lyr::part21::File;

// A #id outside strings gets `offset` added. Comments are taken for text, which does no harm here.
std::string renumbered(const std::string& text, std::uint64_t offset) {
    std::string result;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '\'') in_string = !in_string;
        result += text[i];
        if (in_string || text[i] != '#') continue;
        std::size_t after = i + 1;
        while (after < text.size() && text[after] >= '0' && text[after] <= '9') ++after;
        if (after == i + 1) continue;
        const std::string digits = text.substr(i + 1, after - i - 1);
        if (digits.size() > 18) continue;
        result += std::to_string(std::stoull(digits) + offset);
        i = after - 1;
    }
    return result;
}

void join(const char* path, int count, char** names) {
    std::ofstream out(path, std::ios::binary);
    out << "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','',"
           "'');\n"
           "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n";
    std::uint64_t offset = 0;
    for (int i = 0; i < count; ++i) {
        const auto file = File::open(names[i]);
        if (!file || file->instance_count() == 0) continue;
        std::ifstream in(names[i], std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(in), {}};
        std::uint64_t highest = 0;
        for (std::size_t k = 0; k < file->instance_count(); ++k) {
            highest = std::max(highest, file->id(lyr::part21::InstanceIndex(k)));
        }
        const std::size_t data = text.find("DATA;"), end = text.rfind("ENDSEC;");
        if (data == text.npos || end == text.npos || end < data) continue;
        out << renumbered(text.substr(data + 5, end - data - 5), offset);
        offset += highest;
    }
    out << "ENDSEC;\nEND-ISO-10303-21;\n";
}

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) return std::fprintf(stderr, "usage: bench_part21 joined.stp [file...]\n"), 2;
    if (argc > 2) join(argv[1], argc - 2, argv + 2);
    const double megabytes =
        static_cast<double>(std::ifstream(argv[1], std::ios::ate | std::ios::binary).tellg()) / 1e6;
    for (int round = 0; round < 3; ++round) {
        auto start = std::chrono::steady_clock::now();
        const auto file = File::open(argv[1]);
        const double index_s = seconds_since(start);
        if (!file) return std::fprintf(stderr, "%s\n", lyr::to_string(file.error()).c_str()), 3;
        start = std::chrono::steady_clock::now();
        const std::size_t faces = file->instances_of("ADVANCED_FACE").size();
        const double scan_s = seconds_since(start);
        start = std::chrono::steady_clock::now();
        const lyr::part21::Decoded decoded = decode_all(*file);
        const double decode_s = seconds_since(start);
        std::printf(
            "%.0f MB, %zu instances: index %.0f MB/s, all of a keyword (%zu) in %.2f ms, "
            "decode all %zu values %.0f MB/s\n",
            megabytes, file->instance_count(), megabytes / index_s, faces, scan_s * 1e3,
            decoded.values, megabytes / decode_s);
    }
}
