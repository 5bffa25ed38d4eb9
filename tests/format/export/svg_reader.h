// Reads the SVG of a layer back: path data, circles and where they are used.

#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

namespace lyr::format::test {

// A motion of the picture, in mm.
struct Drawn {
    char kind = 'L';  // L, A or C
    double x0 = 0, y0 = 0, x = 0, y = 0;
    double radius = 0;
    bool large = false, positive = false;  // an arc's flags
};

inline std::vector<Drawn> parse_path(const std::string& data) {
    std::vector<Drawn> drawn;
    // A letter begins a word of its own.
    std::string spaced;
    for (const char c : data) {
        if (c == 'M' || c == 'L' || c == 'A')
            spaced += std::string(" ") + c + ' ';
        else
            spaced += c;
    }
    std::istringstream in(spaced);
    double x = 0, y = 0;
    for (char command = 0; in >> command;) {
        Drawn one;
        one.kind = command;
        one.x0 = x;
        one.y0 = y;
        if (command == 'A') {
            double second = 0, rotation = 0;
            in >> one.radius >> second >> rotation >> one.large >> one.positive;
            CHECK(second == one.radius);
            CHECK(rotation == 0);
        }
        in >> x >> y;
        REQUIRE(in);
        one.x = x;
        one.y = y;
        if (command != 'M') drawn.push_back(one);
    }
    return drawn;
}

// Of the arc, by SVG's own definition (implementation notes, "conversion from endpoint to centre").
inline double arc_length_mm(const Drawn& arc) {
    const double chord = std::hypot(arc.x - arc.x0, arc.y - arc.y0);
    const double half = std::asin(std::min(1.0, chord / 2 / arc.radius));
    const double turn = arc.large ? 2 * (std::numbers::pi - half) : 2 * half;
    return arc.radius * turn;
}

struct Group {
    std::vector<Drawn> motions;   // lines and arcs in order, then circles
    double widest_stroke_mm = 0;  // of the uses
    std::string title;
};

// The groups in the order in which they are used, and the travels.
struct Picture {
    std::vector<Group> groups;
    std::vector<Drawn> travels;
    double left = 0, top = 0, width = 0, height = 0;
};

inline std::string attribute(const std::string& element, const std::string& name) {
    const std::string opening = ' ' + name + "=\"";
    const std::size_t at = element.find(opening);
    if (at == std::string::npos) return "";
    const std::size_t begin = at + opening.size();
    return element.substr(begin, element.find('"', begin) - begin);
}

// The picture is written a group a line.
inline Picture parse_svg(const std::string& svg) {
    Picture picture;
    std::map<std::string, Group> defined;
    std::vector<std::string> used;
    std::string title;
    std::istringstream lines(svg);
    for (std::string line; std::getline(lines, line);) {
        if (line.rfind("<svg", 0) == 0) {
            std::istringstream box(attribute(line, "viewBox"));
            box >> picture.left >> picture.top >> picture.width >> picture.height;
        } else if (line.rfind("<g id=\"s", 0) == 0) {
            Group& group = defined["#" + attribute(line, "id")];
            const std::size_t path = line.find("<path");
            if (path != std::string::npos)
                group.motions =
                    parse_path(attribute(line.substr(path, line.find("/>", path) - path), "d"));
            for (std::size_t at = 0; (at = line.find("<circle", at)) != std::string::npos; ++at) {
                const std::string circle = line.substr(at, line.find("/>", at) - at);
                Drawn one;
                one.kind = 'C';
                one.x = std::stod(attribute(circle, "cx"));
                one.y = std::stod(attribute(circle, "cy"));
                one.radius = std::stod(attribute(circle, "r"));
                group.motions.push_back(one);
            }
        } else if (line.rfind("<g><title>", 0) == 0) {
            title = line.substr(10, line.find("</title>") - 10);
        } else if (line.rfind("<use", 0) == 0) {
            const std::string id = attribute(line, "xlink:href");
            Group& group = defined.at(id);
            group.title = title;
            group.widest_stroke_mm =
                std::max(group.widest_stroke_mm, std::stod(attribute(line, "stroke-width")));
            if (used.empty() || used.back() != id) used.push_back(id);
        } else if (line.rfind("<path id=\"travels\"", 0) == 0) {
            picture.travels = parse_path(attribute(line, "d"));
        }
    }
    for (const std::string& id : used) picture.groups.push_back(defined.at(id));
    return picture;
}

}  // namespace lyr::format::test
