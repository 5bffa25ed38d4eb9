// Contract of profile/resolve.h, by number.

#include "profile/resolve.h"

#include <random>

#include "profiles.h"

using namespace lyr;
using namespace lyr::profile;
using namespace lyr::profile::tests;

namespace {

constexpr auto usage = ExitStatus::usage;
constexpr auto input = ExitStatus::input;

Setting set(const std::string& key, const std::string& value) {
    return {key, value, "--set"};
}

// A value other than the default for every key, as a command line gives it; none contradicts another.
std::vector<Setting> all_changed() {
    std::vector<Setting> settings;
    for (const Key& key : keys()) {
        std::string value = "1";
        if (key.accepts == "true or false") {
            value = key.show(Profile{}) == "true" ? "false" : "true";
        } else if (key.accepts.starts_with('[')) {
            value = "12.5,7";
        } else if (key.accepts == "a text") {
            value = "a \"quoted\" \\ text";
        } else if (key.accepts == "a list of texts") {
            value = "TOP,with \"quotes\" \\,\u00e9";
        } else if (const auto end = key.accepts.rfind(" or "); end != std::string::npos) {
            value = key.accepts.substr(end + 4);
        } else if (key.accepts.ends_with('%')) {
            value = "33.3%";
        } else {
            value = key.accepts.starts_with("a whole") ? "7" : "0.31";
        }
        settings.push_back(set(key.path, value));
    }
    return settings;
}

void check_file_error(const Folder& folder, const std::string& text, std::uint32_t line,
                      const std::string& part) {
    const std::string path = folder.write("wrong.toml", text);
    CAPTURE(text);
    const Diagnostic error = error_of({path, {}}, input, part);
    CHECK(error.where.file == path);
    CHECK(error.where.line == line);
    CHECK(error.where.column > 0);
}

}  // namespace

TEST_CASE("resolve 1: settings win over the profile, and it over what it inherits") {
    const Folder folder("order");
    folder.write("base.toml",
                 "[layer]\nheight = 0.1\nfirst_height = 0.11\ncusp = 0.012\n"
                 "[infill]\ndensity = \"12%\"\n");
    const std::string path = folder.write(
        "own.toml", "layer.height = 0.2\nlayer.cusp = 0.022\ninherits = \"base.toml\"\n");
    const Resolved all =
        resolved({path, {set("layer.height", "0.3"), set("layer.height", "0.25")}});
    CHECK(all.profile.layer.height_mm == 0.25);
    CHECK(all.profile.layer.cusp_mm == 0.022);
    CHECK(all.profile.layer.first_height_mm == 0.11);
    CHECK(all.profile.infill.density == 0.12);
    CHECK(all.profile.perimeters == Perimeters{});
    CHECK(all.name == "own");
}

TEST_CASE(
    "resolve 1: what follows from another key follows from its last value, if nobody says it") {
    const Resolved followed =
        with_settings({set("layer.height", "0.3"), set("nozzle.diameter", "0.6"),
                       set("temperature.nozzle", "255")});
    CHECK(followed.profile.layer.first_height_mm == 0.3);
    CHECK(followed.profile.perimeters.width_mm == 0.675);
    CHECK(followed.profile.skin.width_mm == 0.675);
    CHECK(followed.profile.infill.width_mm == 0.675);
    CHECK(followed.profile.layer.max_height_mm == 0.45);
    CHECK(followed.profile.temperature.nozzle_first_layer_c == 255);
    const Resolved said =
        with_settings({set("layer.first_height", "0.2"), set("layer.height", "0.3")});
    CHECK(said.profile.layer.first_height_mm == 0.2);
}

TEST_CASE("resolve 2: every value has its origin") {
    const Folder folder("origins");
    const std::string base = folder.write("base.toml", "inherits = \"abs\"\nlayer.cusp = 0.02\n");
    const std::string own =
        folder.write("own.toml", "\ninherits = \"base\"\n\n[layer]\nheight = 0.2\n");
    // Without .toml, a name is the built-in profile or the file of just that name.
    error_of({own, {}}, input, "inherits \"base\": ");
    folder.write("own.toml", "\ninherits = \"base.toml\"\n\n[layer]\nheight = 0.2\n");
    const Resolved all =
        resolved({own, {set("perimeters.count", "2"), {"plate.at", "1,2", "--at"}}});
    const std::string text = to_toml(all);
    const auto has = [&](const std::string& start, const std::string& origin) {
        const std::size_t at = text.find('\n' + start);
        REQUIRE(at != text.npos);
        const std::string line = text.substr(at + 1, text.find('\n', at + 1) - at - 1);
        CAPTURE(line);
        CHECK(line.ends_with("  # " + origin));
    };
    has("height = 0.2 ", own + ":5");
    has("cusp = 0.02 ", base + ":2");
    has("first_height = 0.2 ", "default, as layer.height");
    has("count = 2 ", "--set");
    has("at = [1, 2] ", "--at");
    has("material = \"ABS\" ", "abs.toml:4 (built-in)");
    has("z_hop = 0 ", "default");
    CHECK(to_toml(all, Folders::left_out).find("# own.toml:5") != text.npos);
    CHECK(to_toml(all, Folders::left_out).find(folder / "") == text.npos);
}

