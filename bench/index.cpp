#include "bench/index.h"

#include <filesystem>

#include "bench/measure.h"
#include "bench/scratch_file.h"
#include "bench/tower.h"
#include "parser/part21/part21.h"

namespace lyr::bench {
namespace {

constexpr std::size_t storeys = 12500;
constexpr int runs = 7;
constexpr double enough_s = 10;
constexpr double required_mb_s = 250;

}  // namespace

Status measure_index(Requirements& requirements) {
    const auto file = ScratchFile::with(tower_step(storeys));
    if (!file) return file.error();
    const double megabytes = static_cast<double>(std::filesystem::file_size(file->path())) / 1e6;
    std::size_t instances = 0;
    std::optional<Diagnostic> error;
    const Times times = repeat(runs, enough_s, [&] {
        const auto read = part21::File::open(file->path());
        if (read) {
            instances = read->instance_count();
        } else {
            error = read.error();
        }
    });
    if (error) return *error;
    print({"Index pass of the parser, MB/s, " + std::to_string(runs) + " runs",
           {"file", "MB", "instances", "fastest", "median", "slowest"},
           {{"generated tower", number(megabytes), std::to_string(instances),
             number(megabytes / times.least_s), number(megabytes / times.median_s),
             number(megabytes / times.greatest_s)}}});
    requirements.push_back({.what = "index pass, median",
                            .measured = megabytes / times.median_s,
                            .wanted = required_mb_s,
                            .unit = " MB/s"});
    return Done{};
}

}  // namespace lyr::bench
