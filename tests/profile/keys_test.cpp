// The table of keys, each key by the same rules.

#include "profile/keys.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <sstream>

#include "base/text.h"
#include "profiles.h"

using namespace lyr;
using namespace lyr::profile;
using namespace lyr::profile::tests;

namespace {

Complaint store(const Key& key, const Scalar& scalar) {
    Profile profile;
    const Complaint complaint = key.store(scalar, profile);
    if (complaint) CHECK(profile == Profile{});
    return complaint;
}

bool is_number(const Key& key) {
    return key.accepts.find(" to ") != std::string::npos && !key.accepts.starts_with('[');
}

bool is_fraction(const Key& key) {
    return is_number(key) && key.accepts.ends_with('%');
}

bool is_choice(const Key& key) {
    return key.accepts.find(" or ") != std::string::npos && key.accepts != "true or false";
}

// The two ends of "0.001 to 10 mm", "0% to 100%" and "a whole number from 1 to 5".
std::pair<double, double> range_of(const Key& key) {
    const std::string whole = "a whole number from ";
    std::istringstream text(key.accepts.starts_with(whole) ? key.accepts.substr(whole.size())
                                                           : key.accepts);
    std::string to;
    std::pair<double, double> range;
    text >> range.first;
    if (text.peek() == '%') text.get();
    text >> to >> range.second;
    CHECK(to == "to");
    const double scale = is_fraction(key) ? 0.01 : 1;
    return {range.first * scale, range.second * scale};
}

std::string unit_of(const Key& key) {
    const std::size_t at =
        key.accepts.find_first_not_of("0123456789.e+-", key.accepts.find(" to ") + 4);
    return at == std::string::npos ? "" : key.accepts.substr(at);
}

std::string row_of(const Key& key) {
    const std::string fallback = key.derived ? key.derived->text : key.show(Profile{});
    return "| `" + key.path + "` | " + key.accepts + " | " +
           (key.derived ? fallback : '`' + fallback + '`') + " | " + key.help + " |";
}

std::string page() {
    std::ostringstream text;
    text << std::ifstream(std::string(LYR_DOCS) + "/profiles.md").rdbuf();
    return text.str();
}

}  // namespace

TEST_CASE("keys: names are unlike, in one section each, with help and what they accept") {
    std::set<std::string> paths;
    std::vector<std::string> sections;
    for (const Key& key : keys()) {
        CAPTURE(key.path);
        CHECK(paths.insert(key.path).second);
        CHECK(std::count(key.path.begin(), key.path.end(), '.') == 1);
        CHECK_FALSE(key.help.empty());
        CHECK_FALSE(key.accepts.empty());
        const std::string section = key.path.substr(0, key.path.find('.'));
        if (sections.empty() || sections.back() != section) sections.push_back(section);
    }
    CHECK(paths.size() > 90);
    CHECK(std::set<std::string>(sections.begin(), sections.end()).size() == sections.size());
}

TEST_CASE("keys: each default is a value that the key takes, and the default of the derived too") {
    Profile derived;
    for (const Key& key : keys()) {
        CAPTURE(key.path);
        const std::string toml = key.show(Profile{});
        if (key.derived) key.derived->set(derived);
        if (!is_number(key)) continue;
        const bool quoted = toml.front() == '"';
        CHECK_FALSE(store(key, Bare{quoted ? toml.substr(1, toml.size() - 2) : toml}).has_value());
    }
    CHECK(derived == Profile{});
    CHECK(resolved({}).profile == Profile{});
}

TEST_CASE(
    "keys: numbers take their range's ends, with their unit and no other, and nothing beyond") {
    std::size_t numbers = 0;
    for (const Key& key : keys()) {
        if (!is_number(key)) continue;
        ++numbers;
        CAPTURE(key.path);
        const auto [low, high] = range_of(key);
        REQUIRE(low < high);
        for (const double value : {low, high}) {
            CHECK_FALSE(store(key, value).has_value());
            CHECK_FALSE(store(key, Bare{shortest(value)}).has_value());
            CHECK_FALSE(store(key, shortest(value)).has_value());
            const double written = is_fraction(key) ? value * 100 : value;
            CHECK_FALSE(store(key, shortest(written) + unit_of(key)).has_value());
            if (!unit_of(key).empty())
                CHECK_FALSE(store(key, Bare{shortest(written) + ' ' + unit_of(key)}).has_value());
            CHECK(store(key, shortest(value) + "furlong").has_value());
        }
        const double beyond = std::max(1.0, std::abs(high)) * 0.01;
        for (const double value :
             {low - beyond, high + beyond, std::nan(""), HUGE_VAL, -HUGE_VAL}) {
            const Complaint complaint = store(key, value);
            REQUIRE(complaint.has_value());
            CHECK(complaint->starts_with("expected " + key.accepts + ", found "));
        }
        CHECK(store(key, Bare{"1e400"}).has_value());
        CHECK(store(key, Bare{"0x10"}).has_value());
    }
    CHECK(numbers > 60);
}

