// Contracts of least_squares.h, delta_fit.h, probing.h and calibration.h, by number.

#include "target/home/calibration.h"

#include <cmath>
#include <numbers>
#include <random>

#include "target/home/delta_fit.h"
#include "target/home/least_squares.h"
#include "target/home/scene.h"

using namespace lyr;
using namespace lyr::home;
using namespace lyr::tests;
using config::Kinematics;

namespace {

std::vector<motion::Point> ring(double radius_mm) {
    std::vector<motion::Point> spots{{0, 0, 0}};
    for (int i = 0; i < 12; ++i) {
        const double angle_rad = i * std::numbers::pi / 6;
        const double off_mm = i % 2 == 0 ? radius_mm : radius_mm / 2;
        spots.push_back({off_mm * std::cos(angle_rad), off_mm * std::sin(angle_rad), 0});
    }
    return spots;
}

// Where the carriages of `truth` are when its nozzle is on the bed.
std::vector<Touch> touches_of(const config::Printer& truth, double noise_mm, std::mt19937& random) {
    std::vector<Touch> touches;
    for (motion::Point at : ring(85)) {
        at.z += noise_mm * (2 * static_cast<double>(random() % 1'000'001) / 1e6 - 1);
        const auto carriages = motion::motors_at(moves::kinematics_of(truth), at);
        Touch& touch = touches.emplace_back();
        for (std::size_t i = 0; i < 3; ++i)
            touch.below_endstop_mm[i] = carriage_endstop_mm(truth, i) - carriages[i];
    }
    return touches;
}

config::Printer perturbed(const config::Printer& printer, std::mt19937& random) {
    const auto within = [&](double most) {
        return most * (2 * static_cast<double>(random() % 1'000'001) / 1e6 - 1);
    };
    config::Printer truth = printer;
    const double radius_mm = within(1.5);
    for (std::size_t i = 0; i < 3; ++i) {
        truth.endstops[i].at_mm = 200 + within(2);
        truth.delta.radius_mm[i] += radius_mm;
    }
    truth.delta.tower_angle_deg[0] += within(0.6);
    truth.delta.tower_angle_deg[1] += within(0.6);
    return truth;
}

// The largest error of the nozzle's height over the bed with the frame that was found.
double flatness_mm(const config::Printer& found, const config::Printer& truth) {
    double worst_mm = 0;
    for (double x = -80; x <= 80; x += 16)
        for (double y = -80; y <= 80; y += 16) {
            if (std::hypot(x, y) > 85) continue;
            auto carriages = motion::motors_at(moves::kinematics_of(truth), {x, y, 0});
            for (std::size_t i = 0; i < 3; ++i)
                carriages[i] += carriage_endstop_mm(found, i) - carriage_endstop_mm(truth, i);
            const motion::Point at = motion::head_at(moves::kinematics_of(found), carriages);
            worst_mm = std::max(worst_mm, std::abs(at.z));
        }
    return worst_mm;
}

void check_failure(const Result<Calibrated>& found, const std::string& part) {
    REQUIRE_FALSE(found.ok());
    CAPTURE(found.error().message);
    CHECK(found.error().status == ExitStatus::machine);
    CHECK(found.error().message.find(part) != std::string::npos);
}

// Homes z by the probe over a bed that is crooked.
config::Printer crooked() {
    config::Printer printer = with_probe(machine_of(Kinematics::cartesian));
    printer.endstops[2].input.reset();
    printer.simulated.bed_tilt = {0.002, -0.0015};
    printer.simulated.bumps = {{60, 80, 0.3, 50}, {150, 150, -0.2, 60}};
    printer.mesh.points = {4, 5};
    printer.mesh.area_mm = {30, 10, 210, 190};
    printer.mesh.has_area = true;
    return printer;
}

}  // namespace

