// Byte classes and pointer walks; see scan.h.

#include "parser/part21/scan.h"

#include <cstdio>
#include <cstring>

namespace lyr::part21 {
namespace {

// Not past a line break: each line of a string is looked at once.
const char* skip_indent(const char* p, const char* end) {
    while (p < end && (*p == ' ' || *p == '\t')) ++p;
    return p;
}

// Whether a line whose first byte is p shows that a string was not closed on a line before.
bool starts_something_new(const char* p, const char* end) {
    p = skip_indent(p, end);
    if (p == end) return false;
    if (*p == '#') {
        const char* after = skip_digits(p + 1, end);
        if (after == p + 1) return false;
        after = skip_indent(after, end);
        return after < end && *after == '=';
    }
    constexpr std::string_view section_end = "ENDSEC;";
    return static_cast<std::size_t>(end - p) >= section_end.size() &&
           equals_upper({p, section_end.size()}, section_end);
}

}  // namespace

const char* skip_comments(const char* p, const char* end) {
    while (p < end) {
        if (is_blank(*p)) {
            ++p;
        } else if (*p == '/' && end - p >= 2 && p[1] == '*') {
            const char* q = p + 2;
            do {
                q = static_cast<const char*>(
                    std::memchr(q, '*', static_cast<std::size_t>(end - q)));
                if (!q) return p;
                ++q;
            } while (q == end || *q != '/');
            p = q + 1;
        } else if (*p == '\\' && end - p >= 3 && (p[1] == 'N' || p[1] == 'F') && p[2] == '\\') {
            p += 3;
        } else {
            return p;
        }
    }
    return p;
}

const char* skip_string(const char* p, const char* end) {
    ++p;
    while (true) {
        while (p < end && !has_class(*p, detail::in_string)) ++p;
        if (p == end) return nullptr;
        if (*p == '\'') {
            if (p + 1 == end || p[1] != '\'') return p + 1;
            p += 2;
        } else if (*p == '\\') {
            p = skip_escape(p, end);
        } else {
            ++p;
            if (starts_something_new(p, end)) return nullptr;
        }
    }
}

bool equals_upper(std::string_view text, std::string_view upper_case) {
    if (text.size() != upper_case.size()) return false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (to_upper(text[i]) != upper_case[i]) return false;
    }
    return true;
}

std::string upper(std::string_view text) {
    std::string result(text);
    for (char& c : result) c = to_upper(c);
    return result;
}

std::string shortened(const char* p, const char* end) {
    constexpr std::ptrdiff_t longest = 40;
    const bool cut = end - p > longest;
    std::string text(p, cut ? p + longest : end);
    for (char& c : text) {
        if (is_blank(c)) c = ' ';
        if (c < ' ' || c > '~') c = '?';
    }
    return cut ? text + "..." : text;
}

std::string found_at(const char* p, const char* end) {
    if (p == end) return "the end of the file";
    if (end - p >= 2 && p[0] == '/' && p[1] == '*') return "a comment that is never closed";
    if (*p < ' ' || *p > '~') {
        char text[24];
        std::snprintf(text, sizeof text, "the byte 0x%02X", static_cast<unsigned char>(*p));
        return text;
    }
    const char* after = p + 1;
    if (has_class(*p, detail::letter | detail::digit) || *p == '#' || *p == '@' || *p == '!') {
        after = skip_word(after, end);
    }
    return '\'' + shortened(p, after) + '\'';
}

}  // namespace lyr::part21
