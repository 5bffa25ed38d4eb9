// bench_lyr: how large .lyr files are, operation by operation, how fast they are read, and in how much memory, however
// large they are.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "base/text.h"
#include "bench/long_print.h"
#include "bench/lyr_kinds.h"
#include "bench/measure.h"
#include "bench/scratch_file.h"
#include "bench/table.h"
#include "format/export/statistics.h"
#include "format/reader.h"

namespace {

using namespace lyr;
using namespace lyr::bench;

constexpr std::uint64_t long_print_bytes = 1'000'000'000;
constexpr double million = 1e6, least_million_s = 40, least_mb_s = 200, most_memory_mb = 2;
constexpr int runs = 15, runs_apart = 3;
constexpr double enough_s = 10;

struct Read {
    double operations = 0, bytes = 0, seconds = 0, peak_bytes = 0;
};

// Of this process since it began. Without streams, which would take memory themselves.
double peak_memory_bytes() {
    std::FILE* status = std::fopen("/proc/self/status", "r");
    if (!status) return 0;
    char line[256];
    double kib = 0;
    while (std::fgets(line, sizeof line, status))
        if (std::strncmp(line, "VmHWM:", 6) == 0) kib = std::strtod(line + 6, nullptr);
    std::fclose(status);
    return 1024 * kib;
}

// As a printer reads: thumbnails and configuration are passed over.
Read read_once(const std::string& path) {
    Read read;
    read.seconds = time_of_s([&] {
        auto reader =
            format::Reader::open(path, {.keep_thumbnails = false, .keep_configuration = false});
        if (!reader) return;
        while (reader->read()) ++read.operations;
        if (!reader->error()) read.bytes = static_cast<double>(reader->position().end);
    });
    return read;
}

// In a process that does nothing else, so that its memory is the reader's.
Read read_apart(const std::string& path) {
    Read read;
    const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
    const std::string command = formatted("'%s' --read '%s'", program.c_str(), path.c_str());
    std::FILE* output = popen(command.c_str(), "r");
    if (!output) return read;
    if (std::fscanf(output, "%lf %lf %lf %lf", &read.operations, &read.bytes, &read.seconds,
                    &read.peak_bytes) != 4)
        read = {};
    pclose(output);
    return read;
}

Read fastest_apart(const std::string& path) {
    Read best = read_apart(path);
    for (int run = 1; run < runs_apart; ++run) {
        const Read read = read_apart(path);
        const double peak_bytes = std::max(best.peak_bytes, read.peak_bytes);
        if (read.seconds < best.seconds) best = read;
        best.peak_bytes = peak_bytes;
    }
    return best;
}

int read_and_tell(const std::string& path) {
    const Read read = read_once(path);
    std::printf("%.0f %.0f %.9f %.0f\n", read.operations, read.bytes, read.seconds,
                peak_memory_bytes());
    return read.bytes > 0 ? 0 : 1;
}

std::string each(const format::KindStatistics& kind) {
    return kind.count == 0
               ? ""
               : number(static_cast<double>(kind.bytes) / static_cast<double>(kind.count));
}

// An interval is reached by a line of the hatch or by a travel, and is a line itself.
std::string each_interval(const format::Statistics& statistics) {
    const format::KindStatistics& lines = statistics.hatch_lines;
    return each({(lines.count + statistics.hatch_travels) / 2, lines.bytes});
}

void add_reading(Table& table, const std::string& name, const Read& read) {
    table.rows.push_back({name, number(read.bytes / million) + " MB",
                          number(read.operations / million) + " million",
                          number(read.operations / read.seconds / million) + " million/s",
                          number(read.bytes / read.seconds / million) + " MB/s"});
}

bool show_sizes(const std::vector<std::string>& paths) {
    Table table{
        "Bytes an operation",
        {"file", "bytes", "line", "arc", "circle", "hatch line", "hatch interval", "travel"},
        {}};
    for (const std::string& path : paths) {
        auto reader = format::Reader::open(path);
        const auto statistics = reader ? format::statistics_of(*reader) : reader.error();
        if (!statistics) {
            std::fprintf(stderr, "bench_lyr: %s\n", to_string(statistics.error()).c_str());
            return false;
        }
        table.rows.push_back(
            {std::filesystem::path(path).stem().string(), std::to_string(statistics->bytes),
             each(statistics->lines), each(statistics->arcs), each(statistics->circles),
             each(statistics->hatch_lines), each_interval(*statistics), each(statistics->travels)});
    }
    print(table);
    return true;
}

Read fastest(const std::string& path) {
    Read best;
    double spent_s = 0;
    for (int run = 0; run < runs && spent_s < enough_s; ++run) {
        const Read read = read_once(path);
        spent_s += read.seconds;
        if (run == 0 || read.seconds < best.seconds) best = read;
    }
    return best;
}

void require_fast(Requirements& out, const std::string& what, const Read& read) {
    const double million_s = read.operations / read.seconds / million;
    const double mb_s = read.bytes / read.seconds / million;
    if (mb_s >= least_mb_s && million_s < least_million_s)
        out.push_back({what + ", read", mb_s, least_mb_s, false, " MB/s"});
    else
        out.push_back({what + ", read", million_s, least_million_s, false, " million/s"});
}

bool time_reading(const std::vector<std::string>& paths) {
    Table table{"Reading", {"file", "bytes", "operations", "", ""}, {}};
    Requirements requirements;
    for (const std::string& path : paths) {
        const std::string name = std::filesystem::path(path).stem().string();
        const Read read = fastest(path);
        add_reading(table, name, read);
        require_fast(requirements, name, read);
    }
    const auto file = ScratchFile::with("");
    if (!file || !write_long_print(paths.back(), file->path(), long_print_bytes)) {
        std::fprintf(stderr, "bench_lyr: cannot write a file of 1 GB\n");
        return false;
    }
    const Read read = fastest_apart(file->path());
    add_reading(table, "the last one over and over", read);
    print(table);
    require_fast(requirements, "1 GB", read);
    requirements.push_back(
        {"1 GB, peak memory", read.peak_bytes / million, most_memory_mb, true, " MB"});
    return print(requirements);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc == 3 && std::strcmp(argv[1], "--read") == 0) return read_and_tell(argv[2]);
    const std::vector<std::string> paths(argv + 1, argv + argc);
    if (paths.empty()) {
        std::fprintf(stderr, "usage: bench_lyr print.lyr...\n");
        return 2;
    }
    if (!show_sizes(paths)) return 3;
    print(time_lyr_kinds());
    return time_reading(paths) ? 0 : 1;
}
