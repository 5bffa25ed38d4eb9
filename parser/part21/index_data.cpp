// The DATA section: the inner loop of indexing.

#include <algorithm>

#include "parser/part21/index.h"
#include "parser/part21/number.h"
#include "parser/part21/scan.h"

namespace lyr::part21 {

bool Indexer::data_section() {
    blank();
    if (at('(') && !skip_list(0)) return false;  // edition 2: a name and the schemas
    if (!take(';', "after DATA")) return false;
    has_data_ = true;
    while (true) {
        blank();
        if (at('#')) {
            if (!instance()) return false;
            continue;
        }
        const std::string_view name = word();
        if (equals_upper(name, "ENDSCOPE")) {
            p_ += name.size();
            if (!close_scope()) return false;
        } else if (equals_upper(name, "ENDSEC") && scopes_.empty()) {
            p_ += name.size();
            return take(';', "after ENDSEC");
        } else if (p_ == end_) {
            return fail(p_, "the file ends inside its DATA section, before ENDSEC; is it cut off?");
        } else {
            return expected(scopes_.empty() ? "an instance (#1=...) or ENDSEC;"
                                            : "an instance (#1=...) or ENDSCOPE");
        }
    }
}

bool Indexer::instance() {
    const char* place = p_;
    const auto [after, id] = read_id(p_ + 1, end_);
    p_ = after;
    if (after == place + 1) return expected("a number after #");
    if (!id) return fail(place, "the number of this instance name is beyond 64 bits");
    id_ = *id;
    if (!take('=', "after the name of an instance")) return false;
    blank();
    if (!at('&')) return body(*id, place);
    ++p_;
    blank();
    if (!equals_upper(word(), "SCOPE")) return expected("SCOPE after &");
    p_ += word().size();
    if (scopes_.size() >= static_cast<std::size_t>(max_depth)) {
        return fail(place, "scopes are nested deeper than " + std::to_string(max_depth));
    }
    scopes_.push_back({*id, place});
    id_.reset();
    return true;
}

// ENDSCOPE, the names that it exports, and the record of the instance that opened it.
bool Indexer::close_scope() {
    if (scopes_.empty()) return fail(p_, "ENDSCOPE without &SCOPE before it");
    const Scope scope = scopes_.back();
    scopes_.pop_back();
    id_ = scope.id;
    blank();
    if (at('/')) {
        const char* close = std::find(p_ + 1, end_, '/');
        if (close == end_) return expected("a list of instance names between / and /");
        p_ = close + 1;
    }
    return body(scope.id, scope.place);
}

bool Indexer::body(std::uint64_t id, const char* place) {
    constexpr std::size_t most = InstanceIndex::none_value - 1;
    if (table_.record_places.size() >= most) {
        return fail(place, "the file has more than 4294967294 instances");
    }
    const auto first = static_cast<std::uint32_t>(table_.record_places.size());
    blank();
    if (!(at('(') ? complex_body() : record()) || !take(';', "at the end of an instance"))
        return false;
    table_.ids.push_back(id);
    table_.places.push_back(table_.offset_of(place));
    table_.first_record.push_back(first);
    id_.reset();
    return true;
}

bool Indexer::complex_body() {
    ++p_;
    do {
        blank();
        if (!record()) return false;
        blank();
    } while (!at(')'));
    ++p_;
    return true;
}

bool Indexer::record() {
    const char* after = skip_keyword(p_, end_);
    if (after == p_) return expected("a keyword");
    const std::string_view keyword(p_, static_cast<std::size_t>(after - p_));
    p_ = skip_blank(after, end_);
    if (!at('(')) return expected("'(' after " + upper(keyword));
    table_.record_keywords.push_back(table_.keywords.intern(keyword));
    table_.record_places.push_back(table_.offset_of(p_));
    return skip_list(0);
}

// From an opening bracket to behind its closing one.
bool Indexer::skip_list(int depth) {
    const char* open = p_;
    while (true) {
        const char* p = p_;
        while (p < end_ && !has_class(*p, detail::in_record)) ++p;
        p_ = p;
        if (p_ == end_) {
            return fail(
                open, "the file ends before the bracket that opens here is closed; is it cut off?");
        }
        switch (*p_) {
            case '(':
                if (++depth > max_depth) {
                    return fail(p_, "lists are nested deeper than " + std::to_string(max_depth));
                }
                ++p_;
                break;
            case ')':
                ++p_;
                if (--depth == 0) return true;
                break;
            case '\'':
                if (!string_in_list()) return false;
                break;
            case '/': {
                const char* after = skip_blank(p_, end_);
                if (after == p_) return expected("',' or ')'");
                p_ = after;
                break;
            }
            default:
                return expected("',' or ')'");  // ";" or "=": this record was not closed
        }
    }
}

bool Indexer::string_in_list() {
    const char* open = p_;
    const char* after = skip_string(open, end_);
    if (!after) return fail(open, "the string that starts here is not closed");
    p_ = skip_blank(after, end_);
    // At the end of the text and at an open comment, the list has the better message.
    if (p_ == end_ || at(',') || at(')') || at('/')) return true;
    return fail(open, "after the string that starts here expected ',' or ')', found " +
                          found_at(p_, end_) + "; is a quote missing?");
}

bool Indexer::build_lookup() {
    table_.first_record.push_back(static_cast<std::uint32_t>(table_.record_places.size()));
    const auto twice = table_.lookup.build(table_.ids);
    if (!twice) return true;
    const char* earlier = table_.at(table_.places[twice->earlier.value]);
    const Location first = table_.location(table_.offset_of(earlier));
    id_ = table_.ids[twice->later.value];
    return fail(table_.at(table_.places[twice->later.value]),
                "this instance name is defined twice, first in line " + std::to_string(first.line) +
                    "; expected each #id once");
}

}  // namespace lyr::part21
