// What the G-code does is what the file says: a machine runs it, and each of its motions is compared.

#include "format/export/gcode.h"

#include <doctest/doctest.h>

#include <numbers>

#include "../../target/run/print_files.h"
#include "../files.h"
#include "../gcode_of.h"
#include "../sample.h"
#include "base/base64.h"
#include "format/arc.h"
#include "format/export/fixed_point.h"
#include "gcode_machine.h"

using namespace lyr;
using namespace lyr::format;
using test::gcode_of;
using test::GcodeMachine;
using test::GcodeMove;

namespace {

// One digit of what is written, and what doubles add.
constexpr double digit_mm = 0.001, slack_mm = 1e-9;

struct Motion {
    Operation operation;
    std::uint32_t layer = 0;  // from 1
    Point to{};
    double length_mm = 0;
    double middle_x_mm = 0, middle_y_mm = 0;
    double area_mm2 = 0;  // 0: not extruded
    double radius_mm = 0;
};

struct Print {
    std::vector<Motion> motions;
    std::vector<double> volume_mm3;  // of layers
    double filament_mm2 = 0;
};

Print print_of(const std::string& path) {
    auto reader = Reader::open(path);
    REQUIRE(reader.ok());
    const Quantum quantum = reader->header().quantum;
    Print print;
    const double diameter_mm = reader->header().metadata.filament_diameter_mm;
    print.filament_mm2 = std::numbers::pi / 4 * diameter_mm * diameter_mm;
    Point at;
    while (const Operation* operation = reader->read()) {
        Motion motion{.operation = *operation,
                      .layer = reader->layer().index + 1,
                      .area_mm2 = cross_section_mm2(reader->path())};
        if (const auto* start = std::get_if<LayerStart>(operation)) {
            print.volume_mm3.push_back(reader->layer().totals.volume_mm3);
            at = start->start;
            motion.to = at;
        }
        const auto straight = [&](const Point& from, const Point& to) {
            motion.to = to;
            motion.middle_x_mm = quantum.mm(1) * static_cast<double>(from.x + to.x) / 2;
            motion.middle_y_mm = quantum.mm(1) * static_cast<double>(from.y + to.y) / 2;
            motion.length_mm =
                quantum.mm(1) * std::hypot(to.x - from.x, to.y - from.y, to.z - from.z);
        };
        const auto round = [&](const ArcShape& shape, double climb) {
            const double middle = shape.start_angle_rad + shape.sweep_rad / 2;
            motion.radius_mm = quantum.mm(1) * shape.radius;
            motion.middle_x_mm = quantum.mm(1) * (shape.center_x + shape.radius * std::cos(middle));
            motion.middle_y_mm = quantum.mm(1) * (shape.center_y + shape.radius * std::sin(middle));
            motion.length_mm = quantum.mm(1) * std::hypot(shape.length(), climb);
        };
        if (const auto* line = std::get_if<Line>(operation)) {
            straight(line->from, line->to);
        } else if (const auto* travel = std::get_if<Travel>(operation)) {
            straight(at, travel->to);
            motion.area_mm2 = 0;
        } else if (const auto* wipe = std::get_if<Wipe>(operation)) {
            straight(wipe->from, wipe->to);
            if (wipe->sagitta != 0) round(arc_shape(Arc{wipe->from, wipe->to, wipe->sagitta}), 0);
        } else if (const auto* arc = std::get_if<Arc>(operation)) {
            motion.to = arc->to;
            round(arc_shape(*arc), static_cast<double>(arc->to.z - arc->from.z));
        } else if (const auto* circle = std::get_if<Circle>(operation)) {
            motion.to = circle->to;
            ArcShape shape{static_cast<double>(circle->center_x),
                           static_cast<double>(circle->center_y)};
            shape.radius =
                std::hypot(circle->from.x - circle->center_x, circle->from.y - circle->center_y);
            shape.start_angle_rad =
                std::atan2(circle->from.y - circle->center_y, circle->from.x - circle->center_x);
            shape.sweep_rad = 2 * std::numbers::pi;
            round(shape, 0);
        } else if (!std::holds_alternative<LayerStart>(*operation)) {
            continue;
        }
        at = motion.to;
        const bool begins = std::holds_alternative<LayerStart>(*operation);
        if (motion.length_mm > 0 || begins) print.motions.push_back(motion);
    }
    REQUIRE(!reader->error());
    return print;
}

// Motions of the G-code behind the way to a layer's start, one for one or, as chords, several for one.
void check_motions(const Print& print, const GcodeMachine& machine, Quantum quantum) {
    std::vector<GcodeMove> moves;
    for (const GcodeMove& move : machine.moves)
        if (move.moves() && move.layer > 0) moves.push_back(move);
    std::size_t at = 0;
    for (const Motion& motion : print.motions) {
        CAPTURE(motion.layer);
        const auto is_there = [&](const test::GcodePlace& place) {
            return std::abs(place.x - quantum.mm(motion.to.x)) < digit_mm / 2 + slack_mm &&
                   std::abs(place.y - quantum.mm(motion.to.y)) < digit_mm / 2 + slack_mm &&
                   std::abs(place.z - quantum.mm(motion.to.z)) < digit_mm / 2 + slack_mm;
        };
        if (std::holds_alternative<LayerStart>(motion.operation)) {
            while (at < moves.size() && !is_there(moves[at].from)) ++at;
            continue;
        }
        const bool is_wipe = std::holds_alternative<Wipe>(motion.operation);
        double length_mm = 0, nearest = 1e9;
        const std::size_t first = at;
        for (; at < moves.size(); ++at) {
            const auto middle = moves[at].middle();
            nearest = std::min(
                nearest, std::hypot(middle.x - motion.middle_x_mm, middle.y - motion.middle_y_mm));
            length_mm += moves[at].length();
            CHECK(moves[at].off_circle() * (moves[at].sweep_rad != 0) < 0.0002);
            CHECK(moves[at].wipes == is_wipe);
            if (is_there(moves[at].to) && length_mm > motion.length_mm / 2) break;
        }
        REQUIRE(at < moves.size());
        CAPTURE(moves[at].line);
        const bool is_chords = motion.radius_mm > 0 && moves[first].sweep_rad == 0;
        if (is_chords)
            CHECK((motion.radius_mm > largest_arc_mm || motion.radius_mm < smallest_arc_mm));
        // The ends of chords are each rounded; so are an arc's ends and its centre, by up to digit_mm / sqrt(2), which
        // its turn multiplies.
        const double turn_rad = is_chords ? 0 : std::abs(moves[first].sweep_rad);
        const double most_off_mm = is_chords
                                       ? digit_mm * static_cast<double>(at - first + 1)
                                       : digit_mm * (0.5 + turn_rad * std::numbers::sqrt2 / 2);
        CHECK(std::abs(length_mm - motion.length_mm) < most_off_mm);
        if (first == at) CHECK(nearest < 2 * digit_mm);
        if (!is_chords && !std::holds_alternative<Circle>(motion.operation)) CHECK(first == at);
        ++at;
    }
}

// 0.1 % is what is asked for; rounding leaves much less.
void check_volume(const Print& print, const GcodeMachine& machine) {
    std::vector<double> filament_mm(print.volume_mm3.size() + 1);
    for (const GcodeMove& move : machine.moves)
        if (move.moves() && !move.wipes)
            filament_mm[static_cast<std::size_t>(move.layer)] += move.filament_mm;
    for (std::size_t i = 0; i < print.volume_mm3.size(); ++i) {
        CAPTURE(i);
        const double volume_mm3 = filament_mm[i + 1] * print.filament_mm2;
        CHECK(volume_mm3 ==
              doctest::Approx(print.volume_mm3[i]).epsilon(1e-6).scale(print.volume_mm3[i] + 100));
    }
}

const GcodeOptions all_options[] = {{.flavor = GcodeFlavor::marlin, .relative_extrusion = true},
                                    {.flavor = GcodeFlavor::marlin, .relative_extrusion = false},
                                    {.flavor = GcodeFlavor::klipper, .relative_extrusion = true},
                                    {.flavor = GcodeFlavor::klipper, .relative_extrusion = false}};

std::string random_file(std::uint32_t seed, Quantum quantum, Metadata metadata = {}) {
    std::vector<EncodedLayer> layers;
    for (std::uint32_t i = 0; i < 3; ++i) {
        test::RandomLayer layer(seed + i, 0.2 * (i + 1), quantum, 300);
        auto encoded = layer.finish();
        REQUIRE(encoded.ok());
        layers.push_back(std::move(*encoded));
    }
    const std::string path = test::scratch("gcode_" + std::to_string(seed));
    test::write_layers(path, quantum, metadata, layers);
    return path;
}

}  // namespace

