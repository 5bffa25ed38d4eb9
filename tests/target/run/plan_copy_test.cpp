// Terms of the shaped plan; contract of target/run/plan_copy.h, by number.

#include "target/run/plan_copy.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <random>

#include "target/moves/move_maker.h"

using namespace lyr;
using namespace lyr::run;

namespace {

// Lines, arcs of every size, whole turns, retractions and rests.
PlanPieces planned(double jerk_mm_s3) {
    config::Printer printer = config::generic_printer();
    printer.max_jerk_mm_s3 = jerk_mm_s3;
    Result<motion::Planner> planner = motion::Planner::create(moves::motion_limits(printer));
    REQUIRE(planner.ok());
    std::mt19937 random(7);
    const auto within = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    motion::Point at{10, 20, 1};
    for (int i = 0; i < 120; ++i) {
        const motion::Point to{within(0, 200), within(0, 200), i % 5 ? at.z : at.z + 0.2};
        const double sagitta_mm = std::pow(10, within(-9, 1.5)) * (i % 2 ? 1 : -1);
        motion::Path path = motion::Line{at, to, within(0, 4)};
        if (i % 4 == 1) path = motion::arc_through(at, to, sagitta_mm, within(0, 4));
        if (i % 4 == 2) path = motion::circle_about(at, at.x + 3, at.y, i % 3 == 0, at.z, 1);
        if (i % 8 == 3) path = motion::Line{at, at, -0.8};
        REQUIRE(planner->push({path, within(5, 250)}).ok());
        at = motion::end_of(path);
        if (i % 10 == 9) planner->dwell(0.03);
    }
    planner->flush();
    PlanPieces pieces;
    double fed_mm = 0, pressed_mm = 0;
    for (motion::PlannedMove move; planner->pop(move);) {
        const double advance_mm = motion::advance_of(move.path);
        const bool presses = advance_mm > 0 && motion::tangent_at(move.path, 0) != motion::Point{};
        pieces.push_back({move, fed_mm, pressed_mm, presses});
        fed_mm += advance_mm;
        if (presses) pressed_mm += advance_mm;
    }
    return pieces;
}

double seconds_since_begin(const motion::PlannedMove& move, std::int64_t at_ns) {
    return (static_cast<double>(at_ns - move.start_ns) - move.start_part_ns) * 1e-9;
}

// By searching all pieces and phases anew, and with the library's sine on arcs.
double searched_mm(const PlanPieces& pieces, std::size_t channel, std::int64_t at_ns) {
    std::size_t i = pieces.size() - 1;
    while (i > 0 && seconds_since_begin(pieces[i].move, at_ns) < 0) --i;
    const PlanPiece& piece = pieces[i];
    const motion::PlannedMove& move = piece.move;
    const double since_s = seconds_since_begin(move, at_ns);
    const double share =
        move.profile.distance_at(std::clamp(since_s, 0.0, move.profile.duration_s)) /
        move.profile.length_mm;
    const double fed_mm = motion::advance_of(move.path) * share;
    if (channel == motion::axis_e) return piece.fed_mm + fed_mm;
    if (channel == motion::pressed_channel) return piece.pressed_mm + (piece.presses ? fed_mm : 0);
    const motion::Point at = motion::point_at_share(move.path, share);
    return channel == motion::axis_x ? at.x : channel == motion::axis_y ? at.y : at.z;
}

// Times all over the plan, before and after it, and about every begin of a move or a phase.
std::vector<std::int64_t> times_of(const PlanPieces& pieces) {
    std::vector<std::int64_t> times_ns;
    const auto look_about = [&](std::int64_t at_ns) {
        for (int off_ns = -2; off_ns <= 2; ++off_ns) times_ns.push_back(at_ns + off_ns);
    };
    for (const PlanPiece& piece : pieces) {
        for (const motion::Phase& phase : piece.move.profile.phases)
            look_about(piece.move.start_ns + std::llround(phase.time_s * 1e9));
        look_about(piece.move.start_ns + std::llround(piece.move.profile.duration_s * 1e9));
    }
    const std::int64_t end_ns = times_ns.back() + 100'000'000;
    for (std::int64_t at_ns = -100'000'000; at_ns < end_ns; at_ns += 1'777'771)
        times_ns.push_back(at_ns);
    std::sort(times_ns.begin(), times_ns.end());
    return times_ns;
}

}  // namespace

