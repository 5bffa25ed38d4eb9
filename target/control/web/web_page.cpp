// libmicrohttpd is run without threads of its own: its two daemons, for the two addresses, are asked for what they wait
// for.

#include "target/control/web/web_page.h"

#include <fcntl.h>
#include <microhttpd.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <charconv>

#include "target/control/request.h"
#include "target/control/session.h"
#include "target/control/web/loopback.h"
#include "target/control/web/page_bytes.h"
#include "target/control/web/token.h"

namespace lyr::control {
namespace {

constexpr unsigned connection_timeout_s = 20;
constexpr std::size_t connection_memory_bytes = std::size_t{1} << 15;

// What a .lyr file begins with.
constexpr std::string_view print_magic = "LYR\x1a";

// The page is one file that asks nothing of anybody else.
constexpr const char* policy =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

// A command while it comes.
struct Body {
    std::string text;
    bool too_long = false;
};

std::string_view header(MHD_Connection* connection, const char* name) {
    const char* value = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, name);
    return value ? value : "";
}

// Of an Accept-Encoding. Who sends none may take anything, but is a program that most likely unpacks nothing.
bool takes_gzip(std::string_view accepted) {
    const std::size_t at = accepted.find("gzip");
    if (at == std::string_view::npos) return false;
    const std::string_view after = accepted.substr(at);
    return !after.starts_with("gzip;q=0") || after.starts_with("gzip;q=0.");
}

struct Release {
    void operator()(MHD_Response* response) const { MHD_destroy_response(response); }
};
using Response = std::unique_ptr<MHD_Response, Release>;

Response response_of(std::string_view bytes) {
    // libmicrohttpd does not write to what it copies.
    return Response(MHD_create_response_from_buffer(bytes.size(), const_cast<char*>(bytes.data()),
                                                    MHD_RESPMEM_MUST_COPY));
}

MHD_Result send(MHD_Connection* connection, unsigned status, Response response, const char* type) {
    if (!response) return MHD_NO;
    const std::array<std::pair<const char*, const char*>, 6> headers{{
        {MHD_HTTP_HEADER_CONTENT_TYPE, type},
        {MHD_HTTP_HEADER_CACHE_CONTROL, "no-store"},
        {"X-Content-Type-Options", "nosniff"},
        {"Referrer-Policy", "no-referrer"},
        {"Content-Security-Policy", policy},
        {"Cross-Origin-Resource-Policy", "same-origin"},
    }};
    for (const auto& [name, value] : headers) MHD_add_response_header(response.get(), name, value);
    return MHD_queue_response(connection, status, response.get());
}

MHD_Result send_json(MHD_Connection* connection, unsigned status, const std::string& json) {
    return send(connection, status, response_of(json), "application/json");
}

MHD_Result refuse(MHD_Connection* connection, unsigned status, ErrorCode code,
                  const char* message) {
    return send_json(connection, status, refusal_line({"null", code, message}));
}

}  // namespace

class WebPage::Work {
public:
    Work(WebSettings settings, Relay& relay) : settings_(std::move(settings)), relay_(relay) {}
    ~Work() {
        for (MHD_Daemon* daemon : daemons_) MHD_stop_daemon(daemon);
    }
    Work(const Work&) = delete;
    Work& operator=(const Work&) = delete;

    Status open();
    void serve(std::chrono::milliseconds longest_wait);
    std::string address() const {
        return "http://127.0.0.1:" + std::to_string(settings_.port) + '/';
    }

private:
    bool add(int socket);
    static void run(MHD_Daemon* daemon);
    static MHD_Result handle(void* work, MHD_Connection* connection, const char* url,
                             const char* method, const char* version, const char* bytes,
                             std::size_t* size, void** body);
    static void forget(void*, MHD_Connection*, void** body, MHD_RequestTerminationCode) {
        delete static_cast<Body*>(*body);
        *body = nullptr;
    }

    bool is_own_host(std::string_view host) const;
    // Why another site's page may not do this; none: it is not one.
    const char* objection(MHD_Connection* connection, std::string_view url) const;
    MHD_Result get(MHD_Connection* connection, std::string_view url);
    MHD_Result post(MHD_Connection* connection, const Body& body);
    MHD_Result send_page(MHD_Connection* connection) const;
    MHD_Result send_status(MHD_Connection* connection) const;
    MHD_Result send_print(MHD_Connection* connection) const;