TEST_CASE("keys: each refuses every wrong type and says what it accepts") {
    for (const Key& key : keys()) {
        CAPTURE(key.path);
        std::vector<Given> wrong{Scalar(std::monostate()), Given(List{Scalar(true)}), Scalar("")};
        if (key.accepts != "true or false") {
            wrong.push_back(Scalar(true));
        } else {
            for (const char* text : {"yes", "1", "True", "on"}) wrong.push_back(Scalar(Bare{text}));
            wrong.push_back(Scalar(std::string("true")));
        }
        if (!is_number(key)) wrong.push_back(Scalar(1.0));
        if (key.accepts != "a text") wrong.push_back(Scalar(std::string("nonsense")));
        wrong.push_back(Scalar(std::string("a\nb")));
        wrong.push_back(Scalar(Bare{"\xff"}));
        for (const Given& given : wrong) {
            Profile profile;
            const Complaint complaint = key.store(given, profile);
            REQUIRE(complaint.has_value());
            CHECK(complaint->starts_with("expected "));
            CHECK(profile == Profile{});
        }
    }
}

TEST_CASE("keys: choices take each of their names, and suggest one for a slip") {
    std::size_t choices = 0;
    for (const Key& key : keys()) {
        if (!is_choice(key)) continue;
        ++choices;
        std::string names = key.accepts;
        names.replace(names.find(" or "), 4, ", ");
        std::istringstream words(names);
        for (std::string name; std::getline(words, name, ',');) {
            name.erase(0, name.find_first_not_of(' '));
            CAPTURE(name);
            Profile profile;
            CHECK_FALSE(key.store(Scalar(name), profile).has_value());
            CHECK(key.show(profile) == '"' + name + '"');
            const Complaint complaint = store(key, Bare{name + name.back()});
            REQUIRE(complaint.has_value());
            CHECK(complaint->ends_with("did you mean `" + name + "`?"));
        }
    }
    CHECK(choices == 9);
}

TEST_CASE("keys: a slip of one letter in any key is told with the key that is meant") {
    for (const Key& key : keys()) {
        for (std::size_t i = 0; i < key.path.size(); ++i) {
            std::string doubled = key.path, replaced = key.path;
            doubled.insert(i, 1, key.path[i]);
            replaced[i] = key.path[i] == 'q' ? 'k' : 'q';
            for (const std::string& slip : {doubled, replaced})
                error_of({{}, {{slip, "1", "--set"}}}, ExitStatus::usage,
                         "unknown key `" + slip + "`; did you mean `" + key.path + "`?");
        }
    }
}

TEST_CASE("keys: percentages and fractions are one, and a number that may mean either is refused") {
    const Key& key = keys()[number_of("infill.density")];
    const auto density = [&](const Scalar& scalar) {
        Profile profile;
        CHECK_FALSE(key.store(scalar, profile).has_value());
        return profile.infill.density;
    };
    CHECK(density(Bare{"15%"}) == 0.15);
    CHECK(density("15 %") == 0.15);
    CHECK(density(0.15) == 0.15);
    CHECK(density("7%") == 0.07);
    CHECK(density("33.3%") == 0.333);
    CHECK(density(1.0) == 1);
    CHECK(density(Bare{"0"}) == 0);
    CHECK(*store(key, 15.0) == "expected 0% to 100%, found 15; write \"15%\" or 0.15");
    CHECK(*store(key, Bare{"15"}) == "expected 0% to 100%, found \"15\"; write 15% or 0.15");
    CHECK(*store(key, "101%") == "expected 0% to 100%, found \"101%\"");
}

TEST_CASE("keys: values are shown as TOML that is read back bit for bit") {
    std::mt19937_64 random(7);
    for (int round = 0; round < 20; ++round) {
        for (std::size_t i = 0; i < keys().size(); ++i) {
            if (!is_number(keys()[i]) || keys()[i].accepts.starts_with("a whole")) continue;
            const auto [low, high] = range_of(keys()[i]);
            const double value = std::uniform_real_distribution<double>(low, high)(random);
            Profile profile;
            REQUIRE_FALSE(keys()[i].store(Scalar(value), profile).has_value());
            const std::string toml = keys()[i].show(profile);
            Profile again;
            const bool quoted = toml.front() == '"';
            REQUIRE_FALSE(
                keys()[i]
                    .store(quoted ? Scalar(toml.substr(1, toml.size() - 2)) : Scalar(Bare{toml}),
                           again)
                    .has_value());
            CHECK(again == profile);
        }
    }
}

TEST_CASE("keys: docs/profiles.md has the row of each, and of no other") {
    const std::string text = page();
    for (const Key& key : keys())
        CHECK_MESSAGE(text.find(row_of(key) + '\n') != text.npos, row_of(key));
    std::size_t rows = 0;
    for (std::size_t at = text.find("\n## "); (at = text.find("\n| `", at)) != text.npos; ++at)
        ++rows;
    CHECK(rows == keys().size());
}