TEST_CASE("gcode 1, 2, 3: motions and volumes are the file's, turned and mirrored") {
    for (const tests::Frame& frame :
         {tests::Frame{}, tests::Frame{0.7, false, 90, 80}, tests::Frame{2.1, true, 120, 60}})
        for (const tests::Case& drawn : tests::all_cases()) {
            CAPTURE(drawn.name);
            const std::string path =
                tests::write_print("gcode", {drawn.drawing, drawn.drawing}, frame);
            const Print print = print_of(path);
            for (const GcodeOptions& options : all_options) {
                const GcodeMachine machine(gcode_of(path, options));
                check_motions(print, machine, {});
                check_volume(print, machine);
            }
        }
}

TEST_CASE("gcode 1, 2, 3: random prints, of whatever quantum") {
    for (const std::uint32_t nm : {1000u, 500u, 100u, 2000u})
        for (std::uint32_t seed = 0; seed < 6; seed += 3) {
            CAPTURE(nm);
            const std::string path = random_file(seed, {nm});
            const Print print = print_of(path);
            for (const GcodeOptions& options : all_options) {
                const GcodeMachine machine(gcode_of(path, options));
                check_motions(print, machine, {nm});
                check_volume(print, machine);
            }
        }
}

TEST_CASE("gcode 3: what rounding leaves of a motion's filament goes into the next one") {
    const auto steps = [](const tests::Pen& pen) {
        pen.path();
        pen.travel(0, 0);
        for (int i = 1; i <= 5000; ++i) pen.line(0.011 * i, 0);
    };
    const std::string path = tests::write_print("gcode_steps", {steps});
    const Print print = print_of(path);
    const GcodeMachine machine(gcode_of(path, {}));
    double filament_mm = 0;
    for (const GcodeMove& move : machine.moves) filament_mm += move.filament_mm;
    CHECK(std::abs(filament_mm - print.volume_mm3[0] / print.filament_mm2) < 2e-5);
}

