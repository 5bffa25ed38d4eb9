// A machine that G-code runs on: what RS-274 and the firmwares' manuals say of each command, and nothing of how ours is
// written. It refuses what it does not know.

#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

namespace lyr::format::test {

struct GcodePlace {
    double x = 0, y = 0, z = 0;
};

struct GcodeMove {
    int line = 0;     // of the file, from 1
    int layer = 0;    // from 1; 0: before the first
    int command = 0;  // 0 to 3, as in G0 to G3
    bool wipes = false;
    GcodePlace from{}, to{}, center{};
    double sweep_rad = 0;  // signed
    double filament_mm = 0, speed_mm_min = 0;
    std::string type{};

    bool moves() const {
        return from.x != to.x || from.y != to.y || from.z != to.z || sweep_rad != 0;
    }
    double radius() const { return std::hypot(from.x - center.x, from.y - center.y); }
    double off_circle() const {
        return std::abs(std::hypot(to.x - center.x, to.y - center.y) - radius());
    }
    double length() const {
        const double flat = sweep_rad != 0 ? radius() * std::abs(sweep_rad)
                                           : std::hypot(to.x - from.x, to.y - from.y);
        return std::hypot(flat, to.z - from.z);
    }
    GcodePlace middle() const {
        if (sweep_rad == 0) return {(from.x + to.x) / 2, (from.y + to.y) / 2, (from.z + to.z) / 2};
        const double angle = std::atan2(from.y - center.y, from.x - center.x) + sweep_rad / 2;
        return {center.x + radius() * std::cos(angle), center.y + radius() * std::sin(angle),
                (from.z + to.z) / 2};
    }
};

class GcodeMachine {
public:
    explicit GcodeMachine(const std::string& text) {
        std::istringstream lines(text);
        for (std::string line; std::getline(lines, line);) {
            ++line_;
            run(line);
        }
    }

    std::vector<GcodeMove> moves;
    std::map<std::string, int> commands;  // how often each
    std::vector<std::string> comments;    // without the semicolon
    std::vector<std::string> object_names;
    std::map<std::string, std::string> told;  // of commands with words, the last
    std::vector<int> percent;

private:
    void run(const std::string& line) {
        const std::size_t semicolon = line.find(';');
        if (semicolon != std::string::npos) comment(line.substr(semicolon + 1));
        std::istringstream in(line.substr(0, semicolon));
        std::string command;
        if (!(in >> command)) return;
        ++commands[command];
        told[command] = line;
        if (line.starts_with("M486 A")) return object_names.push_back(line.substr(6));
        std::map<char, double> words;
        const bool is_word = command[0] == 'G' || command[0] == 'M' || command[0] == 'T';
        for (std::string word; is_word && in >> word;) {
            CAPTURE(line);
            std::size_t used = 0;
            const double value = std::stod(word.substr(1), &used);
            REQUIRE(used + 1 == word.size());
            REQUIRE(words.emplace(word[0], value).second);
        }
        if (command == "G90" || command == "G21" || command == "G28") return;
        if (command == "M82" || command == "M83") {
            absolute_ = command == "M82";
        } else if (command == "G92") {
            REQUIRE(words.size() == 1);
            filament_ = words.at('E');
        } else if (command[0] == 'G' && command.size() == 2 && command[1] <= '3') {
            move(command[1] - '0', words);
        } else if (command == "M73") {
            percent.push_back(static_cast<int>(words.at('P')));
        }
    }

    void comment(const std::string& text) {
        comments.push_back(text);
        if (text == "LAYER_CHANGE") ++layer_;
        if (text.starts_with("TYPE:")) type_ = text.substr(5);
        if (text == "WIPE_START") wipes_ = true;
        if (text == "WIPE_END") wipes_ = false;
    }

    void move(int command, const std::map<char, double>& words) {
        const auto word = [&](char letter, double otherwise) {
            const auto found = words.find(letter);
            return found == words.end() ? otherwise : found->second;
        };
        GcodeMove one{.line = line_,
                      .layer = layer_,
                      .command = command,
                      .wipes = wipes_,
                      .from = at_,
                      .type = type_};
        one.to = {word('X', at_.x), word('Y', at_.y), word('Z', at_.z)};
        if (words.contains('E')) {
            one.filament_mm = words.at('E') - (absolute_ ? filament_ : 0);
            filament_ = absolute_ ? words.at('E') : filament_ + words.at('E');
        }
        speed_ = word('F', speed_);
        one.speed_mm_min = speed_;
        if (command >= 2) turn(one, word('I', 0), word('J', 0));
        at_ = one.to;
        moves.push_back(one);
    }

    void turn(GcodeMove& one, double i, double j) {
        constexpr double whole = 2 * std::numbers::pi;
        REQUIRE((i != 0 || j != 0));
        one.center = {one.from.x + i, one.from.y + j, 0};
        const double begin = std::atan2(-j, -i);
        const double end = std::atan2(one.to.y - one.center.y, one.to.x - one.center.x);
        double sweep = one.command == 3 ? end - begin : begin - end;
        if (sweep < 0) sweep += whole;
        if (one.to.x == one.from.x && one.to.y == one.from.y) sweep = whole;
        one.sweep_rad = one.command == 3 ? sweep : -sweep;
    }

    GcodePlace at_;
    bool absolute_ = true, wipes_ = false;
    double filament_ = 0, speed_ = 0;
    int line_ = 0, layer_ = 0;
    std::string type_;
};

}  // namespace lyr::format::test
