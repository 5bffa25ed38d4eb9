// What verify() found, for people.

#include <algorithm>

#include "base/text.h"
#include "format/check/verify.h"

namespace lyr::format {
namespace {

// "1 to 6, 8, 10 to 12"
std::string ranges_of(const std::vector<CheckedLayer>& layers) {
    std::string text;
    for (std::size_t i = 0; i < layers.size();) {
        std::size_t last = i;
        const auto number = [&](std::size_t at) { return std::uint64_t{layers[at].index} + 1; };
        while (last + 1 < layers.size() && number(last + 1) == number(last) + 1) ++last;
        text += (text.empty() ? "" : ", ") + std::to_string(number(i));
        if (last > i) text += " to " + std::to_string(number(last));
        i = last + 1;
    }
    return text;
}

std::string place_of(const Finding& finding) {
    if (finding.begin == finding.end) return "at byte " + std::to_string(finding.begin);
    return "bytes " + std::to_string(finding.begin) + " to " + std::to_string(finding.end - 1);
}

std::string version_of(const Verification& v) {
    if (v.major == 0) return "";
    return ".lyr " + std::to_string(v.major) + '.' + std::to_string(v.minor) + ", ";
}

}  // namespace

std::string to_text(const Verification& v, const std::string& name) {
    std::string text = name + ": " + version_of(v) + counted(v.bytes, "byte");
    if (v.findings.empty())
        return text + ", whole\n" + counted(v.layers.size(), "layer") + ", " +
               counted(v.chunks, "chunk") + ", " + counted(v.operations, "operation") + " in " +
               counted(v.blocks, "block") + ": every CRC, number and offset is right\n";
    text += '\n';
    std::size_t widest = 0;
    for (const Finding& finding : v.findings) widest = std::max(widest, place_of(finding).size());
    for (const Finding& finding : v.findings) {
        std::string place = place_of(finding);
        place.resize(widest, ' ');
        text += place + "  " + escaped(finding.what) + '\n';
    }
    text += "whole: ";
    if (v.layers.empty()) return text + "no layer\n";
    text += (v.layers.size() == 1 ? "layer " : "layers ") + ranges_of(v.layers);
    if (v.stated_layers) text += " of " + std::to_string(*v.stated_layers);
    return text + '\n';
}

Diagnostic to_diagnostic(const Verification& v, const std::string& name) {
    const Finding& first = v.findings.front();
    std::string message = first.what + " (" + place_of(first) + ")";
    if (v.findings.size() > 1)
        message = counted(v.findings.size(), "finding") + "; the first: " + message;
    if (v.whole_from_start > 0)
        message += "; the last whole layer in front of any damage is " +
                   std::to_string(v.whole_from_start) +
                   " (lyrview --repair keeps the print as far as that)";
    else
        message += "; no layer from the bed on is whole";
    return {Severity::error, first.status, message, {.file = name}};
}

}  // namespace lyr::format