TEST_CASE("gcode 1: a whole circle is one command for Marlin and two halves for Klipper") {
    const std::string path = tests::write_print("gcode_circle", {tests::draw_circles});
    const GcodeMachine marlin(gcode_of(path, all_options[0])),
        klipper(gcode_of(path, all_options[2]));
    CHECK(marlin.commands.at("G3") + marlin.commands.at("G2") == 3);
    CHECK(klipper.commands.at("G3") + klipper.commands.at("G2") == 6);
    for (const GcodeMove& move : klipper.moves)
        CHECK(std::abs(move.sweep_rad) < 1.01 * std::numbers::pi);
}

TEST_CASE("gcode: heads, layers and totals are where print servers look for them") {
    Metadata metadata;
    metadata.generator = "stepc 1.2";
    metadata.source_name = "a\nb.step";
    metadata.thumbnails.push_back({16, 8, std::vector<std::byte>(100, std::byte{0xfb})});
    metadata.objects = {"left one", "right"};
    const std::string path = random_file(50, {1000}, metadata);
    const std::string text = gcode_of(path, all_options[2]);
    CHECK(text.starts_with("; generated by stepc 1.2, "));
    CHECK(text.find("\n; source = a\\nb.step\n") != std::string::npos);
    CHECK(text.find("\n; thumbnail begin 16x8 136\n; +/v7") != std::string::npos);
    CHECK(text.find("\n; thumbnail end\n") != std::string::npos);
    CHECK(text.find("\n; estimated printing time (normal mode) = 37s\n") != std::string::npos);
    CHECK(text.find("\n; total layers count = 3\n") != std::string::npos);
    CHECK(text.find("\n; first_layer_temperature = 230.5\n") != std::string::npos);
    CHECK(text.find("\nEXCLUDE_OBJECT_DEFINE NAME=left_one_1\n") != std::string::npos);
    const GcodeMachine machine(text);
    CHECK(machine.told.at("M190") == "M190 S90");
    CHECK(std::is_sorted(machine.percent.begin(), machine.percent.end()));
    CHECK(machine.percent.front() == 0);
    CHECK(machine.percent.back() == 100);
}

