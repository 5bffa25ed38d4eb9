// What stepc tells of a print's time and material, beside the printer's controller and the file.

#include <cmath>
#include <regex>

#include "apps/program.h"
#include "format/reader.h"

using namespace lyr;
using namespace lyr::tests;

namespace {

// What an estimate may be off.
constexpr double share_off = 0.01;
// The summary's last digit.
constexpr double rounded_to_mm = 1;

struct StatedTimes {
    double print_s = 0, layers_s = 0;
    std::uint32_t layers = 0, without = 0;
    std::string printer;
};

StatedTimes times_in(const fs::path& path) {
    auto reader = format::Reader::open(path);
    REQUIRE(reader.ok());
    StatedTimes times;
    times.print_s = reader->header().summary.estimated_time_s;
    times.printer = reader->header().metadata.printer;
    for (;;) {
        const auto next = reader->next();
        REQUIRE(next.ok());
        if (!*next) return times;
        if (!std::holds_alternative<format::LayerStart>(**next)) continue;
        const double time_s = reader->layer().state.estimated_time_s;
        times.layers_s += time_s;
        ++times.layers;
        times.without += time_s > 0 ? 0 : 1;
    }
}

// Of all rows of the summary: roles and travel.
double sum_of_minutes(const std::string& text) {
    static const std::regex row(R"(\n  [a-z ]+[ 0-9.]* ([0-9.]+)(?=\n))");
    double sum_min = 0;
    for (std::sregex_iterator it(text.begin(), text.end(), row), end; it != end; ++it)
        sum_min += std::stod((*it)[1]);
    return sum_min;
}

}  // namespace

TEST_CASE("stepc: the time it tells is that of lyrrun --simulate within 1 %") {
    const Folder folder("stepc-estimate");
    folder.copy("parts/foot_front_000.stp", "p.step");
    folder.copy("printers/cartesian.toml", "printer.toml");
    const std::string slice = "stepc p.step --at 40,40 --layer-height 0.3 ";
    for (const std::string printer : {"", "--printer printer.toml"}) {
        CAPTURE(printer);
        const Ended sliced = folder.run(slice + printer);
        CAPTURE(sliced.err);
        REQUIRE(sliced.status == 0);
        const Ended simulated = folder.run("lyrrun p.lyr --simulate --json " + printer);
        REQUIRE(simulated.status == 0);
        const double simulated_s = number_after(simulated.out, "\"print_time_s\":");
        const StatedTimes stated = times_in(folder / "p.lyr");
        CHECK(stated.layers > 10);
        CHECK(stated.without == 0);
        CHECK(std::abs(stated.print_s - simulated_s) <= share_off * simulated_s);
        CHECK(stated.layers_s == doctest::Approx(stated.print_s));
        CHECK(stated.printer == (printer.empty() ? "generic" : "cartesian on a Raspberry Pi"));
        CHECK(sliced.out.find("on printer \"" + stated.printer + '"') != std::string::npos);
        // Each of at most a dozen rows is rounded to a tenth of a minute.
        CHECK(sum_of_minutes(sliced.out) == doctest::Approx(stated.print_s / 60).epsilon(0.05));
        const double filament_mm = 1e3 * number_after(sliced.out, "filament ");
        CHECK(std::abs(filament_mm - number_after(simulated.out, "\"filament_mm\":")) <=
              rounded_to_mm / 2);
        CHECK(folder.run("lyrview p.lyr --info").out.find(", estimated by the slicer") !=
              std::string::npos);
    }
}

TEST_CASE("stepc: estimates are the same for any number of threads") {
    const Folder folder("stepc-estimate-threads");
    folder.copy("parts/cube_hole.step", "p.step");
    REQUIRE(folder.run("stepc p.step -o one.lyr --threads 1").status == 0);
    REQUIRE(folder.run("stepc p.step -o five.lyr --threads 5").status == 0);
    CHECK(text_of(folder / "one.lyr") == text_of(folder / "five.lyr"));
}

TEST_CASE("stepc --printer: a slower machine takes longer, and what is no printer is told") {
    const Folder folder("stepc-printer");
    folder.copy("parts/cuboid.step", "p.step");
    folder.copy("printers/cantilever.toml", "slow.toml");
    folder.write("wrong.toml", "nmae = \"x\"\n");
    const std::string stuck =
        std::regex_replace(text_of(folder / "slow.toml"), std::regex("max_speed_mm_s = 60"),
                           "max_speed_mm_s = 0.000001");
    folder.write("stuck.toml", stuck);
    REQUIRE(folder.run("stepc p.step -o quick.lyr").status == 0);
    REQUIRE(folder.run("stepc p.step -o slow.lyr --printer slow.toml").status == 0);
    REQUIRE(folder.run("stepc p.step -o piped.lyr --printer - < slow.toml").status == 0);
    CHECK(times_in(folder / "slow.lyr").print_s > times_in(folder / "quick.lyr").print_s);
    CHECK(text_of(folder / "piped.lyr") == text_of(folder / "slow.lyr"));
    const auto files = folder.files();
    const auto refused = [&](const std::string& arguments, int status, const std::string& part) {
        check_failure(folder.run("stepc p.step " + arguments), "stepc", status, part);
        CHECK(folder.files() == files);
    };
    refused("--printer wrong.toml", 3, "did you mean `name`?");
    refused("--printer stuck.toml", 3, "axis.x.max_speed_mm_s: expected a number from 0.1");
    refused("--printer none.toml", 3, "none.toml");
    refused("--printer slow.toml -o slow.toml", 2, "the printer's file");
    refused("--printer slow.toml --section-at z.txt --report r", 2, "leave out --printer");
}
