// The prints are read side by side, a layer of each at a time.

#include "format/export/diff.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

#include "base/text.h"
#include "format/export/diff_layer.h"
#include "format/metadata_text.h"

namespace lyr::format {
namespace {

using Keys = std::map<std::string, std::string>;

// Hands over the lines of a text.
template <class Take>
void for_each_line(std::string_view text, Take take) {
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        take(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
}

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(" \t");
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(" \t") + 1 - begin);
}

// A key that is there again (object) gets a number.
void put(Keys& keys, const std::string& key, std::string_view value) {
    std::string name = key;
    for (int i = 2; keys.contains(name); ++i) name = key + ' ' + std::to_string(i);
    keys[name] = value;
}

Keys metadata_of(const FileHeader& header) {
    Keys keys;
    for_each_line(print_metadata(header.metadata, header.summary), [&](std::string_view line) {
        const std::size_t equal = line.find('=');
        put(keys, std::string(line.substr(0, equal)), line.substr(equal + 1));
    });
    keys["quantum_nm"] = std::to_string(header.quantum.nm);
    keys["thumbnails"] = std::to_string(header.metadata.thumbnails.size());
    return keys;
}

// In front of a comment, which is none within quotes.
std::string_view without_comment(std::string_view value) {
    bool quoted = false;
    for (std::size_t i = 0; i < value.size(); ++i) {
        if (value[i] == '"') quoted = !quoted;
        if (value[i] == '#' && !quoted) return trimmed(value.substr(0, i));
    }
    return trimmed(value);
}

// TOML's sections and keys; a line that is neither stands for itself. Where a value comes from does not matter.
Keys configuration_of(const FileHeader& header) {
    Keys keys;
    std::string section;
    for_each_line(header.metadata.configuration, [&](std::string_view line) {
        const std::string_view text = without_comment(line);
        const std::size_t equal = text.find('=');
        if (text.empty()) return;
        if (text.front() == '[' && text.back() == ']')
            section = std::string(text.substr(1, text.size() - 2)) + '.';
        else if (equal != std::string_view::npos)
            put(keys, section + std::string(trimmed(text.substr(0, equal))),
                trimmed(text.substr(equal + 1)));
        else
            put(keys, std::string(text), "");
    });
    return keys;
}

std::vector<KeyDifference> differences(const Keys& a, const Keys& b) {
    std::vector<KeyDifference> out;
    const auto value = [](const Keys& keys, const std::string& key) {
        const auto at = keys.find(key);
        return at == keys.end() ? std::nullopt : std::optional(at->second);
    };
    Keys all = a;
    all.insert(b.begin(), b.end());
    for (const auto& [key, any] : all)
        if (value(a, key) != value(b, key)) out.push_back({key, value(a, key), value(b, key)});
    return out;
}

Result<Statistics> statistics_of_file(const std::string& path) {
    auto reader = Reader::open(path);
    if (!reader) return reader.error();
    return statistics_of(*reader);
}

LayerDifference only_in(const LayerOperations& layer, bool in_a) {
    LayerDifference out;
    (in_a ? out.a : out.b) = layer.layer.index;
    (in_a ? out.operations_a : out.operations_b) = layer.operations.size();
    out.z_mm = layer.layer.state.z_mm;
    return out;
}

// Both side by side, by their heights.
Status compare_layers(LayerSequence& a, LayerSequence& b, Difference& out) {
    Status read = a.next();
    if (read) read = b.next();
    while (read && (a.has() || b.has())) {
        const int order = a.has() && b.has() ? compare_heights(a, b) : a.has() ? -1 : 1;
        if (order != 0) {
            out.layers.push_back(only_in(order < 0 ? a.now() : b.now(), order < 0));
        } else if (auto found = compare(a.now(), b.now())) {
            out.layers.push_back(std::move(*found));
        } else {
            ++out.same_layers;
        }
        if (order <= 0) read = a.next();
        if (read && order >= 0) read = b.next();
    }
    return read;
}

}  // namespace

Result<Difference> diff(const std::string& path_a, const std::string& path_b) {
    Difference out;
    const auto a = statistics_of_file(path_a);
    if (!a) return a.error();
    const auto b = statistics_of_file(path_b);
    if (!b) return b.error();
    out.a = *a;
    out.b = *b;
    out.metadata = differences(metadata_of(a->header), metadata_of(b->header));
    out.configuration = differences(configuration_of(a->header), configuration_of(b->header));
    auto reader_a = Reader::open(path_a), reader_b = Reader::open(path_b);
    if (!reader_a) return reader_a.error();
    if (!reader_b) return reader_b.error();
    LayerSequence layers_a(*reader_a), layers_b(*reader_b);
    if (const Status compared = compare_layers(layers_a, layers_b, out); !compared)
        return compared.error();
    out.layers_a = a->layers;
    out.layers_b = b->layers;
    return out;
}

}  // namespace lyr::format
