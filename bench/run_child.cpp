// bench_run: runs a program and says on standard output what it took: user and system time in seconds, peak resident
// memory in KiB.
//
// A program of its own because Linux counts the memory of the process that forked towards the peak of the one that
// was forked: this one is small, bench_compare with OCCT in it is not.

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>

namespace {

constexpr int cannot_run = 127;  // as shells say it

// What the program says is not for our table.
[[noreturn]] void become(char** command) {
    const int nowhere = open("/dev/null", O_RDWR);
    dup2(nowhere, STDIN_FILENO);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    execvp(command[0], command);
    _exit(cannot_run);
}

double seconds(const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) return cannot_run;
    const pid_t child = fork();
    if (child == 0) become(argv + 1);
    int status = 0;
    rusage usage{};
    if (child < 0 || wait4(child, &status, 0, &usage) != child) return cannot_run;
    std::printf("%.6f %.6f %ld\n", seconds(usage.ru_utime), seconds(usage.ru_stime),
                usage.ru_maxrss);
    return WIFEXITED(status) ? WEXITSTATUS(status) : cannot_run;
}