TEST_CASE("least squares 1: a curve through noisy points, and what cannot be told apart") {
    // y = a exp(b x), without noise.
    const auto residuals = [](const Numbers& at) {
        Numbers off;
        for (double x = 0; x < 5; x += 0.5)
            off.push_back(at[0] * std::exp(at[1] * x) - 3 * std::exp(-0.4 * x));
        return off;
    };
    const auto found = least_squares(residuals, {1, 0}, {1, 1});
    REQUIRE(found);
    CHECK((*found)[0] == doctest::Approx(3).epsilon(1e-9));
    CHECK((*found)[1] == doctest::Approx(-0.4).epsilon(1e-9));
    const auto twins = [](const Numbers& at) {
        return Numbers{at[0] + at[1] - 1, 2 * at[0] + 2 * at[1] - 3, at[0] + at[1]};
    };
    CHECK_FALSE(least_squares(twins, {0, 0}, {1, 1}));
    CHECK_FALSE(least_squares([](const Numbers& at) { return at; }, {NAN}, {1}));
    CHECK_FALSE(least_squares([](const Numbers&) { return Numbers{1}; }, {0, 0}, {1, 1}));
}

TEST_CASE("delta fit 1: a perturbed frame is recovered to a micrometre without noise") {
    std::mt19937 random(11);
    const config::Printer printer = machine_of(Kinematics::delta);
    for (int run = 0; run < 20; ++run) {
        const config::Printer truth = perturbed(printer, random);
        const auto found = fit_delta(printer, touches_of(truth, 0, random));
        REQUIRE(found);
        for (std::size_t i = 0; i < 3; ++i) {
            CHECK(std::abs(found->delta.radius_mm[i] - truth.delta.radius_mm[i]) < 1e-3);
            CHECK(std::abs(*found->endstops[i].at_mm - *truth.endstops[i].at_mm) < 1e-3);
            CHECK(std::abs(found->delta.tower_angle_deg[i] - truth.delta.tower_angle_deg[i]) <
                  1e-3);
        }
        CHECK(flatness_mm(*found, truth) < 1e-3);
    }
}

TEST_CASE("delta fit 1: with noise of 10 um the bed is flat to 20 um") {
    std::mt19937 random(12);
    const config::Printer printer = machine_of(Kinematics::delta);
    double worst_mm = 0, radius_mm = 0;
    for (int run = 0; run < 40; ++run) {
        const config::Printer truth = perturbed(printer, random);
        const auto found = fit_delta(printer, touches_of(truth, 0.01, random));
        REQUIRE(found);
        worst_mm = std::max(worst_mm, flatness_mm(*found, truth));
        radius_mm =
            std::max(radius_mm, std::abs(found->delta.radius_mm[0] - truth.delta.radius_mm[0]));
    }
    MESSAGE("worst flatness ", worst_mm, " mm, radius off by ", radius_mm, " mm");
    CHECK(worst_mm < 0.02);
    CHECK(radius_mm < 0.1);
}

TEST_CASE("calibration 1: a mesh is the bed at its points to a microstep of z" *
          doctest::test_suite("long")) {
    const config::Printer printer = crooked();
    const auto found = calibrate({printer, true, {}}, Calibration::mesh);
    REQUIRE_MESSAGE(found.ok(), found.error().message);
    const SimulatedMachine machine(printer, {});
    const double home_mm = machine.bed_mm(110, 102.5);  // the middle of the ranges
    const config::BedMesh& mesh = found->printer.mesh;
    REQUIRE(mesh.heights_mm.size() == 5);
    for (std::size_t row = 0; row < 5; ++row)
        for (std::size_t column = 0; column < 4; ++column) {
            const double x_mm = 30 + 60 * static_cast<double>(column);
            const double y_mm = 10 + 45 * static_cast<double>(row);
            const double off_mm =
                mesh.heights_mm[row][column] - (machine.bed_mm(x_mm, y_mm) - home_mm);
            // One where z was homed, one here.
            CHECK(std::abs(off_mm) <= 2 * 1.01 / 400);
        }
}

TEST_CASE("calibration 1: the probe's height over a bed that an endstop knows") {
    config::Printer printer = with_probe(machine_of(Kinematics::cartesian));
    printer.simulated.probe_offset_mm = {20, -10, 1.37};
    const auto found = calibrate({printer, true, {}}, Calibration::probe);
    REQUIRE_MESSAGE(found.ok(), found.error().message);
    CHECK(found->printer.probe->offset_mm[0] == 20);
    CHECK(std::abs(found->printer.probe->offset_mm[2] - 1.37) <= 2 * 1.01 / 400);
}