TEST_CASE("gcode: objects' names for Marlin have no capital, which it takes for a parameter") {
    Metadata metadata;
    metadata.objects = {"Part C", "\u00dcUT;P1 *"};
    const std::string path = random_file(50, {1000}, metadata);
    const std::string text = gcode_of(path, all_options[0]);
    CHECK(text.find("\nM486 T2\nM486 S0\nM486 Apart_c_1\nM486 S1\nM486 A__ut_p1___2\nM486 S-1\n") !=
          std::string::npos);
    CHECK(GcodeMachine(text).object_names.size() == 2);
    CHECK(gcode_of(path, all_options[2]).find("M486") == std::string::npos);
}

TEST_CASE("gcode: start lines have their placeholders filled, and heat instead of the head") {
    const std::string path = random_file(60, {1000});
    GcodeOptions options{
        .start = {"START BED={bed_temperature} T={nozzle_temperature}", "; {{x}} {layers}"},
        .end = {"END {high_z}"}};
    const std::string text = gcode_of(path, options);
    CHECK(text.find("\nSTART BED=90 T=230.5\n; {x} 3\n") != std::string::npos);
    CHECK(text.find("\nEND ") != std::string::npos);
    const GcodeMachine machine(text);
    for (const char* absent : {"G28", "M190", "M140", "M84"})
        CHECK(!machine.commands.contains(absent));
    options.start = {"G28 ; M104"};
    CHECK(GcodeMachine(gcode_of(path, options)).commands.contains("M190"));

    options.start = {"G28", "M140 S{bed_temprature}"};
    auto reader = Reader::open(path);
    REQUIRE(reader.ok());
    Diagnostics diagnostics;
    const Status refused = write_gcode(
        *reader, options, [](std::string_view) {}, diagnostics);
    REQUIRE(!refused.ok());
    CHECK(refused.error().status == ExitStatus::usage);
    CHECK(refused.error().message.find("line 2") != std::string::npos);
    CHECK(refused.error().message.find("did you mean {bed_temperature}?") != std::string::npos);
}

TEST_CASE("gcode 4: what it cannot say is noted once, with the layer") {
    const auto drawing = [](const tests::Pen& pen) {
        pen.path();
        pen.layer.acceleration(700);
        pen.line(1, 0);
        pen.layer.acceleration(0);
        pen.line(2, 0);
        pen.layer.speed(0);
        pen.line(3, 0);
    };
    const std::string path = tests::write_print("gcode_notes", {drawing, drawing});
    Diagnostics diagnostics;
    const std::string text = gcode_of(path, {}, diagnostics);
    CHECK(diagnostics.size() == 2);
    for (const Diagnostic& diagnostic : diagnostics) {
        CHECK(diagnostic.severity == Severity::note);
        CHECK(diagnostic.where.layer == 1);
        CHECK(text.find("; " + diagnostic.message.substr(0, diagnostic.message.find(';'))) !=
              std::string::npos);
    }
}

TEST_CASE("fixed point and base64 are what others read") {
    const auto fixed = [](std::int64_t count, int decimals) {
        std::string text;
        append_fixed(text, count, decimals);
        return text;
    };
    CHECK(fixed(0, 3) == "0");
    CHECK(fixed(12300, 4) == "1.23");
    CHECK(fixed(-5, 4) == "-0.0005");
    CHECK(fixed(-70000, 4) == "-7");
    CHECK(fixed(42, 0) == "42");
    const auto letters = [](std::string_view text) {
        return base64(std::as_bytes(std::span(text)));
    };
    CHECK(letters("") == "");
    CHECK(letters("f") == "Zg==");
    CHECK(letters("fo") == "Zm8=");
    CHECK(letters("foo") == "Zm9v");
    CHECK(letters("foobar") == "Zm9vYmFy");
}
