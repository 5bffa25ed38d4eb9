// Times of single-threaded work, in processor time: what it would take on a machine that does nothing else, as near
// as a shared machine can tell.

#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <optional>
#include <type_traits>
#include <vector>

namespace lyr::bench {

// Of this process, all threads.
double processor_time_s();

template <class Work>
double time_of_s(Work&& work) {
    const double start_s = processor_time_s();
    work();
    return processor_time_s() - start_s;
}

// What several runs of the same work took.
struct Times {
    double least_s = 0, median_s = 0, greatest_s = 0;
};

double median(std::vector<double> values);  // of at least one
Times summary(const std::vector<double>& seconds);

// Runs the work up to `runs` times, but stops after the run with which `enough_s` are spent.
template <class Work>
Times repeat(int runs, double enough_s, Work&& work) {
    std::vector<double> seconds;
    double spent_s = 0;
    while (runs-- > 0 && (seconds.empty() || spent_s < enough_s)) {
        seconds.push_back(time_of_s(work));
        spent_s += seconds.back();
    }
    return summary(seconds);
}

// Keeps this process on the processor that it is on.
void pin_to_one_processor();

// For a child that is to run foreign code: no core dump, and killed after `limit_s`. Elapsed time: with a limit on
// its processor time, Linux would count that in ticks of milliseconds.
void limit_process(unsigned limit_s);

// Runs the work in a child process, so that neither a crash nor memory left behind touches this one. None: the child
// was killed (by itself or after `limit_s` seconds), or the work returned none.
template <class Work>
auto in_child(unsigned limit_s, Work&& work) -> std::invoke_result_t<Work> {
    using Value = typename std::invoke_result_t<Work>::value_type;
    static_assert(std::is_trivially_copyable_v<Value>);
    int ends[2];
    if (pipe(ends) != 0) return std::nullopt;
    const pid_t child = fork();
    if (child == 0) {
        limit_process(limit_s);
        const auto value = work();
        const bool written = value && write(ends[1], &*value, sizeof(Value)) == sizeof(Value);
        _exit(written ? 0 : 1);
    }
    close(ends[1]);
    Value value;
    const bool whole = child > 0 && read(ends[0], &value, sizeof value) == sizeof value;
    close(ends[0]);
    if (child > 0) waitpid(child, nullptr, 0);
    return whole ? std::optional(value) : std::nullopt;
}

}  // namespace lyr::bench
