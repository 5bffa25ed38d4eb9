// The JSON is read as a stream of values, since all objects of the protocol are flat.

#include "target/control/request.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/nearest_name.h"
#include "base/text.h"
#include "target/config/heater.h"

namespace lyr::control {
namespace {

using Value = std::variant<std::monostate, bool, double, std::string>;

struct Member {
    std::string name;
    Value value;
    std::string json;  // of a whole number or a text
};

// Takes the members of one flat object; anything else ends the reading with a complaint.
class FlatObject final : public nlohmann::json_sax<nlohmann::json> {
public:
    bool start_object(std::size_t) override {
        if (begun_) return refuse("a member holds an object: all values are plain");
        return begun_ = true;
    }
    bool end_object() override { return true; }
    bool start_array(std::size_t) override {
        return refuse(begun_ ? "a member holds a list: all values are plain" : no_object);
    }
    bool end_array() override { return true; }
    bool key(std::string& name) override {
        const auto twice = std::ranges::find(members, name, &Member::name) != members.end();
        members.push_back({std::move(name), {}, {}});
        return !twice || refuse("the member " + in_quotes(members.back().name) + " stands twice");
    }
    bool null() override { return take({}, {}); }
    bool boolean(bool value) override { return take(value, {}); }
    bool number_integer(std::int64_t value) override {
        return take(static_cast<double>(value), std::to_string(value));
    }
    bool number_unsigned(std::uint64_t value) override {
        return take(static_cast<double>(value), std::to_string(value));
    }
    bool number_float(double value, const std::string&) override { return take(value, {}); }
    bool string(std::string& value) override { return take(value, in_json(value)); }
    bool binary(nlohmann::json::binary_t&) override { return false; }
    bool parse_error(std::size_t position, const std::string&,
                     const nlohmann::json::exception&) override {
        code = ErrorCode::bad_json;
        complaint = "the line is no JSON; byte " + std::to_string(position) + " is wrong";
        return false;
    }

    std::vector<Member> members;
    ErrorCode code = ErrorCode::bad_request;
    std::string complaint;

private:
    static constexpr const char* no_object = "the line is no JSON object";

    bool refuse(std::string why) {
        complaint = std::move(why);
        return false;
    }
    bool take(Value value, std::string json) {
        if (!begun_) return refuse(no_object);
        members.back().value = std::move(value);
        members.back().json = std::move(json);
        return true;
    }

    bool begun_ = false;
};

// What is left of a request while its members are taken out.
class Members {
public:
    explicit Members(std::vector<Member> members) : members_(std::move(members)) {}

