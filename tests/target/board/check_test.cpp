// Contract of target/board/check.h, by number, on boards that are folders.

#include "target/board/check.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "scratch.h"
#include "target/thermal/kernel_pwm.h"

using namespace lyr;
using namespace lyr::board;

namespace {

// The files of a board on which everything is right.
class Folder {
public:
    Folder() : root_(lyr::tests::scratch_folder("board")) {
        put("sys/kernel/realtime", "1\n");
        put("proc/sys/kernel/osrelease", "6.1.0-rt-arm64\n");
        put("proc/sys/kernel/sched_rt_runtime_us", "-1\n");
        put("sys/devices/system/clocksource/clocksource0/current_clocksource",
            "arch_sys_counter\n");
        put("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "performance\n");
        put("dev/watchdog", "");
        put("sys/adc", "3700\n");
        put("sys/pwm/period", "1000000\n");
        put("sys/pwm/duty_cycle", "0\n");
        put("sys/pwm/enable", "0\n");
    }
    ~Folder() { std::filesystem::remove_all(root_); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    void put(const std::string& file, const std::string& text) const {
        std::filesystem::create_directories((root_ / file).parent_path());
        std::ofstream(root_ / file) << text;
    }
    void remove(const std::string& file) const { std::filesystem::remove_all(root_ / file); }
    std::string root() const { return root_.string(); }

private:
    std::filesystem::path root_;
};

config::Printer good_printer() {
    config::Printer printer = config::generic_printer();
    std::uint32_t line = 2;
    for (config::Axis& axis : printer.axes) {
        axis.step = config::Pin{"gpiochip0", line++};
        axis.direction = config::Pin{"gpiochip0", line++};
    }
    printer.heaters[config::heater_bed].reset();
    printer.heaters[config::heater_tool]->output = config::Pin{"gpiochip0", "HEAT"};
    printer.heaters[config::heater_tool]->sensor.file = "/sys/adc";
    printer.part_fan->pwm = "/sys/pwm";
    printer.timing.late_ns = 20'000;
    printer.watchdog.device = "/dev/watchdog";
    return printer;
}

Board good_board(const Folder& folder) {
    const auto look_up = [](const gpio::LineRequest& request) -> Result<gpio::FoundLine> {
        const auto* number = std::get_if<std::uint32_t>(&request.line);
        if (number) return gpio::FoundLine{request.chip, *number, "", std::nullopt};
        return gpio::FoundLine{request.chip, 20, std::get<std::string>(request.line), std::nullopt};
    };
    return {folder.root(), look_up, [] { return Diagnostics{}; }};
}

// The finding about `subject` that is no note.
Finding problem(const std::vector<Finding>& findings, const std::string& subject) {
    for (const Finding& finding : findings)
        if (finding.subject == subject && finding.severity != Severity::note) return finding;
    FAIL("nothing is found wrong with " << subject);
    return {};
}

bool says(const Finding& finding, Severity severity, const std::string& text) {
    return finding.severity == severity && finding.message.find(text) != std::string::npos;
}

}  // namespace

TEST_CASE("check 1: a board on which all is right has only good findings, each line among them") {
    const Folder folder;
    const auto findings = check(good_printer(), good_board(folder));
    const std::string text = text_of(findings);
    CHECK_MESSAGE(worst(findings) == Severity::note, text);
    CHECK(text.find("axis.y.step: line 4 of gpiochip0, free\n") != std::string::npos);
    CHECK(text.find("heater.tool.output: line 20 of gpiochip0 (HEAT), free") != std::string::npos);
    CHECK(text.find("heater.tool.sensor: reads 3700, 4") != std::string::npos);
    CHECK(text.find("fan.part.pwm: a period of 1000000 ns") != std::string::npos);
    CHECK(text.find("0 errors, 0 warnings\n") != std::string::npos);
}

TEST_CASE("check 1, 3: lines that are missing, held or two keys' are errors by their keys") {
    const Folder folder;
    config::Printer printer = good_printer();
    printer.axes[config::axis_z].direction.reset();
    printer.axes[config::axis_e].enable = config::Pin{"gpiochip0", "SAME"};
    Board board = good_board(folder);
    board.look_up_line = [](const gpio::LineRequest& request) -> Result<gpio::FoundLine> {
        if (request.purpose == "axis.x.step")
            return Diagnostic{Severity::error,
                              ExitStatus::machine,
                              "axis.x.step: line 2 of gpiochip0 does not exist",
                              {}};
        if (request.purpose == "axis.y.step") return gpio::FoundLine{"gpiochip0", 4, "", "spi0"};
        const auto* number = std::get_if<std::uint32_t>(&request.line);
        return gpio::FoundLine{"gpiochip0", number ? *number : 9, "", std::nullopt};
    };
    const auto findings = check(printer, board);
    CHECK(worst(findings) == Severity::error);
    const Finding missing = problem(findings, "axis.x.step");
    CHECK(missing.message == "line 2 of gpiochip0 does not exist");
    CHECK(says(problem(findings, "axis.y.step"), Severity::error, "held by spi0"));
    CHECK(says(problem(findings, "axis.z.direction"), Severity::error, "missing"));
    CHECK(says(problem(findings, "axis.e.enable"), Severity::error, "is axis.e.direction too"));
    CHECK(text_of(findings).find("error    axis.e.enable: ") != std::string::npos);
}

TEST_CASE("check 5: on one processor the heaters' guards would starve beside busy motors") {
    const Folder folder;
    const auto found = [&](const char* online, const char* runtime_us) {
        folder.put("sys/devices/system/cpu/online", online);
        folder.put("proc/sys/kernel/sched_rt_runtime_us", runtime_us);
        return check(good_printer(), good_board(folder));
    };
    CHECK(says(problem(found("0\n", "-1\n"), "processor"), Severity::error,
               "sched_rt_runtime_us=950000"));
    const auto alone = found("0\n", "950000\n");
    CHECK(says(problem(alone, "processor"), Severity::warning, "up to a second"));
    // Nor is the advice for more of them given.
    CHECK(text_of(alone).find("sched_rt_runtime_us") == std::string::npos);
    for (const char* several : {"0-3\n", "0,2\n"})
        CHECK(worst(found(several, "-1\n")) == Severity::note);
}

TEST_CASE("check 1: sensors that are missing, not plugged in or not believable are told") {
    const Folder folder;
    const auto tool = [&](const std::string& raw) {
        folder.put("sys/adc", raw);
        const auto findings = check(good_printer(), good_board(folder));
        return problem(findings,
                       raw == "no number" ? "heater.tool.sensor.file" : "heater.tool.sensor");
    };
    CHECK(says(tool("4095"), Severity::warning, "plugged in"));
    CHECK(says(tool("0"), Severity::warning, "short circuit"));
    CHECK(says(tool("300"), Severity::warning, "pullup_ohm"));
    CHECK(says(tool("no number"), Severity::error, "no number"));
    folder.remove("sys/adc");
    const auto findings = check(good_printer(), good_board(folder));
    CHECK(says(problem(findings, "heater.tool.sensor.file"), Severity::error, "driver"));
}

TEST_CASE("check 1: PWM channels that are not exported or have no period are told") {
    const Folder folder;
    folder.put("sys/pwm/period", "0\n");
    const auto fan = [&] {
        return problem(check(good_printer(), good_board(folder)), "fan.part.pwm");
    };
    CHECK(says(fan(), Severity::error, "has no period"));
    folder.remove("sys/pwm");
    CHECK(says(fan(), Severity::error, "export"));
}

TEST_CASE("check 1: a PWM channel that a print has in use was good") {
    const Folder folder;
    {
        const auto held = thermal::KernelPwm::open(folder.root() + "/sys/pwm");
        REQUIRE(held.ok());
        CHECK(says(problem(check(good_printer(), good_board(folder)), "fan.part.pwm"),
                   Severity::error, "in use"));
    }
    CHECK(worst(check(good_printer(), good_board(folder))) == Severity::note);
}

TEST_CASE("check 3: two paths to one channel or sensor were two of them") {
    const Folder folder;
    std::filesystem::create_directory_symlink("pwm", folder.root() + "/sys/pwm0");
    std::filesystem::create_symlink("adc", folder.root() + "/sys/adc0");
    config::Printer printer = good_printer();
    auto& tool = printer.heaters[config::heater_tool];
    auto& bed = printer.heaters[config::heater_bed];
    tool->output.reset();
    tool->pwm = "/sys/pwm0";
    bed = tool;
    bed->pwm.clear();
    bed->sensor.file = "/sys/adc0";
    const auto findings = check(printer, good_board(folder));
    CHECK(says(problem(findings, "fan.part.pwm"), Severity::error, "is heater.tool.pwm too,"));
    CHECK(says(problem(findings, "heater.bed.sensor.file"), Severity::error,
               "is heater.tool.sensor.file too,"));
}

TEST_CASE("check 1: what makes a board late, or leaves it unwatched, is a warning with a remedy") {
    const Folder folder;
    const std::string kernel = "proc/sys/kernel/sched_rt_runtime_us";
    const auto wrong = [&](const std::string& subject) {
        return problem(check(good_printer(), good_board(folder)), subject);
    };
    folder.put(kernel, "950000\n");
    CHECK(says(wrong("kernel"), Severity::warning, "sched_rt_runtime_us=-1"));
    folder.put(kernel, "-1\n");
    folder.remove("sys/kernel/realtime");
    CHECK(says(wrong("kernel"), Severity::warning, "6.1.0-rt-arm64 is not PREEMPT_RT"));
    folder.put("sys/devices/system/clocksource/clocksource0/current_clocksource", "hpet\n");
    CHECK(says(wrong("clock"), Severity::warning, "hpet is slow"));
    folder.put("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "ondemand\n");
    CHECK(says(wrong("processor"), Severity::warning, "performance"));
    config::Printer printer = good_printer();
    printer.watchdog.device.clear();
    const auto unguarded = [&] {
        return problem(check(printer, good_board(folder)), "watchdog.device");
    };
    CHECK(says(unguarded(), Severity::warning, "this board has /dev/watchdog"));
    folder.remove("dev/watchdog");
    CHECK(says(unguarded(), Severity::warning, "hangs"));
    CHECK(says(wrong("watchdog.device"), Severity::error, "/dev/watchdog is not there"));
    folder.put("sys/devices/system/cpu/online", "0,2-3\n");
    folder.put("sys/devices/system/cpu/isolated", "3\n");
    const auto on_cpu = [&](unsigned cpu) {
        printer.timing.cpu = cpu;
        return problem(check(printer, good_board(folder)), "timing.cpu");
    };
    CHECK(says(on_cpu(0), Severity::warning, "isolcpus=0"));
    CHECK(says(on_cpu(1), Severity::error, "which has 0,2-3"));
    CHECK(says(on_cpu(2), Severity::warning, "isolcpus=2"));
    CHECK(says(on_cpu(4), Severity::error, "no processor of this board"));
    printer.timing.cpu = 3;
    for (const Finding& finding : check(printer, good_board(folder)))
        if (finding.subject == "timing.cpu") CHECK(finding.severity == Severity::note);
    printer.timing.late_ns.reset();
    Board board = good_board(folder);
    board.privileges = [] {
        return Diagnostics{{Severity::warning, ExitStatus::ok, "refused: raise `ulimit -r`", {}}};
    };
    const auto findings = check(printer, board);
    CHECK(says(problem(findings, "timing"), Severity::warning, "--measure-latency"));
    CHECK(says(problem(findings, "privileges"), Severity::warning, "ulimit"));
    CHECK(worst(findings) == Severity::warning);
}

TEST_CASE("check 1: that journals have no place was found by the first loss of power") {
    const Folder folder;
    config::Printer printer = good_printer();
    printer.recovery_folder = "/var/lyr";
    const auto finding = [&] {
        return problem(check(printer, good_board(folder)), "recovery.folder");
    };
    CHECK(says(finding(), Severity::warning, "/var/lyr is no folder"));
    folder.put("var/lyr", "");
    CHECK(says(finding(), Severity::warning, "/var/lyr is no folder"));
    folder.remove("var/lyr");
    folder.put("var/lyr/part.lyr.journal", "");
    for (const Finding& found : check(printer, good_board(folder)))
        if (found.subject == "recovery.folder") CHECK(found.severity == Severity::note);
    // The superuser may write anywhere.
    if (::geteuid() == 0) return;
    std::filesystem::permissions(folder.root() + "/var/lyr", std::filesystem::perms::owner_read);
    CHECK(says(finding(), Severity::warning, "may not be written"));
    std::filesystem::permissions(folder.root() + "/var/lyr", std::filesystem::perms::owner_all);
}

TEST_CASE("check 6: any bytes in any file are findings") {
    const Folder folder;
    std::mt19937 random(8);
    for (int run = 0; run < 50; ++run) {
        for (const char* file :
             {"sys/adc", "sys/pwm/period", "sys/kernel/realtime", "proc/sys/kernel/osrelease",
              "proc/sys/kernel/sched_rt_runtime_us"}) {
            std::string text(random() % 300, '\0');
            for (char& c : text) c = static_cast<char>(random());
            folder.put(file, text);
        }
        const auto findings = check(good_printer(), good_board(folder));
        CHECK(worst(findings) != Severity::note);
        const std::string json = json_of("a \"b\"", findings);
        CHECK(json.starts_with(R"({"printer":"a \"b\"","errors":)"));
        CHECK(std::count(json.begin(), json.end(), '\n') == 1);
        const std::string text = text_of(findings);
        CHECK(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) ==
              findings.size() + 1);
    }
}

TEST_CASE("check 3: sample files use no line of a Raspberry Pi twice, by number and by name") {
    const Folder folder;
    Board board = good_board(folder);
    board.look_up_line = [](const gpio::LineRequest& request) -> Result<gpio::FoundLine> {
        const auto* name = std::get_if<std::string>(&request.line);
        // Other boards' names have no number.
        if (name && !name->starts_with("GPIO"))
            return gpio::FoundLine{*name, 0, *name, std::nullopt};
        const auto number = name ? static_cast<std::uint32_t>(std::stoul(name->substr(4)))
                                 : std::get<std::uint32_t>(request.line);
        return gpio::FoundLine{request.chip, number, "", std::nullopt};
    };
    std::size_t files = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string(LYR_FIXTURES) + "/printers")) {
        if (entry.path().extension() != ".toml") continue;
        const auto printer = config::read_printer(entry.path().string());
        REQUIRE(printer.ok());
        ++files;
        for (const Finding& finding : check(*printer, board))
            CHECK_MESSAGE(finding.message.find(" too: give") == std::string::npos,
                          entry.path().filename().string()
                              << ": " << finding.subject << ": " << finding.message);
    }
    CHECK(files >= 3);
}