TEST_CASE("resolve 3: an unknown key comes with file, line and the nearest key") {
    const Folder folder("unknown");
    check_file_error(folder, "[infil]\ndensity = \"15%\"\n", 2,
                     "unknown key `infil.density`; did you mean `infill.density`?");
    check_file_error(folder, "layer_height = 0.2\n", 1, "did you mean `layer.height`?");
    check_file_error(folder, "sequential = true\n", 1, "did you mean `plate.sequential`?");
    check_file_error(folder, "pattern = \"grid\"\n", 1,
                     "did you mean `skin.pattern` or `infill.pattern`?");
    check_file_error(folder, "colour = 3\n", 1, "--print-config lists the keys");
    check_file_error(folder, "layer = 3\n", 1, "`layer` is a section");
    check_file_error(folder, "\"layer.height\" = 0.2\n", 1, "did you mean `layer.height`?");
    check_file_error(folder, "[layer.height]\nmm = 0.2\n", 2, "unknown key `layer.height.mm`");
    check_file_error(folder, "[layer]\n[colour]\n", 2, "unknown key `colour`");
    check_file_error(folder, "[[layer]]\nheight = 0.2\n", 1, "`layer` is a section");
    CHECK(resolve({folder.write("empty.toml", "[layer]\n"), {}}).ok());
}

TEST_CASE(
    "resolve 3: wrong values, text that is not TOML and keys that stand twice come with their "
    "line") {
    const Folder folder("wrong");
    check_file_error(folder, "[layer]\nheight = 11\n", 2,
                     "layer.height: expected 0.001 to 10 mm, found 11");
    check_file_error(folder, "[layer]\nheight = true\n", 2, "found true");
    check_file_error(folder, "[layer]\nheight = [0.2]\n", 2, "found a list");
    check_file_error(folder, "[layer]\nheight = 2024-01-01\n", 2, "found a value of another type");
    check_file_error(folder, "[layer]\nheight = 0.2\nheight = 0.3\n", 3, "");
    check_file_error(folder, "[layer]\nheight = 0.2\n[layer]\ncusp = 0.3\n", 3, "");
    check_file_error(folder, "[layer]\nheight = \n", 2, "");
    check_file_error(folder, "inherits = 3\n", 1,
                     "inherits: expected the name of a profile, found 3");
    check_file_error(folder, "plate.at = [1, 20000]\n", 1, "found a list with 20000");
    // The first in the file, not the first by name.
    check_file_error(folder, "[speed]\ntravel = 0\n[layer]\nheight = 0\n", 2, "speed.travel");
}

TEST_CASE("resolve 3: a profile that is not there, or too large, is told with what is built in") {
    const Folder folder("missing");
    error_of({"asb", {}}, input, "did you mean the built-in `abs`?");
    error_of({"nylon.toml", {}}, input, "built in are abs-dental, ");
    error_of({folder / "abs.toml", {}}, input, "cannot read");
    error_of({LYR_BUILD, {}}, input, "cannot read");
    error_of({"/dev/zero", {}}, input, "longer than 1048576 bytes");
    check_file_error(folder, "\ninherits = \"none.toml\"\n", 2,
                     "inherits \"none.toml\": cannot read");
    check_file_error(folder, "\ninherits = \"-\"\n", 2, "standard input");
    folder.write("base.toml", "\n\n[layer]\nheight = 0\n");
    const Diagnostic error = error_of({folder.write("own.toml", "inherits = \"base.toml\"\n"), {}},
                                      input, "layer.height");
    CHECK(error.where.file == folder / "base.toml");
    CHECK(error.where.line == 4);
}

