#include "target/control/web/relay.h"

#include <algorithm>
#include <vector>

#include "target/control/places.h"
#include "target/control/request.h"

namespace lyr::control {
namespace {

using Clock = std::chrono::steady_clock;

// How long until the next look for a print.
constexpr std::chrono::seconds between_prints{1};
constexpr const char* subscribe = R"({"command":"subscribe","interval_s":0.25})";

}  // namespace

void Relay::look() {
    const Clock::time_point now = Clock::now();
    if (now < connect_from_) return;
    connect_from_ = now + between_prints;
    for (const std::string& place : socket_.empty() ? sockets() : std::vector{socket_}) {
        if (silent_.contains(place)) continue;
        if (Result<Link> link = Link::reach(place)) silent_.emplace(place, std::move(*link));
    }
}

void Relay::connect() {
    look();
    for (auto at = silent_.begin(); at != silent_.end() && !link_;) {
        Link& link = at->second;
        const Result<bool> greeted = link.take_greeting({});
        if (greeted && !*greeted) {
            ++at;
            continue;
        }
        if (greeted && link.send(subscribe)) link_.emplace(std::move(link));
        at = silent_.erase(at);
    }
    if (!link_) return;
    silent_.clear();
    file_ = link_->greeting().file;
    ++print_;
    told_.reset();
    history_ = History();
}

void Relay::take(const Answer& answer) {
    const auto* told = std::get_if<Told>(&answer);
    if (!told) return;
    told_ = *told;
    history_.take(told->status);
}

void Relay::serve() {
    if (!link_) connect();
    while (link_) {
        const Result<std::optional<Answer>> answer = link_->next_within({});
        if (!answer) {
            link_.reset();
        } else if (*answer) {
            take(**answer);
        } else {
            return;
        }
    }
}

std::string Relay::answer(std::string_view request) {
    const auto gone = [] {
        return refusal_line({"null", ErrorCode::wrong_state, "no printer is at work"});
    };
    std::string line(request);
    std::ranges::replace_if(
        line, [](char c) { return c == '\n' || c == '\r'; }, ' ');
    // Answers to what was sent before, the subscription, come first.
    serve();
    if (!link_ || !link_->send(line)) return gone();
    for (;;) {
        const Result<Answer> answer = link_->next();
        if (!answer) {
            link_.reset();
            return gone();
        }
        take(*answer);
        const auto* told = std::get_if<Told>(&*answer);
        if (!told || !told->is_event) return link_->line();
    }
}

}  // namespace lyr::control
