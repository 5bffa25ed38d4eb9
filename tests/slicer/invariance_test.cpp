// What must not matter: the order of instances in the file, their numbers, and a height's last digits.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <regex>

#include "kernel/section/cutter.h"
#include "scratch.h"
#include "slicer/layers.h"
#include "slicer/scene.h"
#include "slicer/slicer.h"

using namespace lyr;
using namespace lyr::slicer;
using lyr::testing::parts;

namespace {

// The lower teeth take too long for what they add.
const std::vector<std::string> files{
    "332_file.stp",         "abstract_pca.step",
    "cube_hole.step",       "cuboid.step",
    "foot_front_000.stp",   "foot_structure.step",
    "gearbox_base.step",    "head_front.stp",
    "tail_middle_part.stp", "transmission_pulley_at3_t10_center.step"};

std::string text_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

// The statements of a text: what ends with a semicolon outside quotes.
std::vector<std::string> statements(const std::string& text) {
    std::vector<std::string> result;
    bool quoted = false;
    std::size_t from = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '\'') quoted = !quoted;
        if (quoted || text[i] != ';') continue;
        result.push_back(text.substr(from, i + 1 - from));
        from = i + 1;
    }
    return result;
}

// Every #id outside quotes by another.
std::string renumbered(const std::string& statement,
                       const std::map<std::string, std::string>& names) {
    std::string result;
    bool quoted = false;
    for (std::size_t i = 0; i < statement.size(); ++i) {
        if (statement[i] == '\'') quoted = !quoted;
        if (quoted || statement[i] != '#') {
            result += statement[i];
            continue;
        }
        const std::size_t end = statement.find_first_not_of("0123456789", i + 1);
        result += '#' + names.at(statement.substr(i + 1, end - i - 1));
        i = end - 1;
    }
    return result;
}

// The same file with its instances in random order and with random numbers.
std::string shuffled(const std::string& text, unsigned seed) {
    std::vector<std::string> all = statements(text);
    const auto is_data = [](const std::string& s) { return s.find("DATA;") != s.npos; };
    const auto first = std::find_if(all.begin(), all.end(), is_data) + 1;
    const auto last = std::find_if(
        first, all.end(), [](const std::string& s) { return s.find("ENDSEC;") != s.npos; });
    std::mt19937 random(seed);
    std::shuffle(first, last, random);
    std::vector<std::size_t> numbers(static_cast<std::size_t>(last - first));
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = 3 * i + 7;
    std::shuffle(numbers.begin(), numbers.end(), random);
    std::map<std::string, std::string> names;
    const std::regex name(R"(#([0-9]+)\s*=)");
    for (auto s = first; s != last; ++s) {
        std::smatch match;
        REQUIRE(std::regex_search(*s, match, name));
        names[match[1]] = std::to_string(numbers[static_cast<std::size_t>(s - first)]);
    }
    std::string result;
    for (auto s = all.begin(); s != all.end(); ++s)
        result += s >= first && s < last ? renumbered(*s, names) : *s;
    return result + "\n";
}

Model loaded(const std::string& path) {
    Diagnostics found;
    auto model = load(path, {}, found);
    REQUIRE_MESSAGE(model, path, ": ", model ? "" : to_string(model.error()));
    return std::move(*model);
}

}  // namespace

TEST_CASE("the order of instances and their numbers change no section") {
    for (const std::string& file : files) {
        CAPTURE(file);
        const Model model = loaded(parts + file);
        const Cutter cutter(model, {});
        const HeightRange range = cutter.height_range();
        for (unsigned seed = 1; seed <= 2; ++seed) {
            std::ofstream(lyr::tests::scratch(file), std::ios::binary)
                << shuffled(text_of(parts + file), seed);
            const Model other = loaded(lyr::tests::scratch(file));
            CHECK(other.faces.size() == model.faces.size());
            const Cutter other_cutter(other, {});
            for (double share = 0.013; share < 1; share += 0.047) {
                CAPTURE(share);
                const double z = range.bottom_mm + share * (range.top_mm - range.bottom_mm);
                const SectionFigures a = figures_of(cutter.cut(z)),
                                     b = figures_of(other_cutter.cut(z));
                CHECK(a.loops == b.loops);
                CHECK(a.open == b.open);
                CHECK(std::abs(a.area_mm2 - b.area_mm2) <=
                      1e-9 * a.area_mm2 + Tolerance{}.total_mm * 0.1 * a.length_mm);
            }
        }
    }
}

TEST_CASE(
    "at the height of any vertex, and a part in 10^9 beside it, the section is a neighbour's") {
    // Heights where the topology may change lie farther apart than this, or are left to other tests.
    constexpr double apart_mm = 1e-4;
    // Off a level line of a cylinder, walls set out as the root of the height.
    constexpr double wander_mm = 0.01;
    for (const std::string& file : files) {
        CAPTURE(file);
        const Model model = loaded(parts + file);
        const Cutter cutter(model, {});
        std::vector<double> heights;
        for (const Vertex& vertex : model.vertices) heights.push_back(vertex.point.z());
        std::sort(heights.begin(), heights.end());
        const auto near = [](double a, double b) { return b - a < 1e-6; };
        heights.erase(std::unique(heights.begin(), heights.end(), near), heights.end());
        std::size_t tried = 0;
        for (std::size_t i = 0; i < heights.size(); i += 1 + heights.size() / 60) {
            const double z = heights[i];
            const bool close = (i > 0 && z - heights[i - 1] < 2 * apart_mm) ||
                               (i + 1 < heights.size() && heights[i + 1] - z < 2 * apart_mm);
            if (close) continue;
            ++tried;
            const SectionFigures below = figures_of(cutter.cut(z - apart_mm)),
                                 above = figures_of(cutter.cut(z + apart_mm));
            const double shift = std::max(std::abs(z), 1.0) * 1e-9;
            for (const double at : {z - shift, z, z + shift}) {
                CAPTURE(at);
                const SectionFigures here = figures_of(cutter.cut(at));
                CHECK(here.open == 0);
                CHECK((here.loops == below.loops || here.loops == above.loops));
                const double slack = wander_mm * (below.length_mm + above.length_mm);
                const auto [least, most] = std::minmax(below.area_mm2, above.area_mm2);
                CHECK(here.area_mm2 >= least - slack);
                CHECK(here.area_mm2 <= most + slack);
            }
        }
        CHECK(tried > 0);
    }
}
