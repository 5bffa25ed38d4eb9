// Starts the programs as a user does, through a shell, each test in a folder of its own.

#pragma once

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "scratch.h"

namespace lyr::tests {

namespace fs = std::filesystem;

struct Ended {
    int status = -1;
    std::string out, err;
};

inline std::string text_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

class Folder {
public:
    explicit Folder(const std::string& name) : path_(scratch_folder(name)) {}

    fs::path operator/(const std::string& name) const { return path_ / name; }
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(path_ / name, std::ios::binary) << text;
    }
    void copy(const std::string& fixture, const std::string& name) const {
        fs::copy_file(fs::path(LYR_FIXTURES) / fixture, path_ / name);
    }
    void make_pipe(const std::string& name) const {
        REQUIRE(::mkfifo((path_ / name).c_str(), 0600) == 0);
    }
    std::set<std::string> files() const {
        std::set<std::string> names;
        for (const auto& entry : fs::directory_iterator(path_))
            names.insert(entry.path().filename());
        return names;
    }

    // Runs a shell script here. The programs are found by their names; what takes too long has status 124.
    Ended run(const std::string& script) const {
        const std::string base = path_.string();
        std::ofstream(base + ".sh") << "cd '" << base << "'\nPATH='" LYR_BUILD "':$PATH\n"
                                    << script << '\n';
        const std::string command =
            "timeout 60 sh '" + base + ".sh' >'" + base + ".out' 2>'" + base + ".err' </dev/null";
        const int status = std::system(command.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(base + ".out"),
                text_of(base + ".err")};
    }

private:
    fs::path path_;
};

inline std::size_t lines_in(const std::string& text) {
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

// One line that begins with the program's name and has `part` in it, nothing else, and the status.
inline void check_failure(const Ended& ended, const std::string& program, int status,
                          const std::string& part) {
    CAPTURE(ended.err);
    CHECK(ended.status == status);
    CHECK(ended.out.empty());
    CHECK(ended.err.starts_with(program + ": "));
    CHECK(lines_in(ended.err) == 1);
    CHECK(ended.err.find(part) != std::string::npos);
    for (const char c : ended.err) CHECK((c == '\n' || static_cast<unsigned char>(c) >= 0x20));
}

inline void check_lyrrun_failure(const Ended& ended, int status, const std::string& part) {
    check_failure(ended, "lyrrun", status, part);
}

inline void check_lyrview_failure(const Ended& ended, int status, const std::string& part) {
    check_failure(ended, "lyrview", status, part);
}

// The number that follows the first of these words.
inline double number_after(const std::string& text, const std::string& words) {
    const std::size_t at = text.find(words);
    REQUIRE_MESSAGE(at != std::string::npos, text);
    return std::stod(text.substr(at + words.size()));
}

// A program that is on its way while the test goes on.
class Running {
public:
    // `arguments` begins with the program's name; standard error goes to `err`.
    Running(const Folder& folder, std::vector<std::string> arguments, const fs::path& err)
        : process_(::fork()) {
        REQUIRE(process_ >= 0);
        if (process_ > 0) return;
        const int output = ::open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        const int null = ::open("/dev/null", O_WRONLY);
        ::dup2(output, STDERR_FILENO);
        ::dup2(null, STDOUT_FILENO);
        std::vector<char*> words;
        for (std::string& argument : arguments) words.push_back(argument.data());
        words.push_back(nullptr);
        if (::chdir((folder / "").c_str()) == 0)
            ::execv((fs::path(LYR_BUILD) / arguments[0]).c_str(), words.data());
        ::_exit(127);
    }

    // False if it has not come true within a generous time.
    bool wait_for(const std::function<bool()>& condition) const {
        for (int i = 0; i < 6000; ++i) {
            if (condition()) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        return false;
    }

    // Whether it has put the signal under its own control.
    bool blocks(int signal) const {
        std::ifstream status("/proc/" + std::to_string(process_) + "/status");
        for (std::string line; std::getline(status, line);) {
            if (!line.starts_with("SigBlk:")) continue;
            return (std::stoull(line.substr(7), nullptr, 16) >> (signal - 1) & 1) != 0;
        }
        return false;
    }

    // Memory that is in place.
    long resident_kb() const {
        std::ifstream status("/proc/" + std::to_string(process_) + "/status");
        for (std::string line; std::getline(status, line);)
            if (line.starts_with("VmRSS:")) return std::stol(line.substr(6));
        return -1;
    }

    // The exit status after the signal; -1 if the signal killed it.
    int end(int signal) const {
        ::kill(process_, signal);
        int status = 0;
        ::waitpid(process_, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

private:
    pid_t process_;
};

}  // namespace lyr::tests
