// What was given to the encoder comes out of the reader, rounded as the writer's contract says.

#include <doctest/doctest.h>

#include <cmath>

#include "files.h"
#include "sample.h"

namespace {

using namespace lyr;
using namespace lyr::format;
using lyr::format::test::Expected;
using lyr::format::test::RandomLayer;

// Compares one operation with what is expected, in quanta.
struct Comparison {
    Quantum quantum;
    const Expected& expected;

    double q(double mm) const { return mm * 1e6 / quantum.nm; }
    double off(const Point& point) const {
        return std::hypot(static_cast<double>(point.x) - q(expected.x_mm),
                          static_cast<double>(point.y) - q(expected.y_mm));
    }
    void end(const Point& point, double most) const {
        CHECK(off(point) <= most);
        CHECK(std::abs(static_cast<double>(point.z) - q(expected.z_mm)) <= 0.5001);
    }
    void near(double value, double wanted, double unit) const {
        CHECK(std::abs(value - wanted) <= 0.5001 * unit);
    }

    void operator()(const LayerStart& o) const { end(o.start, 0.71); }
    void operator()(const PathStart& o) const {
        near(o.style.width_mm, expected.x_mm, 1e-4);
        near(o.style.height_mm, expected.y_mm, 1e-4);
        near(o.style.flow, expected.z_mm, 1e-5);
        near(o.style.speed_mm_s, expected.a, 0.01);
        CHECK(static_cast<int>(o.style.role) == static_cast<int>(expected.b));
    }
    void operator()(const Line& o) const {
        CHECK(o.hatch == expected.flag);
        end(o.to, o.hatch ? 1.5 : 0.71);
    }
    void operator()(const Travel& o) const {
        CHECK(o.hatch == expected.flag);
        end(o.to, o.hatch ? 1.5 : 0.71);
    }
    void operator()(const Arc& o) const {
        end(o.to, 0.71);
        const double chord = std::hypot(o.to.x - o.from.x, o.to.y - o.from.y);
        CHECK(std::abs(static_cast<double>(o.sagitta)) <= widest_sagitta_per_chord * chord);
        CHECK(std::abs(static_cast<double>(o.sagitta) - q(expected.a)) <= 2.5);
    }
    void operator()(const Wipe& o) const {
        end(o.to, 0.71);
        CHECK(std::abs(static_cast<double>(o.sagitta) - q(expected.a)) <= 2.5);
        near(o.depth_mm, expected.b, 1e-3);
        CHECK(o.left_mm >=
              quantum.mm(1) * std::hypot(o.to.x - o.from.x, o.to.y - o.from.y) * (1 - 1e-9));
    }
    void operator()(const Circle& o) const {
        end(o.to, 1.5);  // may follow a hatch
        CHECK(o.counter_clockwise == expected.flag);
        near(static_cast<double>(o.center_x), q(expected.a), 1);
        near(static_cast<double>(o.center_y), q(expected.b), 1);
    }
    void operator()(const HatchStart& o) const {
        CHECK(std::abs(o.direction_x - expected.x_mm) < 1e-9);
        CHECK(std::abs(o.direction_y - expected.y_mm) < 1e-9);
        CHECK(std::abs(o.pitch_mm - expected.a) < 1e-6);
    }
    void operator()(const Width& o) const { near(o.width_mm, expected.a, 1e-4); }
    void operator()(const Speed& o) const { near(o.speed_mm_s, expected.a, 0.01); }
    void operator()(const Acceleration& o) const { CHECK(o.acceleration_mm_s2 == expected.a); }
    void operator()(const TravelSpeed& o) const { near(o.speed_mm_s, expected.a, 0.01); }
    void operator()(const TravelAcceleration& o) const {
        CHECK(o.acceleration_mm_s2 == expected.a);
    }
    void operator()(const Retract& o) const { near(o.depth_mm, expected.a, 1e-3); }
    void operator()(const Temperature& o) const {
        near(o.target_c, expected.a, 0.1);
        CHECK(o.heater == Heater{HeaterKind::tool, 1});
        CHECK(o.wait == expected.flag);
    }
    void operator()(const Fan& o) const {
        near(o.duty, expected.a, 1e-3);
        CHECK(o.fan == 2);
    }
    void operator()(const Dwell& o) const { CHECK(o.time_ms == 1234); }
    void operator()(const Tool& o) const { CHECK(o.tool == 3); }
    void operator()(const Pause& o) const { CHECK(o.reason == PauseReason::filament_change); }
    void operator()(const Object& o) const { CHECK(o.object == 7); }
};

// A run that was cut for its chunk starts again: the reader tells, the caller did not ask for it.
void compare(Reader& reader, const std::vector<Expected>& expected, Quantum quantum) {
    std::size_t i = 0;
    Point at;
    for (; i < expected.size(); ++i) {
        auto next = reader.next();
        REQUIRE_MESSAGE(next.ok(), to_string(next.error()));
        REQUIRE(next->has_value());
        if (std::holds_alternative<HatchStart>(**next) &&
            expected[i].kind != test::kind_of<HatchStart>())
            next = reader.next();
        INFO("operation " << i);
        REQUIRE((*next)->index() == expected[i].kind);
        std::visit(Comparison{quantum, expected[i]}, **next);
        std::visit(
            [&](const auto& o) {
                if constexpr (requires { o.from; }) {
                    CHECK(o.from == at);
                    at = o.to;
                } else if constexpr (requires { o.start; }) {
                    at = o.start;
                }
            },
            **next);
    }
}

}  // namespace

TEST_CASE("writer 1: every call comes out of the reader, rounded by itself" *
          doctest::test_suite("long")) {
    for (const std::uint32_t nm : {1u, 100u, 1000u, 10000u}) {
        const Quantum quantum{nm};
        const std::string path = test::scratch("round_trip");
        auto writer = Writer::create(path, quantum, {});
        REQUIRE(writer.ok());
        std::vector<RandomLayer> layers;
        for (std::uint32_t i = 0; i < 5; ++i) {
            layers.emplace_back(i * 77 + nm, 0.2 * (i + 1), quantum, i == 2 ? 20000 : 600);
            auto encoded = layers.back().finish();
            REQUIRE_MESSAGE(encoded.ok(), to_string(encoded.error()));
            REQUIRE(writer->append(*encoded).ok());
        }
        const auto totals = writer->finish();
        REQUIRE(totals.ok());
        CHECK(totals->layers == 5);
        auto reader = Reader::open(path);
        REQUIRE_MESSAGE(reader.ok(), to_string(reader.error()));
        CHECK(reader->header().quantum.nm == nm);
        for (const RandomLayer& layer : layers) compare(*reader, layer.expected, quantum);
        const auto end = reader->next();
        REQUIRE_MESSAGE(end.ok(), to_string(end.error()));
        CHECK(!end->has_value());
    }
}
