// One function for each thing that is looked at; each appends what it finds.

#include "target/board/check.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <map>

#include "base/read_text.h"
#include "base/text.h"
#include "target/run/heating.h"
#include "target/run/line_layout.h"
#include "target/run/real_time.h"
#include "target/thermal/sensor.h"

namespace lyr::board {
namespace {

using config::Printer;

// Of files that hold one word or number.
constexpr std::size_t most_bytes = 4'096;

class Check {
public:
    Check(const Printer& printer, const Board& board) : printer_(printer), board_(board) {}

    std::vector<Finding> all() {
        lines();
        for (std::size_t i = 0; i < config::heater_count; ++i)
            if (printer_.heaters[i]) heater(i);
        if (printer_.part_fan) channel("fan.part.pwm", printer_.part_fan->pwm);
        for (const auto& [key, message] : run::shared_files(printer_, board_.root))
            fail(key, message);
        privileges();
        kernel();
        clock();
        governor();
        timing();
        processor();
        watchdog();
        recovery();
        return std::move(findings_);
    }

private:
    void say(Severity severity, const std::string& subject, const std::string& message) {
        findings_.push_back({severity, subject, message});
    }
    void good(const std::string& subject, const std::string& message) {
        say(Severity::note, subject, message);
    }
    void warn(const std::string& subject, const std::string& message) {
        say(Severity::warning, subject, message);
    }
    void fail(const std::string& subject, const std::string& message) {
        say(Severity::error, subject, message);
    }

    // The word in a file, none where it cannot be read.
    std::optional<std::string> word(const std::string& path) const {
        const auto text = read_text(board_.root + path, most_bytes);
        if (!text) return std::nullopt;
        return escaped(text->substr(0, text->find_first_of(" \n\t")));
    }

    void lines();
    void heater(std::size_t number);
    void sensor(const std::string& section, const config::Sensor& settings);
    void channel(const std::string& key, const std::string& folder);
    void privileges();
    void kernel();
    void clock();
    void governor();
    void timing();
    void processor();
    void watchdog();
    void recovery();

