// Every file is read in a child process, by us and by OCCT: neither may use what earlier files left warm or leave
// memory behind, and a file that OCCT cannot survive does not end the run.

#include "bench/reading.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "bench/measure.h"
#include "bench/occt.h"
#include "slicer/slicer.h"

namespace lyr::bench {
namespace {

constexpr int most_runs = 5;  // the least counts
constexpr double enough_s = 1;
constexpr unsigned limit_s = 600;  // of a file
constexpr std::size_t most_listed = 20;
constexpr double required_ratio = 50;

struct Reading {
    double first_s;  // with memory that is new to the process
    Times times;
};

// `read` gives the processor time of one run, none if it fails.
template <class Read>
std::optional<Reading> readings(Read read) {
    return in_child(limit_s, [&]() -> std::optional<Reading> {
        std::vector<double> seconds;
        double spent_s = 0;
        while (seconds.size() < most_runs && spent_s < enough_s) {
            const std::optional<double> time_s = read();
            if (!time_s) return std::nullopt;
            seconds.push_back(*time_s);
            spent_s += *time_s;
        }
        return Reading{seconds.front(), summary(seconds)};
    });
}

std::optional<double> our_reading_time_s(const std::string& path) {
    Diagnostics found;
    bool read = false;
    const double time_s = time_of_s([&] { read = slicer::load(path, {}, found).ok(); });
    return read ? std::optional(time_s) : std::nullopt;
}

// In MB/s by file; of those files that both have read.
struct Side {
    std::vector<double> fastest, first, spread;
    std::size_t failed = 0;

    void add(double megabytes, const Reading& reading) {
        fastest.push_back(megabytes / reading.times.least_s);
        first.push_back(megabytes / reading.first_s);
        spread.push_back(reading.times.median_s / reading.times.least_s - 1);
    }
};

struct Sides {
    Side ours, occts;
    std::vector<double> ratio;
};

std::vector<std::string> measure(const std::string& path, Sides& sides) {
    const double megabytes = static_cast<double>(std::filesystem::file_size(path)) / 1e6;
    const auto ours = readings([&] { return our_reading_time_s(path); });
    const auto occts = readings([&] { return occt::reading_time_s(path); });
    if (!ours) ++sides.ours.failed;
    if (!occts) ++sides.occts.failed;
    const auto speed = [&](const std::optional<Reading>& reading) {
        return reading ? number(megabytes / reading->times.least_s) : std::string("-");
    };
    std::vector<std::string> row{std::filesystem::path(path).filename(), number(megabytes),
                                 speed(ours), speed(occts), "-"};
    if (ours && occts) {
        sides.ours.add(megabytes, *ours);
        sides.occts.add(megabytes, *occts);
        sides.ratio.push_back(occts->times.least_s / ours->times.least_s);
        row.back() = number(sides.ratio.back());
    }
    return row;
}

void print_notes(const Sides& sides, std::size_t files) {
    const auto text = [](const std::vector<double>& values, double factor = 1) {
        return number(factor * median(values));
    };
    std::printf(
        "\nOf %zu files, %zu could not be read by us, %zu by OCCT; they do not count. Medians over "
        "the files: of the "
        "ratios, %s;\nof the first run in a process, ours %s MB/s, OCCT's %s MB/s; of the middle "
        "run over the "
        "fastest, ours %s %% slower, OCCT's %s %%.\n",
        files, sides.ours.failed, sides.occts.failed, text(sides.ratio).c_str(),
        text(sides.ours.first).c_str(), text(sides.occts.first).c_str(),
        text(sides.ours.spread, 100).c_str(), text(sides.occts.spread, 100).c_str());
}

}  // namespace

void compare_reading(const std::vector<std::string>& paths, Requirements& requirements) {
    Table table{
        "Reading and import, MB/s, the fastest of up to " + std::to_string(most_runs) + " runs",
        {"file", "MB", "ours", "OCCT", "ratio"},
        {}};
    // What OCCT sets up once for all files is not to be part of any file's time.
    for (const std::string& path : paths) {
        if (readings([&] { return occt::reading_time_s(path); }) && occt::reading_time_s(path))
            break;
    }
    Sides sides;
    for (const std::string& path : paths) {
        auto row = measure(path, sides);
        if (paths.size() <= most_listed) table.rows.push_back(std::move(row));
    }
    double ratio = NAN;
    if (!sides.ratio.empty()) {
        const double ours = median(sides.ours.fastest), occts = median(sides.occts.fastest);
        ratio = ours / occts;
        table.rows.push_back({"median of " + std::to_string(sides.ratio.size()) + " files", "",
                              number(ours), number(occts), number(ratio)});
    }
    print(table);
    if (!sides.ratio.empty()) print_notes(sides, paths.size());
    requirements.push_back(
        {"reading and import, times OCCT's speed (medians)", ratio, required_ratio});
}

}  // namespace lyr::bench
