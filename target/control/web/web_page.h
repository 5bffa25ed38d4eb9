// A page for the browser of whoever sits at the board: progress, temperatures, the layer that is being printed, and
// buttons. Served by libmicrohttpd, in a program of its own: what drives motors and heaters has no web server.
//
// Contract
//  1. It can be reached by this machine alone: 127.0.0.1 and ::1.
//  2. Without the token nothing is controlled; who has none sees the print and its status.
//  3. A request that another site's page makes is refused: its Host is not that of this page (a name that was bent to
//     this machine), or its Origin or Sec-Fetch-Site tells. The page may not be put into a frame.
//  4. What is held is bounded: most_connections, each with its buffer and most_line_bytes of a command.

#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "target/control/web/relay.h"

namespace lyr::control {

struct WebSettings {
    std::uint16_t port = 0;  // 0: one that is free
    std::string token;
};

class WebPage {
public:
    static constexpr unsigned most_connections = 16;

    // Errors (status machine): the port is taken or not allowed. The relay must outlive the page.
    static Result<WebPage> open(WebSettings settings, Relay& relay);
    WebPage(WebPage&& other) noexcept;
    WebPage& operator=(WebPage&&) = delete;
    ~WebPage();

    // Answers what browsers ask, without waiting for them; for at most `longest_wait` it waits until they ask, or the
    // print tells something.
    void serve(std::chrono::milliseconds longest_wait);
    // "http://127.0.0.1:8080/"
    std::string address() const;

private:
    class Work;

    explicit WebPage(std::unique_ptr<Work> work);

    std::unique_ptr<Work> work_;
};

}  // namespace lyr::control