    const Printer& printer_;
    const Board& board_;
    std::vector<Finding> findings_;
};

void Check::lines() {
    for (std::size_t i = 0; i < config::axis_count; ++i) {
        const std::string axis = "axis." + std::string(config::axis_names[i]);
        if (!printer_.axes[i].step) fail(axis + ".step", "is missing: a motor needs it to print");
        if (!printer_.axes[i].direction)
            fail(axis + ".direction", "is missing: a motor needs it to print");
    }
    std::map<std::pair<std::string, std::uint32_t>, std::string> users;
    for (const auto& [key, pin] : config::used_lines(printer_)) {
        const Result<gpio::FoundLine> found = board_.look_up_line(run::line_request(key, pin));
        if (!found) {
            // The key is the subject already.
            const std::string& message = found.error().message;
            fail(key, message.starts_with(key + ": ") ? message.substr(key.size() + 2) : message);
            continue;
        }
        const std::string place = "line " + std::to_string(found->number) + " of " + found->chip +
                                  (found->name.empty() ? "" : " (" + found->name + ')');
        const auto [user, fresh] = users.emplace(std::pair{found->chip, found->number}, key);
        if (!fresh)
            fail(key, place + " is " + user->second + " too: give one of them another line");
        else if (found->user)
            fail(key, place + " is held by " + *found->user +
                          ": end that program, or switch its overlay off, or take another line");
        else
            good(key, place + ", free");
    }
}

void Check::heater(std::size_t number) {
    const config::Heater& heater = *printer_.heaters[number];
    const std::string section = "heater." + std::string(config::heater_names[number]);
    if (!heater.output && heater.pwm.empty())
        warn(section, "has neither output nor pwm: only --no-heat prints");
    channel(section + ".pwm", heater.pwm);
    if (heater.sensor.file.empty())
        warn(section + ".sensor.file", "is missing: only --no-heat prints");
    else
        sensor(section + ".sensor", heater.sensor);
}

void Check::sensor(const std::string& section, const config::Sensor& settings) {
    const auto opened = thermal::open_file_sensor(board_.root + settings.file);
    const Result<double> raw = opened ? (*opened)->read() : Result<double>(opened.error());
    if (!raw) {
        fail(section + ".file", settings.file + ": " + raw.error().message +
                                    ": is the driver loaded (dmesg), and may this user read it?");
        return;
    }
    const thermal::Measured measured = thermal::measure(thermal::SensorScale(settings), *raw);
    const std::string reads = formatted("reads %g, %.1f °C", *raw, measured.temperature_c);
    // A printer that has stood for a while is as warm as a room.
    constexpr double coldest_room_c = -10, hottest_room_c = 60;
    if (measured.wiring == thermal::Wiring::open)
        warn(section, reads + ": as a broken wire does; is the sensor plugged in?");
    else if (measured.wiring == thermal::Wiring::shorted)
        warn(section, reads + ": as a short circuit does; are the wires sound?");
    else if (!(measured.temperature_c > coldest_room_c && measured.temperature_c < hottest_room_c))
        warn(section, reads + ": if it is not that warm, kind, pullup_ohm or full_scale is wrong");
    else
        good(section, reads);
}

// By a print or another program that heats; looked at by a lock that many may have, and that is gone with this call.
bool is_locked(const std::string& file) {
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) return false;
    const bool is_refused = ::flock(descriptor, LOCK_SH | LOCK_NB) != 0;
    ::close(descriptor);
    return is_refused;
}

void Check::channel(const std::string& key, const std::string& folder) {
    if (folder.empty()) return;
    const std::string place = board_.root + folder;
    const std::optional<std::string> period = word(folder + "/period");
    std::int64_t period_ns = 0;
    if (period) std::from_chars(period->data(), period->data() + period->size(), period_ns);
    if (!period)
        fail(key, folder + " is not there: write the channel's number to ../export of it");
    else if (period_ns <= 0)
        fail(key, folder + " has no period: write one in nanoseconds to its file period");
    else if (::access((place + "/duty_cycle").c_str(), W_OK) != 0 ||
             ::access((place + "/enable").c_str(), W_OK) != 0)
        fail(key, folder + " may not be written: give its files to the group of this user (udev)");
    else if (is_locked(place + "/duty_cycle"))
        fail(key, folder + " is in use: end that program first (fuser tells which)");
    else
        good(key, formatted("a period of %lld ns", static_cast<long long>(period_ns)));
}

void Check::privileges() {
    const Diagnostics refused = board_.privileges();
    for (const Diagnostic& diagnostic : refused) warn("privileges", diagnostic.message);
    if (refused.empty()) good("privileges", "real-time scheduling and locked memory are granted");
}

void Check::kernel() {
    const std::string release = word("/proc/sys/kernel/osrelease").value_or("of unknown release");
    if (word("/sys/kernel/realtime") == "1")
        good("kernel", release + " is PREEMPT_RT");
    else
        warn("kernel", release +
                           " is not PREEMPT_RT: it wakes a thread late now and then; "
                           "install one (Debian: linux-image-rt-*), or keep speeds low");
    const std::optional<std::string> runtime = word("/proc/sys/kernel/sched_rt_runtime_us");
    const std::string online = word("/sys/devices/system/cpu/online").value_or("");
    const bool is_alone = !online.empty() && online.find_first_of(",-") == std::string::npos;
    if (is_alone && runtime == "-1")
        fail("processor",
             "there is one, and busy motors leave nothing of it to the thread that guards the "
             "heaters: sysctl kernel.sched_rt_runtime_us=950000");
    else if (is_alone)
        warn("processor",
             "there is one: busy motors keep the thread that guards the heaters waiting for up to "
             "a second, and steps come late then; a board with two is better");
    else if (runtime && *runtime != "-1")
        warn("kernel", "stops a real-time thread that is busy for " + *runtime +
                           " us of a second, and with it the print at full speed: "
                           "sysctl kernel.sched_rt_runtime_us=-1");
}

void Check::clock() {
    const auto source =
        word("/sys/devices/system/clocksource/clocksource0/current_clocksource").value_or("");
    // Those that a program reads without a system call.
    constexpr std::array<std::string_view, 4> quick{"tsc", "arch_sys_counter", "kvm-clock",
                                                    "riscv_clocksource"};
    if (std::find(quick.begin(), quick.end(), source) != quick.end())
        good("clock", source);
    else
        warn("clock", (source.empty() ? "no source is known" : source + " is slow to read") +
                          ": every wait costs more; see the kernel's parameter clocksource=");
}

void Check::governor() {
    const auto governor = word("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
    if (!governor) return;
    if (*governor == "performance")
        good("processor", "runs at full frequency");
    else
        warn("processor", "changes its frequency (" + *governor +
                              "), which delays what comes next: cpupower frequency-set -g "
                              "performance");
}

void Check::timing() {
    if (printer_.timing.late_ns)
        good("timing", formatted("%.0f steps a second of each motor at the most",
                                 config::held_steps_per_s(printer_)));
    else
        warn("timing",
             "not measured: run lyrrun --measure-latency, and put what it prints into "
             "the printer's file");
}

// Whether a list of the kernel's, such as 0-2,5, has a number.
bool lists(std::string_view list, unsigned number) {
    const char* const end = list.data() + list.size();
    for (const char* at = list.data(); at < end; ++at) {
        unsigned first = 0;
        std::from_chars_result read = std::from_chars(at, end, first);
        unsigned last = first;
        if (read.ec == std::errc() && read.ptr < end && *read.ptr == '-')
            read = std::from_chars(read.ptr + 1, end, last);
        if (read.ec != std::errc()) return false;
        if (number >= first && number <= last) return true;
        at = read.ptr;
        if (at == end || *at != ',') return false;
    }
    return false;
}

void Check::processor() {
    if (!printer_.timing.cpu) return;
    const unsigned cpu = *printer_.timing.cpu;
    const std::string folder = "/sys/devices/system/cpu/";
    const std::string online = word(folder + "online").value_or("");
    if (!lists(online, cpu))
        fail("timing.cpu", formatted("%u is no processor of this board, which has ", cpu) + online);
    else if (!lists(word(folder + "isolated").value_or(""), cpu))
        warn("timing.cpu",
             formatted("%u is there, but other programs run there, too: the kernel's parameter "
                       "isolcpus=%u keeps it free",
                       cpu, cpu));
    else
        good("timing.cpu", formatted("%u is there, and kept free", cpu));
}

void Check::watchdog() {
    const std::string& device = printer_.watchdog.device;
    const auto may = [this](const std::string& path, int what) {
        return ::access((board_.root + path).c_str(), what) == 0;
    };
    if (device.empty())
        warn("watchdog.device",
             std::string("is missing: if the kernel hangs, lines keep their level") +
                 (may("/dev/watchdog", F_OK) ? "; this board has /dev/watchdog" : ""));
    else if (!may(device, F_OK))
        fail("watchdog.device", device + " is not there: load the driver of the board's watchdog");
    else if (!may(device, W_OK))
        fail("watchdog.device", device +
                                    " may not be written: give it to the group of this user "
                                    "(udev)");
    else
        good("watchdog.device", device + " is there");
}

void Check::recovery() {
    const std::string& folder = printer_.recovery_folder;
    if (folder.empty()) return;
    constexpr const char* what_for = ", and prints cannot be resumed after a loss of power";
    std::error_code error;
    const std::string place = board_.root + folder;
    if (!std::filesystem::is_directory(place, error))
        warn("recovery.folder", folder + " is no folder" + what_for + ": make it");
    else if (::access(place.c_str(), W_OK | X_OK) != 0)
        warn("recovery.folder",
             folder + " may not be written" + what_for + ": give it to the user who prints");
    else
        good("recovery.folder", folder + " is there");
}

Diagnostics try_privileges() {
    Diagnostics refused;
    run::try_precedence({}, refused);
    run::lock_memory(refused);
    return refused;
}

const char* name_of(Severity severity) {
    return severity == Severity::note ? "ok" : severity == Severity::warning ? "warning" : "error";
}

std::size_t count(const std::vector<Finding>& findings, Severity severity) {
    return static_cast<std::size_t>(
        std::count_if(findings.begin(), findings.end(),
                      [severity](const Finding& finding) { return finding.severity == severity; }));
}

}  // namespace

Board this_board() {
    return {"", gpio::look_up_line, try_privileges};
}

std::vector<Finding> check(const Printer& printer, const Board& board) {
    return Check(printer, board).all();
}

Severity worst(const std::vector<Finding>& findings) {
    Severity worst = Severity::note;
    for (const Finding& finding : findings) worst = std::max(worst, finding.severity);
    return worst;
}

std::string text_of(const std::vector<Finding>& findings) {
    std::string text;
    for (const Finding& finding : findings)
        text += formatted("%-8s ", name_of(finding.severity)) + finding.subject + ": " +
                finding.message + '\n';
    return text + formatted("%zu errors, %zu warnings\n", count(findings, Severity::error),
                            count(findings, Severity::warning));
}

std::string json_of(const std::string& printer, const std::vector<Finding>& findings) {
    std::string text = "{\"printer\":" + in_json(printer) +
                       ",\"errors\":" + std::to_string(count(findings, Severity::error)) +
                       ",\"warnings\":" + std::to_string(count(findings, Severity::warning)) +
                       ",\"findings\":[";
    for (const Finding& finding : findings)
        text += std::string(&finding == &findings.front() ? "" : ",") + "{\"level\":\"" +
                name_of(finding.severity) + "\",\"subject\":" + in_json(finding.subject) +
                ",\"message\":" + in_json(finding.message) + '}';
    return text + "]}\n";
}

}  // namespace lyr::board
