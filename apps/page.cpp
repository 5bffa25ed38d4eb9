#include "apps/page.h"

#include "apps/files.h"
#include "apps/signal_watch.h"
#include "target/control/web/token.h"
#include "target/control/web/web_page.h"

namespace lyr::command_line {

Status serve_page(const Program& program, const PageOptions& options) {
    constexpr std::chrono::milliseconds longest_wait{250};
    const bool is_new = options.token_path.empty();
    const Result<std::string> token =
        is_new ? control::random_token() : control::token_in(options.token_path);
    if (!token) return token.error();
    control::Relay relay(options.socket);
    const SignalWatch signals(program.name);
    Result<control::WebPage> page = control::WebPage::open({options.port, *token}, relay);
    if (!page) return page.error();
    // What stands behind # stays in the browser.
    const std::string place = page->address() + (is_new ? "#token=" + *token : "");
    if (Status told = tell(place + '\n'); !told) return told;
    for (;;) page->serve(longest_wait);
}

}  // namespace lyr::command_line