    WebSettings settings_;
    Relay& relay_;
    std::vector<MHD_Daemon*> daemons_;
    std::vector<pollfd> awaited_;  // each daemon's, then the print's
};

Status WebPage::Work::open() {
    const Result<std::pair<int, int>> sockets = listen_on_loopback(settings_.port);
    if (!sockets) return sockets.error();
    const bool added = add(sockets->first) && (sockets->second < 0 || add(sockets->second));
    if (added) return Done{};
    return machine_error("the page's server does not start");
}

bool WebPage::Work::add(int socket) {
    MHD_Daemon* daemon =
        MHD_start_daemon(MHD_USE_EPOLL, settings_.port, nullptr, nullptr, &Work::handle, this,
                         MHD_OPTION_LISTEN_SOCKET, socket, MHD_OPTION_CONNECTION_LIMIT,
                         most_connections, MHD_OPTION_CONNECTION_TIMEOUT, connection_timeout_s,
                         MHD_OPTION_CONNECTION_MEMORY_LIMIT, connection_memory_bytes,
                         MHD_OPTION_NOTIFY_COMPLETED, &Work::forget, nullptr, MHD_OPTION_END);
    if (!daemon) {
        ::close(socket);
        return false;
    }
    daemons_.push_back(daemon);
    const MHD_DaemonInfo* info = MHD_get_daemon_info(daemon, MHD_DAEMON_INFO_EPOLL_FD);
    if (!info) return false;
    awaited_.push_back({info->epoll_fd, POLLIN, 0});
    return true;
}

void WebPage::Work::serve(std::chrono::milliseconds longest_wait) {
    std::vector<pollfd> all = awaited_;
    all.push_back({relay_.descriptor(), POLLIN, 0});
    ::poll(all.data(), all.size(), static_cast<int>(longest_wait.count()));
    relay_.serve();
    for (MHD_Daemon* daemon : daemons_) run(daemon);
}

// A call takes a piece of what each connection has; libmicrohttpd says whether there is more that epoll will not tell.
void WebPage::Work::run(MHD_Daemon* daemon) {
    // Other clients must have their turn.
    constexpr int most_pieces = 64;
    MHD_UNSIGNED_LONG_LONG wait_ms = 0;
    for (int piece = 0; piece < most_pieces; ++piece) {
        MHD_run(daemon);
        if (MHD_get_timeout(daemon, &wait_ms) != MHD_YES || wait_ms > 0) return;
    }
}

// Called when the headers are there, again with each piece of a body, and once more at its end.
MHD_Result WebPage::Work::handle(void* self, MHD_Connection* connection, const char* url,
                                 const char* method, const char*, const char* bytes,
                                 std::size_t* size, void** state) {
    Work& work = *static_cast<Work*>(self);
    auto* body = static_cast<Body*>(*state);
    if (!body) {
        *state = new Body;
        return MHD_YES;
    }
    if (*size > 0) {
        const bool fits = body->text.size() + *size <= most_line_bytes;
        body->too_long = body->too_long || !fits;
        if (fits) body->text.append(bytes, *size);
        *size = 0;
        return MHD_YES;
    }
    if (const char* why = work.objection(connection, url))
        return refuse(connection, MHD_HTTP_FORBIDDEN, ErrorCode::forbidden, why);
    const std::string_view verb = method;
    if (verb == MHD_HTTP_METHOD_GET) return work.get(connection, url);
    if (verb == MHD_HTTP_METHOD_POST && std::string_view(url) == "/command")
        return work.post(connection, *body);
    return refuse(connection, MHD_HTTP_METHOD_NOT_ALLOWED, ErrorCode::bad_request,
                  "here is nothing of that kind");
}

bool WebPage::Work::is_own_host(std::string_view host) const {
    const std::string port = ':' + std::to_string(settings_.port);
    for (const char* name : {"127.0.0.1", "localhost", "[::1]"})
        if (host == name + port) return true;
    return false;
}

const char* WebPage::Work::objection(MHD_Connection* connection, std::string_view url) const {
    const std::string_view host = header(connection, MHD_HTTP_HEADER_HOST);
    if (!is_own_host(host)) return "this page is only for its own machine, under its own address";
    const std::string_view origin = header(connection, MHD_HTTP_HEADER_ORIGIN);
    if (!origin.empty() && origin != "http://" + std::string(host))
        return "another site's page asks";
    const std::string_view site = header(connection, "Sec-Fetch-Site");
    // A link to the page may be anywhere.
    const bool from_here = site.empty() || site == "same-origin" || site == "none" || url == "/";
    return from_here ? nullptr : "another site's page asks";
}

