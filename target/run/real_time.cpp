// Both need a privilege that systemd or /etc/security/limits.conf can grant.

#include "target/run/real_time.h"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <thread>

namespace lyr::run {
namespace {

// Of threads: what is locked is real memory, and the usual 8 MiB of each would be most of what the
// program has. None of them goes deep.
#ifdef __SANITIZE_THREAD__
// Which keeps a megabyte of its own beside each stack.
constexpr std::size_t stack_bytes = std::size_t{1} << 23;
#else
constexpr std::size_t stack_bytes = std::size_t{1} << 19;
#endif

// Above everything that is not the kernel's own: its interrupt threads have 50.
constexpr int precedence = 49;

Diagnostic refused(const std::string& what, int error, const std::string& remedy) {
    return {Severity::warning,
            ExitStatus::ok,
            what + " was refused (" + std::strerror(error) + "): steps may come late; " + remedy,
            {}};
}

// What a print maps once its threads run: 64 MiB of addresses for the heap of each, most of them never used.
constexpr std::size_t room_bytes = std::size_t{1} << 29;

// Under a limit on locked memory whatever is mapped counts, from now on, whether it is ever touched or not: a limit that
// lets the program in may not let its threads start.
bool has_room() {
    void* const room =
        ::mmap(nullptr, room_bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    // Where the limit is another one, of addresses, it is no less without locks.
    if (room == MAP_FAILED) return errno != EAGAIN;
    ::munmap(room, room_bytes);
    return true;
}

// What the kernel answers.
int stay_on(unsigned cpu) {
    if (cpu >= CPU_SETSIZE) return EINVAL;
    cpu_set_t only;
    CPU_ZERO(&only);
    CPU_SET(cpu, &only);
    return ::pthread_setaffinity_np(::pthread_self(), sizeof only, &only);
}

}  // namespace

void keep_stacks_small() {
    pthread_attr_t attributes;
    if (::pthread_attr_init(&attributes) != 0) return;
    if (::pthread_attr_setstacksize(&attributes, stack_bytes) == 0)
        (void)::pthread_setattr_default_np(&attributes);
    ::pthread_attr_destroy(&attributes);
}

void lock_memory(Diagnostics& warnings) {
    // Each page once it is touched: all of the libraries' and of every thread's 8 MB of stack would be several times what
    // a print needs. What the real-time thread touches, it has touched before the head moves.
    int error = ::mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0 ? 0 : errno;
    if (error == 0 && !has_room()) {
        ::munlockall();
        error = ENOMEM;
    }
    if (error != 0)
        warnings.push_back(
            refused("locking memory", error, "grant CAP_IPC_LOCK or set `ulimit -l` to unlimited"));
}

void take_precedence(std::optional<unsigned> cpu, Diagnostics& warnings) {
    if (const int error = cpu ? stay_on(*cpu) : 0)
        warnings.push_back(
            refused("processor " + std::to_string(*cpu), error, "look at timing.cpu"));
    sched_param parameters{};
    parameters.sched_priority = precedence;
    if (const int error = ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameters))
        warnings.push_back(
            refused("real-time scheduling", error, "grant CAP_SYS_NICE or raise `ulimit -r`"));
}

void try_precedence(std::optional<unsigned> cpu, Diagnostics& warnings) {
    std::thread([&] { take_precedence(cpu, warnings); }).join();
}

Status check_cpu(std::optional<unsigned> cpu) {
    if (!cpu) return Done{};
    int error = 0;
    std::thread([&] { error = stay_on(*cpu); }).join();
    if (error == 0) return Done{};
    std::string online;
    std::getline(std::ifstream("/sys/devices/system/cpu/online") >> std::ws, online);
    return machine_error("timing.cpu = " + std::to_string(*cpu) +
                         ": the board has no such processor, or does not let this program run "
                         "there; it has " +
                         (online.empty() ? "others" : online));
}

}  // namespace lyr::run
