// Files are applied from the innermost that is inherited outwards, then settings; then what follows from other keys.

#include "profile/resolve.h"

#include <algorithm>
#include <optional>

#include "base/nearest_name.h"
#include "base/text.h"
#include "profile/checks.h"
#include "profile/keys.h"
#include "profile/sources.h"
#include "profile/statements.h"

namespace lyr::profile {
namespace {

constexpr std::string_view inherits = "inherits";

Diagnostic input_error(const std::string& message, const Source& source,
                       const Statement& statement) {
    return {Severity::error,
            ExitStatus::input,
            message,
            {.file = source.shown, .line = statement.line, .column = statement.column}};
}

Diagnostic usage_error(const std::string& message) {
    return {Severity::error, ExitStatus::usage, message, {}};
}

bool is_section(const std::string& path) {
    return std::any_of(keys().begin(), keys().end(),
                       [&](const Key& key) { return key.path.starts_with(path + '.'); });
}

// Keys whose last part is the whole of a name: what somebody means who leaves the section out.
std::vector<std::string> keys_named(const std::string& name) {
    std::vector<std::string> paths;
    for (const Key& key : keys())
        if (key.path.ends_with('.' + name)) paths.push_back(key.path);
    return paths;
}

std::string unknown_key(const std::string& path) {
    if (is_section(path)) return '`' + path + "` is a section; its keys stand below [" + path + ']';
    std::vector<std::string> known;
    for (const Key& key : keys()) known.push_back(key.path);
    std::vector<std::string> meant = keys_named(path);
    if (meant.empty()) {
        if (std::string nearest = nearest_name(path, known); !nearest.empty())
            meant.push_back(std::move(nearest));
    }
    std::string message = "unknown key `" + escaped(path) + '`';
    if (meant.empty()) return message + "; --print-config lists the keys";
    for (const std::string& key : meant)
        message += (&key == &meant[0] ? "; did you mean `" : " or `") + key + '`';
    return message + '?';
}

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = std::min(text.find_first_not_of(' '), text.size());
    return text.substr(begin, text.find_last_not_of(' ') + 1 - begin);
}

class Resolver {
public:
    Resolver() { resolved_.origins.resize(keys().size()); }

    Status file(const Source& source);
    Status setting(const Setting& setting);
    void derive();
    Resolved& resolved() { return resolved_; }

private:
    // Stores the value, or says what is wrong, with the key's name.
    Complaint apply(const std::string& path, const Given& value, const Origin& origin);
    Status base(const Source& source, const Statement& statement);

    Resolved resolved_;
    std::vector<const Source*> open_;  // from the first to the one that is read
};

Complaint Resolver::apply(const std::string& path, const Given& value, const Origin& origin) {
    const auto key = std::find_if(keys().begin(), keys().end(),
                                  [&](const Key& candidate) { return candidate.path == path; });
    if (key == keys().end()) return unknown_key(path);
    if (const Complaint complaint = key->store(value, resolved_.profile))
        return path + ": " + *complaint;
    resolved_.origins[static_cast<std::size_t>(key - keys().begin())] = origin;
    return std::nullopt;
}

Status Resolver::base(const Source& source, const Statement& statement) {
    const auto* scalar = std::get_if<Scalar>(&statement.value);
    const auto name = scalar ? text_in(*scalar) : std::nullopt;
    if (!name) {
        return input_error(
            "inherits: expected the name of a profile, found " + found(statement.value), source,
            statement);
    }
    auto inherited = find_source(*name, source);
    if (!inherited) {
        std::string message = "inherits " + in_quotes(*name) + ": " + inherited.error().message;
        return input_error(message, source, statement);
    }
    std::string way;
    for (const Source* open : open_) {
        if (open->identity == inherited->identity || !way.empty()) way += open->shown + " -> ";
    }
    if (way.empty()) return file(*inherited);
    return input_error("inherits itself: " + way + inherited->shown, source, statement);
}

Status Resolver::file(const Source& source) {
    const auto statements = statements_of(source.text, source.shown);
    if (!statements) return statements.error();
    if (!source.built_in) resolved_.files.push_back(source.path);
    open_.push_back(&source);
    for (const Statement& statement : *statements) {
        if (statement.path != inherits) continue;
        if (Status inherited = base(source, statement); !inherited) return inherited;
    }
    for (const Statement& statement : *statements) {
        if (statement.path == inherits) continue;
        if (statement.empty_section && is_section(statement.path)) continue;
        const Origin origin{source.built_in ? Origin::Kind::built_in : Origin::Kind::file,
                            source.shown, statement.line};
        if (const Complaint complaint = apply(statement.path, statement.value, origin))
            return input_error(*complaint, source, statement);
    }
    open_.pop_back();
    return Done{};
}

Status Resolver::setting(const Setting& setting) {
    const Origin origin{Origin::Kind::option, setting.option, 0};
    const Complaint complaint = apply(setting.key, Scalar(Bare{setting.value}), origin);
    if (complaint) return usage_error(setting.option + ": " + *complaint);
    return Done{};
}

void Resolver::derive() {
    for (std::size_t i = 0; i < keys().size(); ++i) {
        const auto& derived = keys()[i].derived;
        if (derived && resolved_.origins[i].kind == Origin::Kind::unsaid)
            derived->set(resolved_.profile);
    }
}

// Which of a shorthand and --set was meant nobody can tell.
Status check_options(const std::vector<Setting>& settings) {
    for (const Setting& a : settings)
        for (const Setting& b : settings)
            if (a.key == b.key && a.option != b.option)
                return usage_error(a.key + " is given by " + a.option + " and by " + b.option +
                                   "; leave one out");
    return Done{};
}

}  // namespace

std::optional<Setting> parse_setting(std::string_view text, const std::string& option) {
    const std::size_t equals = text.find('=');
    const std::string key(trimmed(text.substr(0, equals)));
    if (equals == std::string_view::npos || key.empty()) return std::nullopt;
    return Setting{key, std::string(trimmed(text.substr(equals + 1))), option};
}

Result<Resolved> resolve(const Request& request) {
    Resolver resolver;
    if (!request.profile.empty()) {
        const auto source = find_source(request.profile);
        if (!source) return source.error();
        if (Status read = resolver.file(*source); !read) return read.error();
        resolver.resolved().name = source->name;
    }
    if (Status options = check_options(request.settings); !options) return options.error();
    for (const Setting& setting : request.settings)
        if (Status stored = resolver.setting(setting); !stored) return stored.error();
    resolver.derive();
    if (Status checked = check(resolver.resolved()); !checked) return checked.error();
    return std::move(resolver.resolved());
}

}  // namespace lyr::profile
