#include "bench/measure.h"

#include <sched.h>
#include <sys/resource.h>
#include <time.h>

#include <algorithm>

namespace lyr::bench {

double processor_time_s() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

Times summary(const std::vector<double>& seconds) {
    const auto [least, greatest] = std::minmax_element(seconds.begin(), seconds.end());
    return {*least, median(seconds), *greatest};
}

void pin_to_one_processor() {
    const int processor = sched_getcpu();
    if (processor < 0) return;
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(processor, &set);
    // Where this is not allowed, times only vary more.
    sched_setaffinity(0, sizeof set, &set);
}

void limit_process(unsigned limit_s) {
    const rlimit no_dump{0, 0};
    setrlimit(RLIMIT_CORE, &no_dump);
    alarm(limit_s);
}

}  // namespace lyr::bench
