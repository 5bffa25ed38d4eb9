#include "apps/print_server.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cctype>
#include <optional>

#include "target/control/places.h"
#include "target/control/server.h"

namespace lyr::command_line {
namespace {

// The first folder that can be written to; none.
std::optional<std::string> socket_folder() {
    for (const std::string& folder : control::socket_folders()) {
        // The user's own is made when it is first needed; the machine's is its service's.
        if (folder != control::machine_socket_folder) (void)::mkdir(folder.c_str(), 0700);
        if (::access(folder.c_str(), W_OK | X_OK) == 0) return folder;
    }
    return std::nullopt;
}

}  // namespace

struct PrintServer::Work {
    Work(const config::Printer& printer, run::PrintControl& print) : dispatcher(print, printer) {}

    control::Dispatcher dispatcher;
    std::optional<control::Listener> listener;
    std::optional<control::Server> server;
};

std::string socket_name(const std::string& printer_name) {
    std::string name;
    for (const char c : printer_name) {
        const auto letter = static_cast<unsigned char>(c);
        if (std::isalnum(letter) && letter < 0x80)
            name += static_cast<char>(std::tolower(letter));
        else if (!name.empty() && name.back() != '-')
            name += '-';
    }
    if (name.ends_with('-')) name.pop_back();
    constexpr std::size_t longest = 48;
    return (name.empty() ? "printer" : name.substr(0, longest)) + ".sock";
}

PrintServer::PrintServer(std::unique_ptr<Work> work) : work_(std::move(work)) {}
PrintServer::PrintServer(PrintServer&& other) noexcept = default;
PrintServer::~PrintServer() = default;

Result<PrintServer> PrintServer::open(const std::string& socket, const config::Printer& printer,
                                      run::PrintControl& print) {
    auto work = std::make_unique<Work>(printer, print);
    const auto folder = socket.empty() ? socket_folder() : std::nullopt;
    if (!socket.empty() || folder) {
        Result<control::Listener> listener =
            control::Listener::open(folder ? *folder + '/' + socket_name(printer.name) : socket);
        if (!listener) return listener.error();
        work->listener.emplace(std::move(*listener));
    }
    return PrintServer(std::move(work));
}

bool PrintServer::is_reachable() const {
    return work_->listener.has_value();
}

Diagnostics PrintServer::notes() const {
    if (is_reachable()) return {};
    return {{Severity::note,
             ExitStatus::ok,
             "lyrctl cannot reach this print: there is no folder for its socket; --socket makes "
             "one elsewhere",
             {}}};
}

void PrintServer::start() {
    if (work_->listener) work_->server.emplace(std::move(*work_->listener), work_->dispatcher);
}

}  // namespace lyr::command_line
