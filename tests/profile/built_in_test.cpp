// The profiles of profile/built_in/: that they are there, are right and say what users of their materials expect.

#include "profile/built_in.h"

#include "profiles.h"

using namespace lyr;
using namespace lyr::profile;
using namespace lyr::profile::tests;

namespace {

struct Expected {
    const char *name, *material;
    double nozzle_c, bed_c, density_g_cm3;
};

Profile built_in(const std::string& name) {
    return resolved({name, {}}).profile;
}

}  // namespace

TEST_CASE(
    "built-in: materials with the field's temperatures and densities, by name and by file name") {
    for (const Expected& expected :
         {Expected{"pla", "PLA", 210, 60, 1.24}, Expected{"petg", "PETG", 240, 80, 1.27},
          Expected{"abs", "ABS", 230, 100, 1.04}, Expected{"tpu", "TPU", 225, 50, 1.21}}) {
        CAPTURE(expected.name);
        const Profile profile = built_in(expected.name);
        CHECK(profile.filament.material == expected.material);
        CHECK(profile.filament.density_g_cm3 == expected.density_g_cm3);
        CHECK(profile.filament.diameter_mm == 1.75);
        CHECK(profile.temperature.nozzle_c == expected.nozzle_c);
        CHECK(profile.temperature.bed_c == expected.bed_c);
        CHECK(profile.nozzle.diameter_mm == 0.4);
        CHECK(built_in(expected.name + std::string(".toml")) == profile);
    }
}

TEST_CASE("built-in: without a profile it is PLA") {
    CHECK(built_in("pla") == Profile{});
}

TEST_CASE("built-in: the two prints of the paper") {
    const Profile gearbox = built_in("abs-gearbox"), dental = built_in("abs-dental");
    CHECK(gearbox.layer.height_mm == 0.2);
    CHECK(gearbox.temperature.nozzle_c == 230);
    CHECK(dental.layer.height_mm == 0.1);
    CHECK(dental.temperature.nozzle_c == 215);
    CHECK(dental.temperature.nozzle_first_layer_c == 215);
    for (const auto& [profile, speed_mm_s] : {std::pair(gearbox, 100.0), std::pair(dental, 60.0)}) {
        CHECK(profile.filament.material == "ABS");
        CHECK(profile.infill.density == 1);
        CHECK(profile.fan == built_in("abs").fan);
        for (const double speed :
             {profile.speed.outer_wall_mm_s, profile.speed.inner_wall_mm_s,
              profile.speed.solid_infill_mm_s, profile.speed.sparse_infill_mm_s,
              profile.speed.top_skin_mm_s, profile.speed.small_mm_s, profile.speed.gap_fill_mm_s})
            CHECK(speed == speed_mm_s);
    }
}

TEST_CASE("built-in: each is right by itself, and the embedded text is the file's") {
    CHECK(built_ins().size() == 6);
    for (const BuiltIn& file : built_ins()) {
        CAPTURE(file.name);
        const Resolved profile = resolved({std::string(file.name), {}});
        CHECK(profile.name == file.name);
        for (const Origin& origin : profile.origins)
            CHECK((origin.kind == Origin::Kind::unsaid || origin.kind == Origin::Kind::built_in));
        std::ifstream text(std::string(LYR_BUILT_IN) + '/' + std::string(file.name) + ".toml");
        CHECK(std::string(std::istreambuf_iterator<char>(text), {}) == file.text);
    }
}
