// Reads wave files (VCD) back, for tests: only the subset of IEEE 1364 that a dump of single wires needs.
// Shares nothing with the writer.

#pragma once

#include <doctest/doctest.h>

#include <cstdint>
#include <fstream>
#include <map>
#include <string>

namespace lyr::tests {

struct Wave {
    std::string timescale;
    std::map<std::string, std::string> wires;                     // id -> name
    std::map<std::int64_t, std::map<std::string, char>> changes;  // time -> name -> level
    std::int64_t end_ns = 0;
    std::size_t change_count = 0;
};

inline Wave read_wave(const std::string& path) {
    std::ifstream file(path);
    Wave wave;
    std::string word;
    while (file >> word) {
        if (word == "$timescale") {
            while (file >> word && word != "$end") wave.timescale += word;
        } else if (word == "$var") {
            std::string type, width, id, name, end;
            file >> type >> width >> id >> name >> end;
            CHECK(type == "wire");
            CHECK(width == "1");
            CHECK(end == "$end");
            CHECK(wave.wires.emplace(id, name).second);
        } else if (word[0] == '#') {
            const std::int64_t time_ns = std::stoll(word.substr(1));
            CHECK(time_ns >= wave.end_ns);
            wave.end_ns = time_ns;
        } else if (word[0] == '0' || word[0] == '1') {
            REQUIRE(wave.wires.count(word.substr(1)) == 1);
            wave.changes[wave.end_ns][wave.wires[word.substr(1)]] = word[0];
            ++wave.change_count;
        }
    }
    return wave;
}

}  // namespace lyr::tests