TEST_CASE("resolve 3: a profile that inherits itself is told with the way round") {
    const Folder folder("cycle");
    check_file_error(folder, "inherits = \"wrong.toml\"\n", 1, "inherits itself: ");
    folder.write("a.toml", "inherits = \"b.toml\"\n");
    folder.write("sub/c.toml", "\ninherits = \"../a.toml\"\n");
    folder.write("b.toml", "inherits = \"sub/c.toml\"\n");
    const Diagnostic error = error_of({folder / "a.toml", {}}, input, "inherits itself: ");
    CHECK(error.where.line == 2);
    CHECK(error.message.find("b.toml -> ") != std::string::npos);
    // Coming from outside, the way round does not go through the outside.
    const Diagnostic outer =
        error_of({folder.write("outer.toml", "inherits = \"a.toml\"\n"), {}}, input, "itself: ");
    CHECK(outer.message.find("outer") == std::string::npos);
}

TEST_CASE("resolve: names are files, relative to who says them, or built in") {
    const Folder folder("names");
    folder.write("sub/base.toml", "layer.height = 0.15\n");
    folder.write("sub/own.toml", "inherits = \"base.toml\"\n");
    CHECK(resolved({folder.write("top.toml", "inherits = \"sub/own.toml\"\n"), {}})
              .profile.layer.height_mm == 0.15);
    // A file of a built-in profile's name wins where it is meant, and can build on that.
    folder.write("abs.toml", "inherits = \"abs\"\nlayer.height = 0.15\n");
    const Resolved own = resolved({folder.write("own.toml", "inherits = \"abs.toml\"\n"), {}});
    CHECK(own.profile.layer.height_mm == 0.15);
    CHECK(own.profile.filament.material == "ABS");
    CHECK(resolved({folder.write("petg-own.toml", "inherits = \"petg.toml\"\n"), {}})
              .profile.filament.material == "PETG");
}

TEST_CASE("resolve 3: settings are refused in the option's name") {
    error_of({{}, {set("infil.density", "15%")}}, usage,
             "--set: unknown key `infil.density`; did you mean `infill.density`?");
    error_of({{}, {set("infill.density", "15")}}, usage,
             "--set: infill.density: expected 0% to 100%");
    error_of({{}, {set("inherits", "abs")}}, usage, "--set: unknown key `inherits`");
    error_of({{}, {set("layer.height", "")}}, usage, "found \"\"");
    error_of({{}, {{"layer.height", "nan", "--layer-height"}}}, usage,
             "--layer-height: layer.height: expected");
    error_of({{}, {set("layer.height", "0.2"), {"layer.height", "0.2", "--layer-height"}}}, usage,
             "layer.height is given by --set and by --layer-height");
    for (const char* text : {"layer.height", "=0.2", "", " = 1"})
        CHECK_FALSE(parse_setting(text, "--set").has_value());
    const auto spaced = parse_setting(" a.b = c = d ", "--set");
    REQUIRE(spaced.has_value());
    CHECK(spaced->key == "a.b");
    CHECK(spaced->value == "c = d");
}

TEST_CASE("resolve 4: values that contradict each other are told with both origins") {
    const std::pair<Setting, std::string> wrong[] = {
        {set("layer.height", "0.41"), "is more than nozzle.diameter = 0.4 (default)"},
        {set("layer.first_height", "0.41"), "is more than nozzle.diameter"},
        {set("layer.min_height", "0.31"), "is more than layer.max_height"},
        {set("layer.max_height", "0.05"),
         "layer.min_height = 0.1 (default, 1/4 of nozzle.diameter)"},
        {set("perimeters.width", "0.19"), "is less than layer.height"},
        {set("skin.width", "0.19"), "is less than layer.height"},
        {set("infill.width", "0.19"), "is less than layer.height"},
        {set("perimeters.min_width", "0.9"), "is more than perimeters.max_width"},
        {set("fan.max", "20%"),
         "fan.min = \"100%\" (default) is more than fan.max = \"20%\" (--set)"},
        {set("fan.min_layer_time", "61"), "is more than fan.ramp_time"}};
    for (const auto& [setting, message] : wrong) error_of({{}, {setting}}, usage, message);
    error_of({{}, {set("layer.adaptive", "true"), set("infill.width", "0.25")}}, usage,
             "infill.width = 0.25 (--set) is less than layer.max_height = 0.3");
    error_of({{}, {set("layer.adaptive", "true"), set("layer.max_height", "0.5")}}, usage,
             "layer.max_height = 0.5 (--set) is more than nozzle.diameter");
    for (const std::string line : {"perimeters", "skin", "infill"})
        error_of({{},
                  {set("layer.first_height", "0.3"), set(line + ".width", "0.29"),
                   set("layer.height", "0.1")}},
                 usage, "width = 0.29 (--set) is less than layer.first_height = 0.3");
    const Folder folder("contradictions");
    const std::string path = folder.write("wrong.toml", "\n[layer]\nheight = 0.5\n");
    const Diagnostic error = error_of(
        {path, {}}, input,
        "layer.height = 0.5 (" + path + ":3) is more than nozzle.diameter = 0.4 (default)");
    CHECK(error.where.file == path);
    CHECK(error.where.line == 3);
}