MHD_Result WebPage::Work::get(MHD_Connection* connection, std::string_view url) {
    if (url == "/") return send_page(connection);
    if (url == "/status") return send_status(connection);
    if (url == "/print.lyr") return send_print(connection);
    return refuse(connection, MHD_HTTP_NOT_FOUND, ErrorCode::bad_request, "here is no such thing");
}

MHD_Result WebPage::Work::post(MHD_Connection* connection, const Body& body) {
    constexpr std::string_view scheme = "Bearer ";
    const std::string_view given = header(connection, MHD_HTTP_HEADER_AUTHORIZATION);
    const bool has_token =
        given.starts_with(scheme) && is_token(given.substr(scheme.size()), settings_.token);
    if (!has_token)
        return refuse(connection, MHD_HTTP_FORBIDDEN, ErrorCode::forbidden,
                      "the token is missing or wrong; lyrctl web tells it when it starts");
    if (body.too_long)
        return refuse(connection, MHD_HTTP_CONTENT_TOO_LARGE, ErrorCode::line_too_long,
                      "the command is too long");
    return send_json(connection, MHD_HTTP_OK, relay_.answer(body.text));
}

MHD_Result WebPage::Work::send_page(MHD_Connection* connection) const {
    if (!takes_gzip(header(connection, MHD_HTTP_HEADER_ACCEPT_ENCODING)))
        return refuse(connection, MHD_HTTP_NOT_ACCEPTABLE, ErrorCode::bad_request,
                      "the page comes packed: send Accept-Encoding: gzip (curl --compressed)");
    Response response = response_of(page_bytes());
    if (response) MHD_add_response_header(response.get(), MHD_HTTP_HEADER_CONTENT_ENCODING, "gzip");
    return send(connection, MHD_HTTP_OK, std::move(response), "text/html; charset=utf-8");
}

// "?since=N": the temperatures from sample N on.
MHD_Result WebPage::Work::send_status(MHD_Connection* connection) const {
    const char* text = MHD_lookup_connection_value(connection, MHD_GET_ARGUMENT_KIND, "since");
    const std::string_view since = text ? text : "";
    std::uint64_t number = 0;
    (void)std::from_chars(since.data(), since.data() + since.size(), number);
    return send_json(connection, MHD_HTTP_OK,
                     "{\"print\":" + std::to_string(relay_.print()) +
                         ",\"connected\":" + (relay_.is_connected() ? "true" : "false") +
                         ",\"status\":" + (relay_.told() ? relay_.told()->json : "null") +
                         ",\"history\":" + relay_.history().since(number) + '}');
}

MHD_Result WebPage::Work::send_print(MHD_Connection* connection) const {
    const int file = ::open(relay_.file().c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    struct stat found {};
    // Nothing else is handed out, whatever a socket's server says it prints.
    std::array<char, print_magic.size()> magic{};
    const bool is_print =
        file >= 0 && ::fstat(file, &found) == 0 && S_ISREG(found.st_mode) &&
        ::pread(file, magic.data(), magic.size(), 0) == static_cast<ssize_t>(magic.size()) &&
        std::string_view(magic.data(), magic.size()) == print_magic;
    if (!is_print) {
        if (file >= 0) ::close(file);
        return refuse(connection, MHD_HTTP_NOT_FOUND, ErrorCode::bad_request,
                      "the print cannot be read");
    }
    Response response(
        MHD_create_response_from_fd64(static_cast<std::uint64_t>(found.st_size), file));
    if (!response) ::close(file);
    return send(connection, MHD_HTTP_OK, std::move(response), "application/octet-stream");
}

WebPage::WebPage(std::unique_ptr<Work> work) : work_(std::move(work)) {}
WebPage::WebPage(WebPage&& other) noexcept = default;
WebPage::~WebPage() = default;

Result<WebPage> WebPage::open(WebSettings settings, Relay& relay) {
    auto work = std::make_unique<Work>(std::move(settings), relay);
    if (Status opened = work->open(); !opened) return opened.error();
    return WebPage(std::move(work));
}

void WebPage::serve(std::chrono::milliseconds longest_wait) {
    work_->serve(longest_wait);
}

std::string WebPage::address() const {
    return work_->address();
}

}  // namespace lyr::control
