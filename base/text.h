// Text for people and programs: numbers, counts, and strings that came from elsewhere.

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace lyr {

// Control characters (C0, DEL, C1) and bytes that are not UTF-8 become \n, \t, \r or \x1b and the like: what a file
// contains must not move the cursor of the terminal that it is shown on, nor break a message into lines.
std::string escaped(std::string_view text);

// Escaped, in double quotes, and cut to a length that fits a message.
std::string in_quotes(std::string_view text);

// A JSON string, quotes and all.
std::string in_json(std::string_view text);
// A JSON number of so many decimals; null for what is infinite, or was never measured.
std::string in_json(double value, int decimals);

// "1 layer", "2 layers", "0 layers": for nouns whose plural takes an s.
std::string counted(std::uint64_t count, std::string_view noun);

// "1:02:03"
std::string clock_text(double time_s);

// Decimal, with or without exponent, and nothing else in the text; none if not finite.
std::optional<double> finite_number(std::string_view text);

// As printf, up to 511 bytes; the rest is cut off.
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...);

// The fewest digits that read back as the same number: 25.4, 1e-05.
std::string shortest(double value);

}  // namespace lyr
