#include "target/home/contacts.h"

#include <cmath>

#include "base/constants.h"
#include "target/run/line_layout.h"

namespace lyr::home {
namespace {

const std::optional<config::Pin>& pin_of(const config::Printer& printer, std::size_t contact) {
    static const std::optional<config::Pin> none;
    if (contact < printer.endstops.size()) return printer.endstops[contact].input;
    return printer.probe ? printer.probe->input : none;
}

}  // namespace

Contacts contacts_of(const config::Printer& printer) {
    Contacts contacts;
    for (std::size_t i = 0; i < contacts.size(); ++i) contacts[i] = pin_of(printer, i).has_value();
    return contacts;
}

std::vector<gpio::InputRequest> contact_requests(const config::Printer& printer) {
    std::vector<gpio::InputRequest> requests;
    for (std::size_t i = 0; i < config::contact_count; ++i) {
        const std::optional<config::Pin>& pin = pin_of(printer, i);
        if (!pin) continue;
        const std::string purpose =
            i == config::contact_probe
                ? "probe.input"
                : "axis." + std::string(config::contact_names[i]) + ".endstop";
        requests.push_back(run::input_request(purpose, *pin));
    }
    return requests;
}

ContactWatch::ContactWatch(gpio::InputLines& inputs, const config::Printer& printer)
    : inputs_(inputs), settle_ns_(std::llround(printer.homing.settle_ms * ns_per_ms)) {
    const Contacts contacts = contacts_of(printer);
    for (std::size_t i = 0; i < contacts.size(); ++i)
        if (contacts[i]) contact_of_.push_back(i);
    lines_.reserve(contact_of_.size());
}

Result<Contacts> ContactWatch::touched() {
    const Result<gpio::LineMask> levels = inputs_.read();
    if (!levels) return levels.error();
    Contacts touched;
    for (std::size_t line = 0; line < contact_of_.size(); ++line)
        touched[contact_of_[line]] = (*levels & gpio::line_bit(line)) != 0;
    return touched;
}

Status ContactWatch::collect(bool keep) {
    for (;;) {
        std::array<gpio::InputEdge, 64> edges;
        const Result<std::size_t> count = inputs_.collect(edges);
        if (!count) return count.error();
        for (std::size_t i = 0; keep && i < *count; ++i)
            if (edges[i].line < lines_.size()) lines_[edges[i].line].edge(edges[i]);
        if (*count < edges.size()) return Done{};
    }
}

Status ContactWatch::begin(Contacts watched, run::StopRequests& stop, std::int64_t now_ns) {
    watched_ = watched;
    triggers_ = {};
    stop_ = &stop;
    if (status_ = collect(false); !status_) return status_;
    const Result<Contacts> now = touched();
    if (!now) return now.error();
    lines_.clear();
    for (std::size_t line = 0; line < contact_of_.size(); ++line) {
        const bool touches = (*now)[contact_of_[line]], counts = watched[contact_of_[line]];
        lines_.emplace_back(settle_ns_, touches && !counts);
        lines_.back().edge({now_ns, static_cast<std::uint8_t>(line), touches});
    }
    return Done{};
}

bool ContactWatch::is_quiet(std::int64_t now_ns) const {
    for (std::size_t line = 0; line < lines_.size(); ++line)
        if (watched_[contact_of_[line]] && !lines_[line].is_quiet(now_ns)) return false;
    return true;
}

void ContactWatch::poll(std::int64_t now_ns) {
    if (!status_) return;
    if (status_ = collect(true); !status_) {
        ++*stop_;
        return;
    }
    for (std::size_t line = 0; line < lines_.size(); ++line) {
        const auto edge = lines_[line].settled(now_ns);
        const std::size_t contact = contact_of_[line];
        if (!edge || !edge->active || !watched_[contact] || triggers_[contact]) continue;
        triggers_[contact] = edge->time_ns;
        if (stop_->load() == 0) ++*stop_;
    }
}

}  // namespace lyr::home
