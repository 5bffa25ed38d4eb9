// The layers go through the writer as if they were just encoded; it makes all the rest anew.

#include "format/check/repair.h"

#include "base/replace_file.h"
#include "base/text.h"
#include "format/check/scan.h"
#include "format/layer_record.h"
#include "format/metadata_text.h"

namespace lyr::format {
namespace {

bool is(const Piece& piece, BlockType type) {
    return piece.right && piece.type == static_cast<std::uint8_t>(type);
}

void take_state(EncodedLayer& out, std::span<const std::byte> payload) {
    const char* why = nullptr;
    const auto record = decode_layer(payload, out.quantum, why);
    if (!record) return;
    out.state = record->layer.state;
    out.totals = record->layer.totals;
}

void take_chunk(EncodedLayer& out, std::span<const std::byte> payload) {
    Cursor cursor(payload);
    cursor.varint();  // the layer's number
    cursor.varint();  // its own
    const std::uint64_t operations = cursor.varint();
    const auto bytes = payload.subspan(cursor.offset());
    const std::size_t begin = out.bytes.size();
    out.bytes.insert(out.bytes.end(), bytes.begin(), bytes.end());
    out.chunks.push_back({begin, out.bytes.size(), operations});
}

// Blocks between its chunks, right or damaged, are no part of a layer.
EncodedLayer encoded(FileView& file, const CheckedLayer& layer, Quantum quantum) {
    EncodedLayer out;
    out.quantum = quantum;
    Scanner scanner(file, layer.begin);
    for (auto piece = scanner.next(); piece && piece->begin < layer.end; piece = scanner.next()) {
        if (is(*piece, BlockType::layer)) take_state(out, piece->payload(file));
        if (is(*piece, BlockType::chunk)) take_chunk(out, piece->payload(file));
    }
    return out;
}

// What the writer takes, and a note for what it does not.
Metadata writable(const Verification& verification, std::vector<std::string>& notes) {
    if (!verification.metadata) {
        notes.push_back(
            "the metadata was damaged: names, configuration and thumbnails are lost, the "
            "filament is taken to be 1.75 mm thick");
        return {};
    }
    Metadata metadata = *verification.metadata;
    if (!(metadata.filament_diameter_mm > 0)) {
        metadata.filament_diameter_mm = Metadata{}.filament_diameter_mm;
        notes.push_back("the metadata has no filament diameter: taken to be 1.75 mm");
    }
    for (auto at = metadata.extra.begin(); at != metadata.extra.end();) {
        const bool kept = is_extra_key(at->first);
        if (!kept) notes.push_back("the metadata's line " + in_quotes(at->first) + " is left out");
        at = kept ? at + 1 : metadata.extra.erase(at);
    }
    return metadata;
}

std::string kept_layers(const Verification& verification) {
    const std::uint32_t kept = verification.whole_from_start;
    const std::string layers =
        kept == 1 ? "layer 1 is" : "layers 1 to " + std::to_string(kept) + " are";
    std::string text = layers + " kept";
    if (verification.stated_layers) text += ", of " + std::to_string(*verification.stated_layers);
    const std::size_t behind = verification.layers.size() - kept;
    if (behind > 0) text += "; left out behind the damage: " + counted(behind, "whole layer");
    return text;
}

// Of a whole file.
Result<Repaired> copied(FileView& file, const Verification& verification,
                        const std::string& output) {
    auto copy = ReplaceFile::open(output);
    if (!copy) return copy.error();
    for (std::uint64_t at = 0; at < file.size(); at += FileView::window_bytes)
        copy->write(file.at(at, FileView::window_bytes));
    if (file.error()) return *file.error();
    if (const Status committed = copy->commit(); !committed) return committed.error();
    Repaired out;
    out.totals = {static_cast<std::uint32_t>(verification.layers.size()), verification.chunks,
                  verification.operations, verification.bytes, verification.summary};
    return out;
}

}  // namespace

Result<Repaired> repair(FileView& file, const Verification& verification, const std::string& name,
                        const std::string& output) {
    const auto refuse = [&](const std::string& why) {
        return Diagnostic{Severity::error, ExitStatus::input, why, {.file = name}};
    };
    if (verification.findings.empty()) return copied(file, verification, output);
    if (!verification.quantum) {
        const bool other = verification.blocks == 0;
        return refuse(
            other ? verification.findings.front().what
                  : "the prologue is damaged: without the unit of its coordinates the print "
                    "cannot be repaired");
    }
    if (verification.whole_from_start == 0)
        return refuse("no layer from the bed on is whole: there is nothing to keep");
    Repaired out;
    out.notes.push_back(kept_layers(verification));
    auto writer = Writer::create(output, *verification.quantum, writable(verification, out.notes));
    if (!writer) return writer.error();
    for (std::size_t i = 0; i < verification.whole_from_start; ++i)
        if (const Status appended =
                writer->append(encoded(file, verification.layers[i], *verification.quantum));
            !appended)
            return appended.error();
    if (file.error()) return *file.error();
    const auto totals = writer->finish();
    if (!totals) return totals.error();
    out.totals = *totals;
    return out;
}

}  // namespace lyr::format