TEST_CASE("lines 5 mm wide were sliced for a nozzle of 0.4 mm without a word") {
    for (const std::string key :
         {"perimeters.width", "skin.width", "infill.width", "perimeters.max_width"}) {
        CAPTURE(key);
        CHECK(resolve({{}, {set(key, "1.2")}}).ok());
        error_of({{}, {set(key, "1.21")}}, usage,
                 key + " = 1.21 (--set) is more than three times nozzle.diameter = 0.4 (default)");
        CHECK(resolve({{}, {set(key, "2.1"), set("nozzle.diameter", "0.7")}}).ok());
        const Folder folder("too_wide");
        const std::size_t dot = key.find('.');
        const std::string path = folder.write(
            "wide.toml", '[' + key.substr(0, dot) + "]\n" + key.substr(dot + 1) + " = 5\n");
        const Diagnostic error = error_of({path, {}}, input, key + " = 5 (" + path + ":2)");
        CHECK(error.where.file == path);
        CHECK(error.where.line == 2);
    }
    error_of({{}, {set("perimeters.width", "5")}}, usage, "set perimeters.count");
}

TEST_CASE(
    "parts too narrow for two walls of 0.6 mm were filled by a line of 0.8 mm, up to 1.05 mm "
    "wide") {
    const auto max_width_mm = [](const std::vector<Setting>& settings) {
        return with_settings(settings).profile.perimeters.max_width_mm;
    };
    CHECK(max_width_mm({}) == 0.8);
    CHECK(max_width_mm({set("perimeters.width", "0.6")}) == 1.05);
    CHECK(max_width_mm({set("perimeters.width", "1.2")}) == doctest::Approx(1.2));
    CHECK(max_width_mm({set("perimeters.width", "0.6"), set("perimeters.max_width", "0.7")}) ==
          0.7);
    CHECK(max_width_mm({set("nozzle.diameter", "10"), set("perimeters.width", "20")}) == 20);
}

TEST_CASE("resolve 5: what to_toml gives is the same profile, for every key") {
    const Folder folder("again");
    std::vector<Setting> changed = all_changed();
    // A few that contradict the others as they are.
    for (Setting& setting : changed) {
        if (setting.key == "layer.min_height") setting.value = "0.111";
        if (setting.key == "perimeters.max_width") setting.value = "0.9";
        if (setting.key == "nozzle.diameter") setting.value = "0.35";
        if (setting.key == "fan.ramp_time") setting.value = "0.33";
    }
    for (const Request& request : {Request{}, Request{"abs-dental", {}}, Request{{}, changed}}) {
        const Resolved first = resolved(request);
        const std::string text = to_toml(first);
        const Resolved again = resolved({folder.write("again.toml", text), {}});
        CHECK(again.profile == first.profile);
        for (const Origin& origin : again.origins) CHECK(origin.kind == Origin::Kind::file);
        CHECK(
            resolved({folder.write("left.toml", to_toml(first, Folders::left_out)), {}}).profile ==
            first.profile);
    }
    // None of them is the default.
    const Resolved all = with_settings(changed);
    for (const Key& key : keys()) {
        CAPTURE(key.path);
        CHECK(key.show(all.profile) != key.show(Profile{}));
    }
}

TEST_CASE("resolve 2: what follows from a key at the ends of its range is within its own") {
    const Folder folder("ends");
    for (const char* diameter : {"0.05", "10"}) {
        const Resolved ends =
            with_settings({set("nozzle.diameter", diameter), set("layer.height", "0.01")});
        CHECK(resolved({folder.write("ends.toml", to_toml(ends)), {}}).profile == ends.profile);
    }
}

TEST_CASE("resolve: cut and garbled files give a profile or an error, never a crash") {
    const Folder folder("garbled");
    const std::string good = to_toml(resolved({"abs", {}}));
    for (std::size_t length = 0; length < good.size(); length += 7)
        (void)resolve({folder.write("cut.toml", good.substr(0, length)), {}});
    std::mt19937 random(11);
    std::size_t errors = 0;
    for (int i = 0; i < 1'000; ++i) {
        std::string text = good;
        for (int k = 0; k < 4; ++k)
            text[random() % text.size()] = static_cast<char>(random() % 256);
        errors += !resolve({folder.write("garbled.toml", text), {}}).ok();
    }
    CHECK(errors > 300);
    CHECK_FALSE(resolve({folder.write("deep.toml", "x = " + std::string(100'000, '[')), {}}).ok());
}
