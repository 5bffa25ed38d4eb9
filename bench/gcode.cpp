#include "bench/gcode.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <numbers>
#include <string_view>

namespace lyr::bench {
namespace {

// Coordinates have three digits: an end lies up to 0.0007 mm off.
constexpr double rounding_mm = 0.001;

double number_in(std::string_view text) {
    double value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

// Follows the lines of a file.
class Follower {
public:
    explicit Follower(double filament_mm2) : filament_mm2_(filament_mm2) {}

    void operator()(std::string_view line) {
        if (line.starts_with(';')) {
            comment(line);
        } else if (line.starts_with("G1 ")) {
            move(line.substr(3));
        } else if (line.starts_with("G92 E")) {
            filament_mm_ = number_in(line.substr(5));
        }
    }

    Gcode take() {
        finish_wall();
        return std::move(gcode_);
    }

private:
    void comment(std::string_view line) {
        const auto value_of = [&](std::string_view key) {
            return line.starts_with(key) ? line.substr(key.size()) : std::string_view();
        };
        if (const auto type = value_of(";TYPE:"); !type.empty()) {
            finish_wall();
            outermost_ = type == "External perimeter";
        }
        if (const auto top = value_of(";Z:"); !top.empty()) {
            finish_wall();
            top_mm_ = number_in(top);
        }
        if (const auto width = value_of(";WIDTH:"); !width.empty()) {
            finish_wall();
            width_mm_ = number_in(width);
        }
    }

    void move(std::string_view words) {
        Point2 to = at_;
        double filament_mm = filament_mm_;
        bool moves = false;
        while (!words.empty() && words.front() != ';') {
            const std::string_view word = words.substr(0, words.find(' '));
            words.remove_prefix(std::min(words.size(), word.size() + 1));
            if (word.empty()) continue;
            const double value = number_in(word.substr(1));
            if (word.front() == 'X') to.x() = value;
            if (word.front() == 'Y') to.y() = value;
            if (word.front() == 'E') filament_mm = value;
            moves = moves || word.front() == 'X' || word.front() == 'Y';
        }
        if (moves && filament_mm > filament_mm_) {
            gcode_.volume_mm3 += (filament_mm - filament_mm_) * filament_mm2_;
            if (outermost_) extend_wall(to);
        } else if (moves) {
            finish_wall();
        }
        at_ = to;
        filament_mm_ = filament_mm;
    }

    void extend_wall(const Point2& to) {
        if (wall_.middle.empty()) wall_ = {{at_}, top_mm_, width_mm_};
        if (to != wall_.middle.back()) wall_.middle.push_back(to);
    }

    void finish_wall() {
        if (wall_.middle.size() > 2) gcode_.walls.push_back(wall_);
        wall_.middle.clear();
    }

    double filament_mm2_;
    Gcode gcode_;
    GcodeWall wall_;
    Point2 at_ = Point2::Zero();
    double filament_mm_ = 0, top_mm_ = 0, width_mm_ = 0;
    bool outermost_ = false;
};

double cross(const Vector2& a, const Vector2& b) {
    return a.x() * b.y() - a.y() * b.x();
}

bool counter_clockwise(const std::vector<Point2>& loop) {
    double twice_area = 0;
    for (std::size_t i = 0; i < loop.size(); ++i)
        twice_area += cross(loop[i] - loop[0], loop[(i + 1) % loop.size()] - loop[0]);
    return twice_area > 0;
}

bool contains(const std::vector<Point2>& loop, const Point2& point) {
    bool inside = false;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Point2 &a = loop[i], &b = loop[(i + 1) % loop.size()];
        if ((a.y() > point.y()) == (b.y() > point.y())) continue;
        const double x = a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
        if (x > point.x()) inside = !inside;
    }
    return inside;
}

double distance_mm(const Point2& point, const Point2& start, const Point2& end) {
    const Vector2 along = end - start;
    const double share = std::clamp((point - start).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (start + share * along - point).norm();
}

bool covered(const GcodeWall& wall, const Point2& point) {
    for (std::size_t i = 0; i + 1 < wall.middle.size(); ++i) {
        const double away_mm = distance_mm(point, wall.middle[i], wall.middle[i + 1]);
        if (away_mm < wall.width_mm / 2 - rounding_mm) return true;
    }
    return false;
}

// Of contract 3: +1 where the flank is to the right of the motions, else -1.
std::vector<double> sides(const std::vector<GcodeWall>& walls) {
    std::vector<double> sides;
    for (const GcodeWall& wall : walls) {
        const auto around = std::count_if(walls.begin(), walls.end(), [&](const GcodeWall& other) {
            return &other != &wall && other.top_mm == wall.top_mm &&
                   contains(other.middle, wall.middle[0]);
        });
        sides.push_back(counter_clockwise(wall.middle) == (around % 2 == 0) ? 1 : -1);
    }
    return sides;
}

double length_mm(const std::vector<Point2>& run) {
    double length_mm = 0;
    for (std::size_t i = 0; i + 1 < run.size(); ++i) length_mm += (run[i + 1] - run[i]).norm();
    return length_mm;
}

}  // namespace

Result<Gcode> read_gcode(const std::string& path, double filament_diameter_mm) {
    std::ifstream file(path);
    Follower follow(std::numbers::pi / 4 * filament_diameter_mm * filament_diameter_mm);
    for (std::string line; std::getline(file, line);) follow(line);
    Gcode gcode = follow.take();
    if (gcode.walls.empty()) {
        return Diagnostic{Severity::error,
                          ExitStatus::internal,
                          "no outermost walls in this G-code",
                          {.file = path}};
    }
    return gcode;
}

std::vector<Point3> flank_points(const std::vector<GcodeWall>& walls, double layer_height_mm,
                                 std::size_t count) {
    double total_mm = 0;
    for (const GcodeWall& wall : walls) total_mm += length_mm(wall.middle);
    const double spacing_mm = total_mm / static_cast<double>(count);
    const std::vector<double> side = sides(walls);
    std::vector<Point3> points;
    double next_mm = spacing_mm / 2;  // from the start of the motion that is looked at
    for (std::size_t w = 0; w < walls.size(); ++w) {
        const GcodeWall& wall = walls[w];
        for (std::size_t i = 0; i + 1 < wall.middle.size(); ++i) {
            const Vector2 motion = wall.middle[i + 1] - wall.middle[i];
            const double motion_mm = motion.norm();
            const Vector2 along = motion / motion_mm;
            const Vector2 out = side[w] * wall.width_mm / 2 * Vector2(along.y(), -along.x());
            for (; next_mm < motion_mm; next_mm += spacing_mm) {
                const Point2 at = wall.middle[i] + next_mm * along + out;
                if (!covered(wall, at))
                    points.push_back({at.x(), at.y(), wall.top_mm - layer_height_mm / 2});
            }
            next_mm -= motion_mm;
        }
    }
    return points;
}

}  // namespace lyr::bench
