// bench_compare: figures of ours beside OCCT's and PrusaSlicer's, from the same run, as tables.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <string>
#include <vector>

#include "bench/accuracy.h"
#include "bench/index.h"
#include "bench/job.h"
#include "bench/measure.h"
#include "bench/occt.h"
#include "bench/reading.h"
#include "bench/scaling.h"
#include "bench/sections.h"
#include "bench/step_files.h"
#include "bench/table.h"

namespace {

using namespace lyr;
using namespace lyr::bench;

const std::string parts = LYR_FIXTURES "/parts/";

struct Arguments {
    std::vector<std::string> only{"sections", "reading", "index", "scaling", "accuracy", "job"};
    std::string files = parts;
    std::string part;
    double layer_height_mm = 0.2;
    std::size_t points = 100'000;
};

std::string processor_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    }
    return "unknown processor";
}

void print_conditions() {
    char date[16];
    const std::time_t now = std::time(nullptr);
    std::strftime(date, sizeof date, "%Y-%m-%d", std::localtime(&now));
    std::printf(
        "%s, %s, %ld processors of which one is used, GCC %s, OCCT %s\n"
        "Times are processor time of one thread.\n",
        date, processor_name().c_str(), sysconf(_SC_NPROCESSORS_ONLN), __VERSION__,
        LYR_OCCT_VERSION);
}

std::vector<PartToCut> parts_to_cut(const Arguments& arguments) {
    if (!arguments.part.empty()) return {{arguments.part, arguments.layer_height_mm}};
    return {{parts + "gearbox_base.step", 0.2, 100}, {parts + "lower_teeth.step", 0.1, 500}};
}

Status measure_accuracies(const Arguments& arguments, Requirements& requirements) {
    for (const PartToCut& part : parts_to_cut(arguments)) {
        const Status done =
            measure_accuracy(part.path, part.layer_height_mm, arguments.points, requirements);
        if (!done) return done;
    }
    return Done{};
}

Status compare_jobs(const Arguments& arguments, Requirements& requirements) {
    for (const PartToCut& part : parts_to_cut(arguments)) {
        const Status done = compare_job(part.path, part.layer_height_mm, requirements);
        if (!done) return done;
    }
    return Done{};
}

Status run(const Arguments& arguments, Requirements& requirements) {
    for (const std::string& table : arguments.only) {
        Status done = Done{};
        if (table == "sections") compare_sections(parts_to_cut(arguments), requirements);
        if (table == "reading") compare_reading(step_files(arguments.files), requirements);
        if (table == "index") done = measure_index(requirements);
        if (table == "accuracy") done = measure_accuracies(arguments, requirements);
        if (table == "job") done = compare_jobs(arguments, requirements);
        if (table == "scaling") done = compare_scaling(requirements);
        if (!done) return done;
    }
    return Done{};
}

}  // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    CLI::App app(
        "Compares with OCCT and PrusaSlicer. Exit status: 0 all requirements met, 1 not all, else "
        "as "
        "stepc.");
    app.add_option("--only", arguments.only,
                   "Which tables: sections, reading, index, scaling, accuracy, job")
        ->check(CLI::IsMember({"sections", "reading", "index", "scaling", "accuracy", "job"}))
        ->delimiter(',');
    app.add_option("--files", arguments.files, "Folder of STEP files to read, or one file")
        ->check(CLI::ExistingPath);
    app.add_option("--part", arguments.part, "STEP file to cut, instead of the project's own")
        ->check(CLI::ExistingFile);
    app.add_option("--layer-height", arguments.layer_height_mm, "Of --part, in mm  [0.2]")
        ->check(CLI::Range(0.001, 10.0));
    app.add_option("--points", arguments.points, "To be measured for accuracy  [100000]")
        ->check(CLI::Range(1, 10'000'000));
    CLI11_PARSE(app, argc, argv);

    pin_to_one_processor();
    occt::silence();
    print_conditions();
    Requirements requirements;
    if (const Status done = run(arguments, requirements); !done) {
        std::fprintf(stderr, "bench_compare: %s\n", to_string(done.error()).c_str());
        return static_cast<int>(done.error().status);
    }
    return requirements.empty() || print(requirements) ? 0 : 1;
}
