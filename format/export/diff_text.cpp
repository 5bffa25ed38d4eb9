// The text of lyrview --diff.

#include <algorithm>

#include "base/text.h"
#include "format/export/diff.h"

namespace lyr::format {
namespace {

void append_keys(std::string& text, const char* title, const std::vector<KeyDifference>& keys) {
    if (keys.empty()) return;
    text += '\n' + std::string(title) + '\n';
    std::size_t widest = 0;
    for (const KeyDifference& key : keys) widest = std::max(widest, escaped(key.key).size());
    for (const KeyDifference& key : keys) {
        std::string name = escaped(key.key);
        name.resize(widest, ' ');
        const auto value = [](const std::optional<std::string>& of) {
            return of ? escaped(*of) : std::string("(none)");
        };
        text += "  " + name + "  " + value(key.a) + "  ->  " + value(key.b) + '\n';
    }
}

std::string number(const std::optional<std::uint32_t>& layer) {
    return layer ? std::to_string(std::uint64_t{*layer} + 1) : "-";
}

// Layers that only one print has, as one line for those that follow each other.
std::size_t append_only(std::string& text, const std::vector<LayerDifference>& layers,
                        std::size_t first) {
    const bool in_a = layers[first].a.has_value();
    std::size_t last = first;
    while (last + 1 < layers.size() && layers[last + 1].a.has_value() == in_a &&
           layers[last + 1].b.has_value() != in_a)
        ++last;
    const auto name = [&](std::size_t i) { return number(in_a ? layers[i].a : layers[i].b); };
    const bool one = first == last;
    text += (one ? "layer " : "layers ") + name(first) + (one ? "" : " to " + name(last));
    text += formatted(" (z %.3f", layers[first].z_mm);
    if (!one) text += formatted(" to %.3f", layers[last].z_mm);
    text += std::string(" mm): only in the ") + (in_a ? "first" : "second") + '\n';
    return last + 1;
}

void append_layer(std::string& text, const LayerDifference& layer) {
    text += "layer " + number(layer.a);
    if (layer.a != layer.b) text += ", " + number(layer.b);
    text += formatted(" (z %.3f mm):", layer.z_mm);
    if (layer.first > 0) {
        text += formatted(" %s of %s", std::to_string(layer.changed_a).c_str(),
                          counted(layer.operations_a, "operation").c_str());
        if (layer.changed_a != layer.changed_b || layer.operations_a != layer.operations_b)
            text += formatted(", %s of %s", std::to_string(layer.changed_b).c_str(),
                              std::to_string(layer.operations_b).c_str());
        text += formatted("; ends up to %.3f mm apart", layer.farthest_mm);
    }
    for (const std::string& state : layer.state) text += "; " + state;
    text += '\n';
    if (layer.first == 0) return;
    text += formatted("  operation %s: ", std::to_string(layer.first).c_str());
    text += layer.first_a + "  ->  " + layer.first_b + '\n';
}

void append_totals(std::string& text, const Difference& d) {
    text += formatted("\n%-18s%24s%24s%24s\n", "", "length m", "volume cm3", "time s");
    text += formatted("%-18s%12s%12s%12s%12s%12s%12s\n", "role", "first", "second", "first",
                      "second", "first", "second");
    const auto row = [&](std::string_view name, const RoleStatistics& a, const RoleStatistics& b) {
        text += formatted("%-18.*s%12.3f%12.3f%12.3f%12.3f%12.1f%12.1f\n",
                          static_cast<int>(name.size()), name.data(), a.length_mm / 1e3,
                          b.length_mm / 1e3, a.volume_mm3 / 1e3, b.volume_mm3 / 1e3,
                          a.moving_time_s, b.moving_time_s);
    };
    RoleStatistics all_a, all_b;
    const auto add = [](RoleStatistics& sum, const RoleStatistics& role) {
        sum.length_mm += role.length_mm;
        sum.volume_mm3 += role.volume_mm3;
        sum.moving_time_s += role.moving_time_s;
    };
    for (std::size_t i = 0; i < d.a.roles.size(); ++i) {
        const RoleStatistics &a = d.a.roles[i], &b = d.b.roles[i];
        add(all_a, a);
        add(all_b, b);
        if (a.motions() > 0 || b.motions() > 0) row(name_of(static_cast<Role>(i)), a, b);
    }
    row("all", all_a, all_b);
    text += formatted("%-18s%12.3f%12.3f%24s%12.1f%12.1f\n", "travel", d.a.travel_mm / 1e3,
                      d.b.travel_mm / 1e3, "", d.a.moving_time_s - all_a.moving_time_s,
                      d.b.moving_time_s - all_b.moving_time_s);
    const double time_a = d.a.header.summary.estimated_time_s,
                 time_b = d.b.header.summary.estimated_time_s;
    if (time_a > 0 || time_b > 0)
        text += formatted("%-18s%48s%12.1f%12.1f\n", "estimated", "", time_a, time_b);
}

}  // namespace

std::string to_text(const Difference& d, const std::string& name_a, const std::string& name_b) {
    std::string text = name_a + "  ->  " + name_b + '\n';
    text += formatted("%s, %s; %u the same\n", counted(d.layers_a, "layer").c_str(),
                      counted(d.layers_b, "layer").c_str(), d.same_layers);
    append_keys(text, "metadata", d.metadata);
    append_keys(text, "settings", d.configuration);
    if (!d.layers.empty()) text += '\n';
    for (std::size_t i = 0; i < d.layers.size();) {
        if (d.layers[i].a && d.layers[i].b)
            append_layer(text, d.layers[i++]);
        else
            i = append_only(text, d.layers, i);
    }
    append_totals(text, d);
    return text;
}

}  // namespace lyr::format
