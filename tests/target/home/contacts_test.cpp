// Contract of target/home/contacts.h, by number, where a moving machine does not get.

#include "target/home/contacts.h"

#include "target/gpio/mock_inputs.h"
#include "target/home/scene.h"

using namespace lyr;
using namespace lyr::home;
using namespace lyr::tests;

namespace {

constexpr std::int64_t ms = 1'000'000;

struct Watched {
    config::Printer printer = machine_of(config::Kinematics::cartesian);
    gpio::VirtualClock clock;
    gpio::MockInputs inputs{3, clock};
    ContactWatch watch{inputs, printer};
    run::StopRequests stop{0};

    void begin_at(std::int64_t time_ns) {
        clock.advance_ns(time_ns - clock.now_ns());
        REQUIRE(watch.begin(Contacts(1), stop, time_ns).ok());
    }
    void poll_at(std::int64_t time_ns) {
        clock.advance_ns(time_ns - clock.now_ns());
        watch.poll(time_ns);
    }
};

}  // namespace

TEST_CASE(
    "contacts 2: edges from before begin() are no touches, and nobody waits for them to settle") {
    Watched scene;
    scene.inputs.set(0, true, 100 * ms);
    scene.inputs.set(0, false, 200 * ms);
    scene.begin_at(200 * ms);
    scene.poll_at(201 * ms);
    CHECK(scene.watch.is_quiet(201 * ms));
    scene.poll_at(300 * ms);
    CHECK_FALSE(scene.watch.triggers()[0]);
    CHECK(scene.stop == 0);
    // And one that comes counts from when it comes.
    scene.inputs.set(0, true, 400 * ms);
    scene.poll_at(410 * ms);
    CHECK(scene.watch.triggers()[0] == 400 * ms);
    CHECK(scene.stop == 1);
}

TEST_CASE("contacts 2: one that is closed at begin() closes then, whatever it did before") {
    Watched scene;
    scene.inputs.set(0, true, 100 * ms);
    scene.inputs.set(0, false, 200 * ms);
    scene.inputs.set(0, true, 300 * ms);
    scene.begin_at(400 * ms);
    scene.poll_at(410 * ms);
    CHECK(scene.watch.triggers()[0] == 400 * ms);
    CHECK(scene.stop == 1);
}

TEST_CASE("contacts 2: one that opens right after begin() has not settled") {
    Watched scene;
    scene.inputs.set(0, true, 100 * ms);
    scene.begin_at(400 * ms);
    CHECK_FALSE(scene.watch.is_quiet(400 * ms));
    scene.inputs.set(0, false, 401 * ms);
    scene.poll_at(410 * ms);
    CHECK_FALSE(scene.watch.triggers()[0]);
    CHECK(scene.stop == 0);
}
