// Each known key has one line that says where its value goes.

#include <array>
#include <charconv>
#include <cmath>

#include "format/metadata_text.h"

namespace lyr::format {
namespace {

struct TextKey {
    std::string_view key;
    std::string Metadata::*field;
};

constexpr std::array<TextKey, 6> text_keys{{{"generator", &Metadata::generator},
                                            {"source", &Metadata::source_name},
                                            {"source_sha256", &Metadata::source_sha256},
                                            {"printer", &Metadata::printer},
                                            {"material", &Metadata::material},
                                            {"profile", &Metadata::profile}}};

struct NumberKey {
    std::string_view key;
    double Metadata::*field;
};

constexpr std::array<NumberKey, 3> number_keys{
    {{"tolerance_mm", &Metadata::tolerance_mm},
     {"filament_diameter_mm", &Metadata::filament_diameter_mm},
     {"filament_density_g_cm3", &Metadata::filament_density_g_cm3}}};

struct SummaryKey {
    std::string_view key;
    double Summary::*field;
};

constexpr std::array<SummaryKey, 10> summary_keys{{{"low_x_mm", &Summary::low_x_mm},
                                                   {"low_y_mm", &Summary::low_y_mm},
                                                   {"low_z_mm", &Summary::low_z_mm},
                                                   {"high_x_mm", &Summary::high_x_mm},
                                                   {"high_y_mm", &Summary::high_y_mm},
                                                   {"high_z_mm", &Summary::high_z_mm},
                                                   {"volume_mm3", &Summary::volume_mm3},
                                                   {"filament_mm", &Summary::filament_mm},
                                                   {"mass_g", &Summary::mass_g},
                                                   {"time_s", &Summary::estimated_time_s}}};

constexpr std::string_view object_key = "object", layers_key = "layers";

template <class Number>
bool parse_number(std::string_view text, Number& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

bool parse_measure(std::string_view text, double& value) {
    return parse_number(text, value) && is_measure(value);
}

std::string unescaped(std::string_view text) {
    std::string value;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool escape = text[i] == '\\' && i + 1 < text.size();
        if (escape) ++i;
        value += escape && text[i] == 'n' ? '\n' : text[i];
    }
    return value;
}

template <class Keys>
auto find_key(const Keys& keys, std::string_view key) -> decltype(keys.data()) {
    for (const auto& known : keys)
        if (known.key == key) return &known;
    return nullptr;
}

// False: not a number.
bool take(std::string_view key, std::string_view text, ParsedMetadata& parsed) {
    Metadata& metadata = parsed.metadata;
    if (const auto* known = find_key(text_keys, key)) {
        metadata.*known->field = unescaped(text);
    } else if (const auto* number = find_key(number_keys, key)) {
        return parse_measure(text, metadata.*number->field);
    } else if (const auto* counted = find_key(summary_keys, key)) {
        return parse_measure(text, parsed.summary.*counted->field);
    } else if (key == layers_key) {
        return parse_number(text, parsed.summary.layers);
    } else if (key == object_key) {
        metadata.objects.push_back(unescaped(text));
    } else {
        metadata.extra.emplace_back(key, unescaped(text));
    }
    return true;
}

}  // namespace

bool is_extra_key(std::string_view key) {
    for (const char c : key) {
        const bool word = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                          (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
        if (!word) return false;
    }
    return !key.empty() && !find_key(text_keys, key) && !find_key(number_keys, key) &&
           !find_key(summary_keys, key) && key != object_key && key != layers_key;
}

ParsedMetadata parse_metadata(std::string_view text) {
    ParsedMetadata parsed;
    for (std::size_t number = 1; !text.empty(); ++number) {
        const std::string_view line = text.substr(0, text.find('\n'));
        text.remove_prefix(line.size() < text.size() ? line.size() + 1 : line.size());
        const std::size_t equals = line.find('=');
        if (equals == std::string_view::npos) {
            parsed.error = "line " + std::to_string(number) + " of the metadata is not key=value";
            return parsed;
        }
        const std::string_view key = line.substr(0, equals);
        if (!take(key, line.substr(equals + 1), parsed)) {
            parsed.error = "line " + std::to_string(number) + " of the metadata has no number";
            return parsed;
        }
    }
    return parsed;
}

}  // namespace lyr::format
