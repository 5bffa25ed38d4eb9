// How a print of lyrrun can be reached while it runs.

#pragma once

#include <memory>
#include <string>

#include "base/diagnostic.h"
#include "target/config/printer.h"
#include "target/run/print_control.h"

namespace lyr::command_line {

// "Ender 3 (left)" is ender-3-left.sock
std::string socket_name(const std::string& printer_name);

class PrintServer {
public:
    // The socket is made, but nobody is served before start(). `socket` empty: where lyrctl looks for it, if that can be
    // written to. Errors (status machine): the socket cannot be had. `printer` and `print` must outlive it.
    static Result<PrintServer> open(const std::string& socket, const config::Printer& printer,
                                    run::PrintControl& print);
    PrintServer(PrintServer&& other) noexcept;
    PrintServer& operator=(PrintServer&&) = delete;
    ~PrintServer();

    // Somebody can give commands.
    bool is_reachable() const;
    // What the user must know before start().
    Diagnostics notes() const;
    // On a thread of its own.
    void start();

private:
    struct Work;

    explicit PrintServer(std::unique_ptr<Work> work);

    std::unique_ptr<Work> work_;
};

}  // namespace lyr::command_line