    std::optional<Member> take(std::string_view name) {
        const auto found = std::ranges::find(members_, name, &Member::name);
        if (found == members_.end()) return std::nullopt;
        Member member = std::move(*found);
        members_.erase(found);
        return member;
    }
    const std::vector<Member>& rest() const { return members_; }

private:
    std::vector<Member> members_;
};

using Wish = std::variant<GetStatus, Subscribe, Commands>;
struct Complaint {
    ErrorCode code;
    std::string message;
};
using Wished = std::variant<Wish, Complaint>;

struct Quantity {
    const char* member;
    double low, high;
    run::Command (*make)(double);
};

template <std::size_t Heater>
run::Command target(double target_c) {
    return run::SetTemperature{Heater, target_c};
}

constexpr std::array<Quantity, 5> quantities{{
    {"tool_c", 0, highest_target_c, target<config::heater_tool>},
    {"bed_c", 0, highest_target_c, target<config::heater_bed>},
    {"chamber_c", 0, highest_target_c, target<config::heater_chamber>},
    {"fan", 0, 1, [](double duty) -> run::Command { return run::SetFan{duty}; }},
    {"speed", run::least_speed_factor, run::most_speed_factor,
     [](double factor) -> run::Command { return run::SetSpeedFactor{factor}; }},
}};

std::optional<double> number_in(const Member& member, double low, double high) {
    const double* value = std::get_if<double>(&member.value);
    if (!value || !(*value >= low && *value <= high)) return std::nullopt;
    return *value;
}

Complaint out_of_range(const char* member, double low, double high) {
    return {ErrorCode::bad_value, std::string(member) + " must be a number from " + shortest(low) +
                                      " to " + shortest(high)};
}

Wished read_set(Members& members) {
    Commands commands;
    for (const Quantity& quantity : quantities) {
        const std::optional<Member> member = members.take(quantity.member);
        if (!member) continue;
        const std::optional<double> value = number_in(*member, quantity.low, quantity.high);
        if (!value) return out_of_range(quantity.member, quantity.low, quantity.high);
        commands.push_back(quantity.make(*value));
    }
    if (commands.empty() && members.rest().empty())
        return Complaint{ErrorCode::bad_request,
                         "set needs one of tool_c, bed_c, chamber_c, fan and speed"};
    return commands;
}

Wished read_subscribe(Members& members) {
    constexpr const char* name = "interval_s";
    const std::optional<Member> member = members.take(name);
    if (!member) return Complaint{ErrorCode::bad_request, "subscribe needs interval_s"};
    if (number_in(*member, 0, 0)) return Subscribe{0};
    const auto interval_s = number_in(*member, shortest_interval_s, longest_interval_s);
    if (interval_s) return Subscribe{*interval_s};
    Complaint complaint = out_of_range(name, shortest_interval_s, longest_interval_s);
    complaint.message += ", or 0 for no more";
    return complaint;
}

template <class Command>
Wished plain(Members&) {
    return Commands{Command{}};
}

struct Known {
    const char* name;
    Wished (*read)(Members&);
};

constexpr std::array<Known, 8> known{{
    {"status", [](Members&) -> Wished { return GetStatus{}; }},
    {"subscribe", read_subscribe},
    {"pause", plain<run::Pause>},
    {"resume", plain<run::Resume>},
    {"cancel", plain<run::Cancel>},
    {"stop", plain<run::EmergencyStop>},
    {"set", read_set},
    {"change_filament", plain<run::ChangeFilament>},
}};

Complaint unknown(const std::string& command) {
    std::vector<std::string> names;
    for (const Known& each : known) names.emplace_back(each.name);
    const std::string nearest = nearest_name(command, names);
    return {ErrorCode::unknown_command,
            "unknown command " + in_quotes(command) +
                (nearest.empty() ? "" : "; did you mean " + nearest + "?")};
}

Wished read_wish(Members& members) {
    const std::optional<Member> command = members.take("command");
    const auto* name = command ? std::get_if<std::string>(&command->value) : nullptr;
    if (!name)
        return Complaint{ErrorCode::bad_request, "the member command is missing, or no text"};
    const auto found = std::ranges::find(known, *name, &Known::name);
    if (found == known.end()) return unknown(*name);
    Wished wished = found->read(members);
    if (std::holds_alternative<Complaint>(wished) || members.rest().empty()) return wished;
    return Complaint{ErrorCode::bad_request,
                     *name + " has no member " + in_quotes(members.rest().front().name)};
}

// As JSON; none: it cannot be one.
std::optional<std::string> id_of(Members& members) {
    const std::optional<Member> id = members.take("id");
    if (!id || std::holds_alternative<std::monostate>(id->value)) return "null";
    if (id->json.empty() || id->json.size() > longest_id_bytes) return std::nullopt;
    return id->json;
}

}  // namespace

std::string_view name_of(ErrorCode code) {
    constexpr std::array<std::string_view, 10> names{
        "bad_json",         "bad_request", "unknown_command", "bad_value", "line_too_long",
        "too_many_clients", "wrong_state", "no_such_heater",  "busy",      "forbidden"};
    return names[static_cast<std::size_t>(code)];
}

std::variant<Request, Refusal> read_request(std::string_view line) {
    FlatObject object;
    const bool read = nlohmann::json::sax_parse(line, &object);
    Members members(std::move(object.members));
    const std::optional<std::string> id = id_of(members);
    if (!read) return Refusal{id.value_or("null"), object.code, object.complaint};
    if (!id)
        return Refusal{"null", ErrorCode::bad_value,
                       "id must be a whole number, or a text of up to " +
                           std::to_string(longest_id_bytes - 2) + " bytes"};
    Wished wished = read_wish(members);
    if (auto* complaint = std::get_if<Complaint>(&wished))
        return Refusal{*id, complaint->code, std::move(complaint->message)};
    return Request{*id, std::get<Wish>(std::move(wished))};
}

std::string done_line(const std::string& id) {
    return "{\"id\":" + id + ",\"ok\":true}";
}

std::string refusal_line(const Refusal& refusal) {
    return "{\"id\":" + refusal.id + ",\"ok\":false,\"error\":{\"code\":\"" +
           std::string(name_of(refusal.code)) + "\",\"message\":" + in_json(refusal.message) + "}}";
}

}  // namespace lyr::control
