#include "bench/program.h"

#include <stdio.h>
#include <sys/wait.h>

#include "bench/measure.h"

namespace lyr::bench {
namespace {

std::string quoted(const std::string& word) {
    std::string text = "'";
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + '\'';
}

}  // namespace

Result<Usage> run_program(const std::vector<std::string>& command) {
    constexpr double bytes_per_kib = 1024;
    std::string line = quoted(LYR_BENCH_RUN);
    for (const std::string& word : command) line += ' ' + quoted(word);
    FILE* output = popen(line.c_str(), "r");
    double user_s = 0, system_s = 0;
    long peak_kib = 0;
    const int numbers =
        output == nullptr ? 0 : fscanf(output, "%lf %lf %ld", &user_s, &system_s, &peak_kib);
    const int status = output == nullptr ? -1 : pclose(output);
    if (numbers != 3 || status != 0) {
        return Diagnostic{
            Severity::error, ExitStatus::internal, "fails or cannot be run: " + line, {}};
    }
    return Usage{user_s + system_s, bytes_per_kib * static_cast<double>(peak_kib)};
}

Result<Usage> median_usage(int runs, const std::vector<std::string>& command) {
    std::vector<double> seconds, bytes;
    for (int i = 0; i < runs; ++i) {
        const auto usage = run_program(command);
        if (!usage) return usage.error();
        seconds.push_back(usage->processor_s);
        bytes.push_back(usage->peak_bytes);
    }
    return Usage{median(seconds), median(bytes)};
}

}  // namespace lyr::bench
