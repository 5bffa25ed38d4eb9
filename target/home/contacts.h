// Endstops and probe as inputs, and watching them while something moves.
//
// Contract
//  1. Contacts are numbered as in config (x, y, z, probe); a printer's file may lack any of them.
//  2. After begin(), the first of the watched contacts that closes and settles adds a request to stop; triggers() has it
//     with the time of its first touch, and the others that have closed by the time they are asked for. One that is
//     closed when begin() is called closes then: nothing is driven on into it.
//  3. What fails in the inputs adds a request to stop, and status() is why.

#pragma once

#include <array>
#include <bitset>
#include <optional>
#include <vector>

#include "target/config/printer.h"
#include "target/gpio/debounce.h"
#include "target/run/executor.h"

namespace lyr::home {

using Contacts = std::bitset<config::contact_count>;

// In the order of the contacts; empty: the printer has none.
std::vector<gpio::InputRequest> contact_requests(const config::Printer& printer);
Contacts contacts_of(const config::Printer& printer);

class ContactWatch {
public:
    // `inputs` has the lines of contact_requests().
    ContactWatch(gpio::InputLines& inputs, const config::Printer& printer);

    // Which are touched now.
    Result<Contacts> touched();
    // Forgets what was, and watches.
    Status begin(Contacts watched, run::StopRequests& stop, std::int64_t now_ns);
    // Edges up to now.
    void poll(std::int64_t now_ns);
    // None of those watched has had an edge lately, that may settle yet.
    bool is_quiet(std::int64_t now_ns) const;

    using Times = std::array<std::optional<std::int64_t>, config::contact_count>;
    const Times& triggers() const { return triggers_; }
    const Status& status() const { return status_; }
    std::int64_t settle_ns() const { return settle_ns_; }
    gpio::InputLines& inputs() { return inputs_; }

private:
    Status collect(bool keep);

    gpio::InputLines& inputs_;
    std::int64_t settle_ns_;
    std::vector<std::size_t> contact_of_;  // by line
    std::vector<gpio::Debounce> lines_;
    Contacts watched_;
    Times triggers_{};
    run::StopRequests* stop_ = nullptr;
    Status status_ = Done{};
};

}  // namespace lyr::home
