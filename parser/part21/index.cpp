// Sections of the exchange structure, and what real files do to them.

#include "parser/part21/index.h"

#include <algorithm>

#include "parser/part21/number.h"
#include "parser/part21/scan.h"

namespace lyr::part21 {
namespace {

constexpr std::string_view start_word = "ISO-10303-21";
constexpr std::string_view end_word = "END-ISO-10303-21";
constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
constexpr const char* what_is_expected = "expected a STEP file, which starts with ISO-10303-21;";

bool is_section_start(std::string_view word) {
    constexpr std::string_view names[] = {"HEADER", "DATA", "ANCHOR", "REFERENCE", "SIGNATURE"};
    return std::any_of(std::begin(names), std::end(names),
                       [&](std::string_view name) { return equals_upper(word, name); });
}

}  // namespace

Status index_text(Table& table) {
    Indexer indexer(table);
    if (!indexer.run()) return indexer.error();
    return Done{};
}

Indexer::Indexer(Table& table) : table_(table), p_(table.begin()), end_(table.end()) {
    // Instances are 60 to 80 bytes long on average; what is reserved in vain is never touched.
    const std::size_t guess = table.source.text().size() / 48 + 16;
    table.ids.reserve(guess);
    table.places.reserve(guess);
    table.first_record.reserve(guess);
    table.record_keywords.reserve(guess);
    table.record_places.reserve(guess);
}

bool Indexer::run() {
    if (!start() || !sections()) return false;
    std::sort(table_.externals.begin(), table_.externals.end(),
              [](const auto& a, const auto& b) { return a.id < b.id; });
    return build_lookup();
}

bool Indexer::start() {
    const std::string_view text = table_.source.text();
    if (text.starts_with(byte_order_mark)) p_ += byte_order_mark.size();
    blank();
    if (equals_upper(word(), start_word)) {
        p_ += start_word.size();
        return take(';', "after ISO-10303-21");
    }
    if (equals_upper(word(), "HEADER")) {
        warn(p_, "ISO-10303-21; is missing before HEADER;");
        return true;
    }
    if (at_comment()) return fail(p_, "the comment that starts here is never closed");
    if (!word().empty() && p_ + word().size() == end_ &&
        equals_upper(word(), start_word.substr(0, word().size()))) {
        return fail(end_, "the file ends inside ISO-10303-21; is it cut off?");
    }
    return fail(p_, "this is " + look_alike(text) + "; " + what_is_expected);
}

bool Indexer::sections() {
    while (true) {
        blank();
        const std::string_view name = word();
        if (p_ == end_) return finish(false);
        if (equals_upper(name, end_word)) {
            p_ += name.size();
            return finish(true);
        }
        if (!is_section_start(name)) {
            // A file that was cut within its last line has lost nothing.
            const bool cut = !name.empty() && p_ + name.size() == end_ && has_data_ &&
                             equals_upper(name, end_word.substr(0, name.size()));
            return cut ? finish(false) : expected("a section (DATA;) or END-ISO-10303-21;");
        }
        p_ += name.size();
        if (!section(name)) return false;
    }
}

bool Indexer::section(std::string_view name) {
    if (equals_upper(name, "HEADER")) return header_section();
    if (equals_upper(name, "DATA")) return data_section();
    if (equals_upper(name, "SIGNATURE")) return signature_section();
    return skipped_section(equals_upper(name, "REFERENCE"));
}

bool Indexer::header_section() {
    if (!take(';', "after HEADER")) return false;
    has_header_ = true;
    while (true) {
        blank();
        const std::string_view name = word();
        if (equals_upper(name, "DATA")) {
            warn(p_, "ENDSEC; is missing before DATA;");
            break;
        }
        if (equals_upper(name, "ENDSEC")) {
            p_ += name.size();
            blank();
            if (p_ == end_) return fail(p_, "the file ends after its header; is it cut off?");
            if (!take(';', "after ENDSEC")) return false;
            break;
        }
        if (p_ == end_) return fail(p_, "the file ends inside its header; is it cut off?");
        if (!header_entry() && !recover_in_header()) return false;
    }
    if (table_.ids.empty() && !has_data_) decode_header(table_, table_.record_places.size());
    return check_schema();
}

bool Indexer::header_entry() {
    const std::size_t records = table_.record_places.size();
    if (!record() || !take(';', "after a header entry")) {
        table_.record_places.resize(records);
        table_.record_keywords.resize(records);
        return false;
    }
    if (!table_.ids.empty()) {  // a second header; records of the first one only are kept
        table_.record_places.resize(records);
        table_.record_keywords.resize(records);
    }
    return true;
}

// Goes on behind the first ";" that is followed by another entry or the end of the section. A
// string or comment that is not closed cannot be passed: the whole file may be inside it.
bool Indexer::recover_in_header() {
    constexpr int most = 100;  // a header of which so much cannot be read is none
    if (p_ == end_ || at('\'') || at_comment() || passed_over_++ == most) return false;
    const Diagnostic reason = *error_;
    const auto skip_space = [this](const char* p) {
        while (p < end_ && is_blank(*p)) ++p;
        return p;
    };
    for (const char* p = p_; p < end_; ++p) {
        p = std::find(p, end_, ';');
        if (p == end_) return false;
        const char* next = skip_space(p + 1);
        const char* after = skip_word(next, end_);
        const bool section_end =
            equals_upper({next, static_cast<std::size_t>(after - next)}, "ENDSEC");
        const char* bracket = skip_space(after);
        if (!section_end && (after == next || bracket == end_ || *bracket != '(')) continue;
        error_.reset();
        table_.warnings.push_back(reason);
        table_.warnings.back().severity = Severity::warning;
        table_.warnings.back().message = "header entry passed over: " + reason.message;
        p_ = next;
        return true;
    }
    return false;
}

bool Indexer::check_schema() {
    for (const std::string& schema : table_.header.schemas) {
        if (!equals_upper(std::string_view(schema).substr(0, 3), "IFC")) continue;
        const std::string_view name(
            schema.data(),
            static_cast<std::size_t>(skip_word(schema.data(), schema.data() + schema.size()) -
                                     schema.data()));
        fail(p_,
             "this is an IFC building model (" + std::string(name) +
                 "), which is not supported; expected a mechanical STEP file (AP203, AP214, AP242)",
             ExitStatus::unsupported);
        error_->where.line = error_->where.column = 0;
        return false;
    }
    return true;
}

bool Indexer::skipped_section(bool is_reference) {
    if (!take(';', "after the name of a section")) return false;
    while (true) {
        blank();
        const std::string_view name = word();
        if (equals_upper(name, "ENDSEC")) {
            p_ += name.size();
            return take(';', "after ENDSEC");
        }
        if (is_reference && at('#') && !reference_entry()) return false;
        if (!skip_statement()) return false;
    }
}

// Remembers #1=<file#anchor>; p_ stays in front of it for what else may be there.
bool Indexer::reference_entry() {
    const auto [after, id] = read_id(p_ + 1, end_);
    if (after == p_ + 1) return true;
    if (!id) return fail(p_, "the number of this instance name is beyond 64 bits");
    const char* equals = skip_blank(after, end_);
    const char* resource = equals < end_ ? skip_blank(equals + 1, end_) : end_;
    if (resource == end_ || *resource != '<') return true;
    const char* close = std::find(resource, end_, '>');
    if (close == end_) return true;  // skip_statement() says so
    table_.externals.push_back({*id, {resource, static_cast<std::size_t>(close + 1 - resource)}});
    return true;
}

// To behind the next ";" outside strings, comments and <resources>.
bool Indexer::skip_statement() {
    while (true) {
        blank();
        if (p_ == end_) return fail(p_, "the file ends inside a section; is it cut off?");
        const char c = *p_;
        if (c == ';') {
            ++p_;
            return true;
        }
        if (c == '\'') {
            const char* after = skip_string(p_, end_);
            if (!after) return fail(p_, "the string that starts here is not closed");
            p_ = after;
        } else if (c == '<') {
            const char* close = std::find(p_, end_, '>');
            if (close == end_) return fail(p_, "the resource that starts here is not closed by >");
            p_ = close + 1;
        } else if (at_comment()) {
            return fail(p_, "the comment that starts here is never closed");
        } else {
            ++p_;
        }
    }
}

// Base64 text, in which no string or comment can start.
bool Indexer::signature_section() {
    while (true) {
        const char* start = p_;
        p_ = std::find(p_, end_, ';');
        if (p_ == end_) return fail(p_, "the file ends inside a SIGNATURE section; is it cut off?");
        const char* last = p_;
        while (last > start && is_blank(last[-1])) --last;
        constexpr std::string_view closing = "ENDSEC";
        ++p_;
        if (last - start >= static_cast<std::ptrdiff_t>(closing.size()) &&
            equals_upper({last - closing.size(), closing.size()}, closing)) {
            return true;
        }
    }
}

bool Indexer::finish(bool ended) {
    if (!ended && !has_data_) {
        return fail(end_, "the file ends before its DATA section; is it cut off?");
    }
    blank();
    const bool closed = ended && at(';');
    if (!closed) warn(ended ? p_ : end_, "END-ISO-10303-21; is missing at the end of the file");
    if (!has_header_) warn(table_.begin(), "the file has no HEADER section");
    if (!has_data_) warn(p_, "the file has no DATA section");
    if (closed) ++p_;
    if (ended) check_rest();
    return !error_;
}

void Indexer::check_rest() {
    while (true) {
        blank();
        constexpr char dos_end_of_file = 0x1A;
        while (p_ < end_ && (*p_ == '\0' || *p_ == dos_end_of_file || is_blank(*p_))) ++p_;
        if (p_ == end_) return;
        if (!equals_upper(word(), "SIGNATURE")) break;
        p_ += word().size();
        if (!signature_section()) return;
    }
    if (equals_upper(word(), start_word)) {
        warn(p_, "a second exchange structure follows in the same file; it is not read");
    } else {
        warn(p_, "what follows END-ISO-10303-21; is not read");
    }
}

void Indexer::blank() {
    p_ = skip_blank(p_, end_);
}

bool Indexer::at_comment() const {
    return end_ - p_ >= 2 && p_[0] == '/' && p_[1] == '*';
}

std::string_view Indexer::word() const {
    const char* p = p_;
    while (p < end_ && (has_class(*p, detail::letter | detail::digit) || *p == '-')) ++p;
    return {p_, static_cast<std::size_t>(p - p_)};
}

bool Indexer::take(char c, std::string_view where) {
    blank();
    if (!at(c)) return expected(std::string("'") + c + "' " + std::string(where));
    ++p_;
    return true;
}

bool Indexer::expected(std::string_view what) {
    std::string message = "expected " + std::string(what) + ", found " + found_at(p_, end_);
    if (p_ == end_) message += "; is the file cut off?";
    return fail(p_, std::move(message));
}

bool Indexer::fail(const char* place, std::string message, ExitStatus status) {
    error_ = Diagnostic{Severity::error, status, std::move(message),
                        table_.location(table_.offset_of(place))};
    error_->where.entity = id_.value_or(0);
    return false;
}

void Indexer::warn(const char* place, std::string message) {
    table_.warnings.push_back({Severity::warning, ExitStatus::input, std::move(message),
                               table_.location(table_.offset_of(place))});
}

}  // namespace lyr::part21
