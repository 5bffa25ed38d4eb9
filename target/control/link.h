// A client's end of the control socket, for programs that ask and wait.
//
// Contract
//  1. open() has the greeting of a server that speaks this protocol; the error (status machine) says what it found else.
//     reach() waits for nothing, and take_greeting() no longer than it is told to.
//  2. No answer within patience is an error, as is the end of the connection; after that, all else is.

#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "base/diagnostic.h"
#include "target/control/answer.h"

namespace lyr::control {

class Link {
public:
    static constexpr std::chrono::seconds patience{5};

    static Result<Link> open(const std::string& path);
    // Connected, and not greeted yet.
    static Result<Link> reach(const std::string& path);
    // False: it has not come yet.
    Result<bool> take_greeting(std::chrono::milliseconds wait);

    Link(Link&& other) noexcept;
    Link& operator=(Link&&) = delete;
    ~Link();

    const Greeting& greeting() const { return greeting_; }
    Status send(const std::string& line);
    // The next one, whatever it answers.
    Result<Answer> next();
    // The same, or none within that time.
    Result<std::optional<Answer>> next_within(std::chrono::milliseconds wait);
    // What that was, as it came.
    const std::string& line() const { return line_; }
    int descriptor() const { return socket_; }

private:
    Link(std::string path, int socket) : path_(std::move(path)), socket_(socket) {}
    Status connect();
    Diagnostic problem(const std::string& what) const;

    std::string path_;
    int socket_;
    Greeting greeting_;
    std::string held_, line_;
};

}  // namespace lyr::control
