#include "bench/tower.h"

#include <array>
#include <numbers>
#include <vector>

#include "parser/import/step_text.h"

namespace lyr::bench {
namespace {

// The rounded square has eight corners and eight sides: side 2c is the arc about the corner's centre c, side 2c + 1
// the line from there to the next arc. All run counter-clockwise, side i from corner i to corner i + 1.
constexpr std::size_t sides = 8;

Vector3 quarter(std::size_t turns) {
    constexpr std::array<std::array<double, 2>, 4> directions{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    const auto& direction = directions[turns % 4];
    return {direction[0], direction[1], 0};
}

Point3 centre(std::size_t c, double z_mm) {
    constexpr double reach_mm = tower_half_width_mm - tower_radius_mm;
    return reach_mm * (quarter(c) + quarter(c + 1)) + z_mm * Vector3::UnitZ();
}

Point3 corner(std::size_t i, double z_mm) {
    return centre(i / 2, z_mm) + tower_radius_mm * quarter(i / 2 + i % 2);
}

// What bounds a storey below or above.
struct Level {
    std::array<int, sides> vertices, edges;
};

Level level(test::StepText& step, double z_mm) {
    Level level{};
    for (std::size_t i = 0; i < sides; ++i) level.vertices[i] = step.vertex(corner(i, z_mm));
    for (std::size_t i = 0; i < sides; ++i) {
        const std::size_t next = (i + 1) % sides;
        int curve = 0;
        if (i % 2 == 0) {
            const int at = step.placement(centre(i / 2, z_mm), Vector3::UnitZ(), quarter(i / 2));
            curve = step.add("CIRCLE(''," + step.ref(at) + "," + step.num(tower_radius_mm) + ")");
        } else {
            curve = step.line(corner(i, z_mm), corner(next, z_mm));
        }
        level.edges[i] = step.edge(level.vertices[i], level.vertices[next], curve);
    }
    return level;
}

int cap(test::StepText& step, const Level& at, double z_mm, bool top) {
    std::vector<int> uses;
    for (std::size_t k = 0; k < sides; ++k) {
        uses.push_back(step.oriented(at.edges[top ? k : sides - 1 - k], top));
    }
    const Vector3 out = top ? Vector3::UnitZ() : Vector3(-Vector3::UnitZ());
    const int place = step.placement(z_mm * Vector3::UnitZ(), out, Vector3::UnitX());
    return step.face({step.bound(step.loop(uses))}, step.add("PLANE(''," + step.ref(place) + ")"));
}

void add_storey(test::StepText& step, const Level& below, const Level& above, double z_mm,
                std::vector<int>& faces) {
    std::array<int, sides> uprights{};
    for (std::size_t i = 0; i < sides; ++i) {
        const int line = step.line(corner(i, z_mm), corner(i, z_mm + tower_storey_mm));
        uprights[i] = step.edge(below.vertices[i], above.vertices[i], line);
    }
    for (std::size_t i = 0; i < sides; ++i) {
        const std::vector<int> uses{
            step.oriented(below.edges[i], true), step.oriented(uprights[(i + 1) % sides], true),
            step.oriented(above.edges[i], false), step.oriented(uprights[i], false)};
        int surface = 0;
        if (i % 2 == 0) {
            const int axis =
                step.placement(centre(i / 2, z_mm), Vector3::UnitZ(), Vector3::UnitX());
            surface = step.add("CYLINDRICAL_SURFACE(''," + step.ref(axis) + "," +
                               step.num(tower_radius_mm) + ")");
        } else {
            const int place = step.placement(corner(i, z_mm), quarter(i / 2 + 1), Vector3::UnitZ());
            surface = step.add("PLANE(''," + step.ref(place) + ")");
        }
        faces.push_back(step.face({step.bound(step.loop(uses))}, surface));
    }
}

}  // namespace

double tower_area_mm2() {
    return 4 * tower_half_width_mm * tower_half_width_mm -
           (4 - std::numbers::pi) * tower_radius_mm * tower_radius_mm;
}

std::string tower_step(std::size_t storeys) {
    test::StepText step;
    Level below = level(step, 0);
    std::vector<int> faces{cap(step, below, 0, false)};
    for (std::size_t s = 0; s < storeys; ++s) {
        const double z_mm = static_cast<double>(s) * tower_storey_mm;
        const Level above = level(step, z_mm + tower_storey_mm);
        add_storey(step, below, above, z_mm, faces);
        below = above;
    }
    faces.push_back(cap(step, below, static_cast<double>(storeys) * tower_storey_mm, true));
    const int shell = step.add("CLOSED_SHELL(''," + step.refs(faces) + ")");
    const int solid = step.add("MANIFOLD_SOLID_BREP('tower'," + step.ref(shell) + ")");
    step.product("tower", step.representation({solid}, step.millimetres()));
    return step.text();
}

}  // namespace lyr::bench