TEST_CASE("calibration 1: a delta's frame, and then its bed is flat to a few micrometres" *
          doctest::test_suite("long")) {
    config::Printer printer = with_probe(machine_of(Kinematics::delta));
    printer.simulated.radius_error_mm = {0.6, 0.6, 0.6};
    printer.simulated.angle_error_deg = {0.3, -0.2, 0};
    printer.simulated.endstop_error_mm = {0.4, -0.3, 0.2};
    const auto found = calibrate({printer, true, {}}, Calibration::delta);
    REQUIRE_MESSAGE(found.ok(), found.error().message);
    CHECK(std::abs(found->printer.delta.radius_mm[0] - 120.6) < 0.05);
    CHECK(found->text.find("up to 0.") != std::string::npos);
    const auto again = calibrate({found->printer, true, {}}, Calibration::mesh);
    REQUIRE_MESSAGE(again.ok(), again.error().message);
    double worst_mm = 0;
    for (const auto& row : again->printer.mesh.heights_mm)
        for (const double height_mm : row) worst_mm = std::max(worst_mm, std::abs(height_mm));
    MESSAGE("bed with the frame found: up to ", worst_mm, " mm off");
    CHECK(worst_mm < 0.01);
}

TEST_CASE("probing 1: noise is averaged, and more of it than the tolerance is an error" *
          doctest::test_suite("long")) {
    config::Printer printer = crooked();
    printer.mesh.points = {2, 2};
    printer.simulated.probe_noise_mm = 0.008;
    printer.probe->samples = 5;
    CHECK(calibrate({printer, true, {}}, Calibration::mesh).ok());
    printer.simulated.probe_noise_mm = 0.08;
    printer.homing.tolerance_mm = 1;
    check_failure(calibrate({printer, true, {}}, Calibration::mesh),
                  "and probe.tolerance_mm is 0.02");
}

TEST_CASE("probing 2: what breaks ends the calibration with the place and the reason" *
          doctest::test_suite("long")) {
    const config::Printer printer = crooked();
    const auto broken = [&](double time_s, thermal::FaultKind kind) {
        return calibrate({printer, true, {fault(time_s, kind, config::contact_probe)}},
                         Calibration::mesh);
    };
    // Homing takes 30 s here.
    check_failure(broken(60, thermal::FaultKind::dead), "the probe has not triggered within");
    check_failure(broken(60, thermal::FaultKind::dead), "at x ");
    // In the middle of an approach that counts: it is found by those before it.
    check_failure(broken(60, thermal::FaultKind::stuck), "approaches of the probe differ by");
    check_failure(broken(62, thermal::FaultKind::stuck), "at x ");
    check_failure(broken(0, thermal::FaultKind::stuck), "the probe is still triggered");
}

TEST_CASE("calibration: what cannot be is refused before anything moves") {
    config::Printer printer = crooked();
    printer.mesh.area_mm = {0, 0, 220, 190};
    check_failure(calibrate({printer, true, {}}, Calibration::mesh), "cannot get to x 0, y 0");
    check_failure(calibrate({printer, true, {}}, Calibration::delta), "for kinematics");
    check_failure(calibrate({printer, true, {}}, Calibration::probe), "homes z itself");
    check_failure(calibrate({machine_of(Kinematics::cartesian), true, {}}, Calibration::mesh),
                  "no probe.input");
    printer.endstops = {};
    printer.probe.reset();
    printer = with_probe(printer);
    printer.kinematics = Kinematics::delta;
    check_failure(calibrate({printer, true, {}}, Calibration::mesh), "no endstops");
}

TEST_CASE("calibration 2: what was found can be read again, and keeps what was found before") {
    config::Printer printer = with_probe(machine_of(Kinematics::cartesian));
    printer.mesh.points = {3, 3};
    printer.simulated.bed_tilt = {0.001, 0};
    const auto first = calibrate({printer, true, {}}, Calibration::probe);
    REQUIRE(first.ok());
    const auto second = calibrate({first->printer, true, {}}, Calibration::mesh);
    REQUIRE_MESSAGE(second.ok(), second.error().message);
    const std::string text = calibration_toml(second->printer);
    CHECK(text.find("[probe]\noffset_mm = [20.0000, -10.0000, ") != std::string::npos);
    CHECK(text.find("heights_mm = [\n    [") != std::string::npos);
}
