// bench_micro: what the kernel's single steps cost. Google Benchmark measures; the figures come out as one table, a
// line a benchmark, with the spread of its repetitions. Its own options (--benchmark_filter=...) hold.

#include <benchmark/benchmark.h>

#include <string>

#include "bench/measure.h"
#include "bench/table.h"

namespace {

using namespace lyr::bench;

constexpr int repetitions = 7;

class TableReporter : public benchmark::BenchmarkReporter {
public:
    bool ReportContext(const Context&) override { return true; }

    // The runs of one benchmark, then what the library has made of them.
    void ReportRuns(const std::vector<Run>& runs) override {
        std::vector<double> seconds;
        for (const Run& run : runs) {
            if (run.error_occurred) failed_ = true;
            if (run.run_type == Run::RT_Aggregate || run.iterations == 0) continue;
            const auto rate = run.counters.find("items_per_second");
            // Work on many items states its time an item.
            seconds.push_back(rate != run.counters.end()
                                  ? 1 / rate->second.value
                                  : run.cpu_accumulated_time / static_cast<double>(run.iterations));
        }
        if (seconds.empty()) return;
        const Times times = summary(seconds);
        table_.rows.push_back({runs.front().run_name.function_name, duration(times.median_s),
                               duration(times.least_s), duration(times.greatest_s)});
    }

    void Finalize() override { print(table_); }

    bool failed() const { return failed_; }

private:
    bool failed_ = false;
    Table table_{"Single steps, processor time, " + std::to_string(repetitions) + " repetitions",
                 {"step", "median", "fastest", "slowest"},
                 {}};
};

}  // namespace

int main(int argc, char** argv) {
    pin_to_one_processor();
    // In front of the user's own options, which so have the last word.
    std::string repeat = "--benchmark_repetitions=" + std::to_string(repetitions);
    std::string least = "--benchmark_min_time=0.05";
    std::vector<char*> arguments{argv[0], repeat.data(), least.data()};
    arguments.insert(arguments.end(), argv + 1, argv + argc);
    int count = static_cast<int>(arguments.size());
    benchmark::Initialize(&count, arguments.data());
    if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
    TableReporter reporter;
    benchmark::RunSpecifiedBenchmarks(&reporter);
    return reporter.failed() ? 1 : 0;
}
