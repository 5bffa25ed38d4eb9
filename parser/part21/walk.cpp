// A small state machine with a stack of brackets instead of recursion; see walk.h.

#include "parser/part21/walk.h"

#include <array>

#include "parser/part21/number.h"
#include "parser/part21/part21.h"
#include "parser/part21/scan.h"

namespace lyr::part21 {
namespace {

// Behind a value that is neither list nor typed, or nullptr where none stands.
const char* skip_scalar(const char* p, const char* end) {
    switch (*p) {
        case '$':
        case '*':
            return p + 1;
        case '\'':
            return skip_string(p, end);
        case '#':
        case '@': {
            const char* after = skip_word(p + 1, end);
            const bool is_number = after > p + 1 && is_digit(p[1]);
            return after == p + 1 || (is_number && skip_digits(p + 1, end) != after) ? nullptr
                                                                                     : after;
        }
        case '"': {
            const char* after = p + 1;
            while (after < end && has_class(*after, detail::hex)) ++after;
            const bool closed = after < end && *after == '"' && after > p + 1;
            return closed && p[1] >= '0' && p[1] <= '3' ? after + 1 : nullptr;
        }
        case '.':
            if (end - p >= 2 && is_letter(p[1])) {
                const char* after = skip_word(p + 1, end);
                return after < end && *after == '.' ? after + 1 : nullptr;
            }
            break;
        default:
            break;
    }
    return skip_number(p, end).after;
}

class RecordWalk {
public:
    RecordWalk(const char* open, const char* end, std::span<std::uint32_t> places)
        : open_(open), p_(open + 1), end_(end), places_(places) {}

    RecordCheck run() {
        while (depth_ > 0 && !check_.fault) {
            p_ = skip_blank(p_, end_);
            if (p_ == end_) {
                fault("')'");
            } else if (before_value_) {
                value();
            } else {
                separator();
            }
        }
        return std::move(check_);
    }

private:
    enum class Bracket : std::uint8_t { list, typed };

    void value() {
        if (*p_ == ')' && is_empty_ && innermost() == Bracket::list) return close();
        if (depth_ == 1) note_argument();
        if (*p_ == '(') return open(Bracket::list);
        const char* keyword_end = skip_keyword(p_, end_);
        if (keyword_end != p_) {
            p_ = skip_blank(keyword_end, end_);
            return p_ < end_ && *p_ == '(' ? open(Bracket::typed) : fault("'(' after a keyword");
        }
        const char* after = skip_scalar(p_, end_);
        if (!after) return fault("a value");
        p_ = after;
        before_value_ = false;
    }

    void separator() {
        if (*p_ == ')') return close();
        if (innermost() == Bracket::typed) return fault("')' after the one value of a type");
        if (*p_ != ',') return fault("',' or ')'");
        ++p_;
        before_value_ = true;
        is_empty_ = false;
    }

    void open(Bracket bracket) {
        if (depth_ > max_depth) return fault("no deeper nesting");
        brackets_[static_cast<std::size_t>(depth_++)] = bracket;
        ++p_;
        before_value_ = true;
        is_empty_ = true;
    }

    void close() {
        if (--depth_ == 0) check_.closing = p_;
        ++p_;
        before_value_ = false;
    }

    void note_argument() {
        if (check_.count < places_.size()) {
            const std::ptrdiff_t place = p_ - open_;
            if (place > UINT32_MAX) return fault("a record of less than 4 GiB");
            places_[check_.count] = static_cast<std::uint32_t>(place);
        }
        ++check_.count;
    }

    Bracket innermost() const { return brackets_[static_cast<std::size_t>(depth_ - 1)]; }

    void fault(const char* expected) {
        check_.fault = p_;
        check_.expected = expected;
    }

    const char* open_;
    const char* p_;
    const char* end_;
    std::span<std::uint32_t> places_;
    std::array<Bracket, max_depth + 1> brackets_{};
    int depth_ = 1;
    bool before_value_ = true;
    bool is_empty_ = true;  // nothing yet behind the innermost bracket
    RecordCheck check_;
};

const char* skip_brackets(const char* p, const char* end) {
    int depth = 0;
    while (true) {
        while (!has_class(*p, detail::in_record)) ++p;
        switch (*p) {
            case '\'':
                p = skip_string(p, end);
                break;
            case '/':
                p = skip_blank(p, end);
                break;
            case '(':
                ++depth;
                ++p;
                break;
            default:
                ++p;
                if (--depth == 0) return p;
        }
    }
}

}  // namespace

RecordCheck check_record(const char* open, const char* end, std::span<std::uint32_t> places) {
    return RecordWalk(open, end, places).run();
}

Kind kind_at(const char* p, const char* end) {
    switch (*p) {
        case '$':
            return Kind::unset;
        case '*':
            return Kind::derived;
        case '(':
            return Kind::list;
        case '\'':
            return Kind::string;
        case '"':
            return Kind::binary;
        case '#':
            return is_digit(p[1]) ? Kind::reference : Kind::constant;
        case '@':
            return is_digit(p[1]) ? Kind::value_reference : Kind::constant;
        case '.':
            return is_digit(p[1]) ? Kind::real : Kind::enumeration;
        default:
            break;
    }
    if (is_letter(*p) || *p == '!') return Kind::typed;
    return skip_number(p, end).is_real ? Kind::real : Kind::integer;
}

const char* skip_value(const char* p, const char* end) {
    if (*p == '(' || is_letter(*p) || *p == '!') return skip_brackets(p, end);
    return skip_scalar(p, end);
}

const char* next_value(const char* p, const char* end) {
    p = skip_blank(skip_value(p, end), end);
    return *p == ',' ? skip_blank(p + 1, end) : nullptr;
}

const char* first_value(const char* open, const char* end) {
    const char* p = skip_blank(open + 1, end);
    return *p == ')' ? nullptr : p;
}

}  // namespace lyr::part21
