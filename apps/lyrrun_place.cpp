#include "apps/lyrrun_place.h"

#include <algorithm>

#include "apps/files.h"
#include "apps/progress_line.h"
#include "base/replace_file.h"
#include "base/text.h"
#include "target/home/filament.h"

namespace lyr::command_line {
namespace {

// "xz"; each axis once at the most.
std::optional<home::AxisSet> axes_of(const std::string& letters) {
    home::AxisSet axes;
    for (const char letter : letters) {
        const auto axis = static_cast<std::size_t>(letter - 'x');
        if (letter < 'x' || letter > 'z' || axes[axis]) return std::nullopt;
        axes.set(axis);
    }
    return axes;
}

// "x=10,z=-1"; each axis once at the most.
std::optional<motion::Point> way_of(const std::string& text) {
    motion::Point way;
    std::string seen;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const std::string part = text.substr(begin, end - begin);
        begin = end + 1;
        if (part.size() < 3 || part[1] != '=' || seen.find(part[0]) != std::string::npos)
            return std::nullopt;
        const std::optional<double> value = finite_number(part.substr(2));
        if (!value || part[0] < 'x' || part[0] > 'z') return std::nullopt;
        seen += part[0];
        (part[0] == 'x' ? way.x : part[0] == 'y' ? way.y : way.z) = *value;
    }
    return way;
}

Status keep(const config::Printer& printer) {
    Result<ReplaceFile> file = ReplaceFile::open(printer.calibration_file);
    if (!file) return file.error();
    file->write(home::calibration_toml(printer));
    return file->commit();
}

Status calibrate(const Program& program, std::vector<home::Calibration> wanted, home::Job job) {
    if (wanted.empty()) {
        if (job.printer.kinematics == config::Kinematics::delta)
            wanted.push_back(home::Calibration::delta);
        wanted.push_back(home::Calibration::mesh);
    }
    std::string text = '"' + job.printer.name + '"' + (job.simulate ? ", simulated\n" : "\n");
    ProgressLine line;
    for (const home::Calibration what : wanted) {
        const std::string name(home::calibration_names[static_cast<std::size_t>(what)]);
        const auto found = home::calibrate(job, what, [&](std::size_t done, std::size_t of) {
            line.show(name + ": place " + std::to_string(done + 1) + " of " + std::to_string(of));
        });
        line.clear();
        if (!found) return found.error();
        show(program, found->warnings);
        text += found->text;
        job.printer = found->printer;
    }
    const std::string& file = job.printer.calibration_file;
    // A real print would follow the bed of a machine that never was.
    if (job.simulate || file.empty())
        return tell(text +
                    (file.empty()
                         ? "The printer's file names no calibration_file to keep this in; it is\n\n"
                         : "Simulated, it is not kept in " + file + "; it is\n\n") +
                    home::calibration_toml(job.printer));
    if (const Status kept = keep(job.printer); !kept) return kept;
    return tell(text + "  kept in " + file + '\n');
}

Status feed(const Program& program, const PlaceArguments& arguments, const home::Job& job) {
    const Result<home::Fed> fed = home::feed(job, *arguments.feed_mm, arguments.tool_c);
    if (!fed) return fed.error();
    show(program, fed->warnings);
    return tell('"' + job.printer.name + '"' + (job.simulate ? ", simulated\n" : "\n") +
                formatted("  filament: %g mm at %g mm/s, %lld steps; the tool is off\n",
                          *arguments.feed_mm, fed->speed_mm_s, static_cast<long long>(fed->steps)));
}

}  // namespace

void add_place_options(Options& app, PlaceArguments& arguments) {
    add_text(
        app, "--home", "[AXES]",
        [&arguments](const std::string& value) -> std::optional<std::string> {
            arguments.home = axes_of(value);
            if (!arguments.home) return "axes such as xyz";
            return std::nullopt;
        },
        "Find where the head is, by endstops and probe, in place of a print; without AXES all "
        "axes that have one");
    add_text(
        app, "--jog", "x=MM,y=MM,z=MM",
        [&arguments](const std::string& value) -> std::optional<std::string> {
            if (value.starts_with("e="))
                arguments.feed_mm = finite_number(value.substr(2));
            else
                arguments.jog_mm = way_of(value);
            if (!arguments.jog_mm && !arguments.feed_mm)
                return "axes with ways, such as x=10,z=-1, or e=20 alone";
            return std::nullopt;
        },
        "Move the head by so much from the start of a print, in place of one; homes first where "
        "the printer can, else the head is in the middle of its ranges. e=MM alone: push filament, "
        "or draw it out, with --tool");
    add_text(
        app, "--tool", "C",
        [&arguments](const std::string& value) -> std::optional<std::string> {
            arguments.tool_c = finite_number(value);
            if (!arguments.tool_c || *arguments.tool_c <= 0) return "a temperature in °C";
            return std::nullopt;
        },
        "With --jog e=MM: heat the tool to this before, and let it cool down afterwards");
    add_text(
        app, "--calibrate", "[WHAT]",
        [&arguments](const std::string& value) -> std::optional<std::string> {
            arguments.calibrate.emplace();
            const auto& names = home::calibration_names;
            const auto name = std::find(names.begin(), names.end(), value);
            if (name != names.end())
                arguments.calibrate->push_back(
                    static_cast<home::Calibration>(name - names.begin()));
            else if (!value.empty())
                return "probe, delta or mesh";
            return std::nullopt;
        },
        "Measure with the probe its own height, a delta's frame or the bed's heights (probe, "
        "delta, "
        "mesh), and keep it in the printer's calibration_file; without WHAT a delta's frame and "
        "the heights");
}

bool counts_on_height(const config::Printer& printer) {
    return !home::homed_before_print(printer, true)[config::axis_z];
}

Status work_place(const Program& program, const PlaceArguments& arguments, const home::Job& job) {
    if (arguments.feed_mm) return feed(program, arguments, job);
    // Homing lifts the head at least.
    const bool leaves =
        !arguments.jog_mm || arguments.jog_mm->z != 0 || home::homable(job.printer).any();
    if (leaves && !job.simulate && counts_on_height(job.printer))
        if (Status rests = run::check_none_rests(job.printer); !rests) return rests;
    if (arguments.calibrate) return calibrate(program, *arguments.calibrate, job);
    home::AxisSet axes = arguments.home.value_or(home::AxisSet());
    if (axes.none()) axes = home::homable(job.printer);
    if (arguments.home && axes.none())
        return machine_error("printer \"" + job.printer.name +
                             "\" has no endstops: give axis.x.endstop and others");
    const Result<home::Report> report = home::home(job, axes, arguments.jog_mm);
    if (!report) return report.error();
    show(program, report->warnings);
    return tell('"' + job.printer.name + '"' + (job.simulate ? ", simulated\n" : "\n") +
                home::text_of(*report));
}

}  // namespace lyr::command_line