TEST_CASE("plan copy 1, 2: as found by searching the plan, for times in any order" *
          doctest::test_suite("long")) {
    constexpr double rounding_mm = 1e-10, weight = -0.7;
    constexpr std::int64_t offset_ns = -12'345'678;
    for (const double jerk_mm_s3 : {0.0, 2e5}) {
        const PlanPieces pieces = planned(jerk_mm_s3);
        const std::vector<std::int64_t> ascending_ns = times_of(pieces);
        std::vector<std::int64_t> shuffled_ns = ascending_ns;
        std::shuffle(shuffled_ns.begin(), shuffled_ns.end(), std::mt19937(3));
        for (std::size_t channel = 0; channel < motion::channel_count; ++channel)
            for (const std::vector<std::int64_t>& times_ns : {ascending_ns, shuffled_ns}) {
                PlanCopy copy(channel, weight, offset_ns);
                double worst_mm = 0;
                for (const std::int64_t at_ns : times_ns)
                    worst_mm =
                        std::max(worst_mm, std::abs(copy.at_mm(pieces, at_ns - offset_ns) -
                                                    weight * searched_mm(pieces, channel, at_ns)));
                CAPTURE(channel);
                CAPTURE(jerk_mm_s3);
                CHECK(worst_mm < rounding_mm);
            }
    }
}

TEST_CASE("plan copy 1: a plan that goes on is seen to, however it was asked before") {
    const PlanPieces whole = planned(0);
    PlanPieces known{whole.front()};
    PlanCopy copy(motion::axis_x, 1, 0);
    for (std::size_t i = 1; i < whole.size(); ++i) {
        const std::int64_t begin_ns = whole[i].move.start_ns;
        // Before it is known, the last place holds.
        CHECK(copy.at_mm(known, begin_ns + 1'000'000) ==
              doctest::Approx(motion::end_of(known.back().move.path).x));
        known.push_back(whole[i]);
        const double seen_mm = copy.at_mm(known, begin_ns + 1'000'000);
        CHECK(std::abs(seen_mm - searched_mm(known, motion::axis_x, begin_ns + 1'000'000)) < 1e-10);
        if (known.size() > 3) known.pop_front();
    }
}

TEST_CASE("plan copy 2: a sum is that of its terms, for times near each other and in any order" *
          doctest::test_suite("long")) {
    struct Term {
        double weight;
        std::int64_t offset_ns;
    };
    const std::array<Term, 3> terms{{{0.3, -9'000'000}, {0.45, 0}, {0.25, 7'654'321}}};
    for (const double jerk_mm_s3 : {0.0, 2e5}) {
        const PlanPieces pieces = planned(jerk_mm_s3);
        const std::vector<std::int64_t> far_ns = times_of(pieces);
        std::vector<std::int64_t> near_ns, shuffled_ns = far_ns;
        for (std::int64_t at_ns = far_ns.front(); at_ns < far_ns.back(); at_ns += 77'771)
            near_ns.push_back(at_ns);
        std::shuffle(shuffled_ns.begin(), shuffled_ns.end(), std::mt19937(3));
        for (const std::size_t channel : {motion::axis_x, motion::axis_y, motion::axis_e})
            for (const std::vector<std::int64_t>& times_ns : {far_ns, near_ns, shuffled_ns}) {
                std::vector<PlanCopy> copies, exact;
                for (const auto& [weight, offset_ns] : terms)
                    copies.push_back({channel, weight, offset_ns});
                exact = copies;
                PlanSum sum(std::move(copies));
                double worst_mm = 0;
                for (const std::int64_t at_ns : times_ns) {
                    double exact_mm = 0;
                    for (PlanCopy& copy : exact) exact_mm += copy.at_mm(pieces, at_ns);
                    worst_mm = std::max(worst_mm, std::abs(sum.at_mm(pieces, at_ns) - exact_mm));
                }
                CAPTURE(channel);
                CAPTURE(jerk_mm_s3);
                CHECK(worst_mm < terms.size() * series_mm);
                CHECK((channel != motion::axis_e || worst_mm < 1e-10));
            }
    }
}
