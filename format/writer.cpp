// Layers are framed as they come and wait; what stands in front of them is known at the end only.

#include "format/writer.h"

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numbers>

#include "base/replace_file.h"
#include "format/bytes.h"
#include "format/crc32c.h"
#include "format/layer_record.h"
#include "format/layout.h"
#include "format/metadata_text.h"

namespace lyr::format {
namespace {

// What waits beyond this goes to a temporary file.
constexpr std::size_t most_waiting_bytes = std::size_t{32} << 20;
// As many offsets as fit the index.
constexpr std::uint32_t most_layers = longest_payload / index_entry_bytes;
// A day has 86400 s: nobody's print takes 10^9.
constexpr double longest_time_s = 1e9;
// Far beyond any layer, far below what the file's 64 bits hold.
constexpr double largest_volume_mm3 = 1e12;
constexpr double per_gram = 1000;
// The summary's numbers take less in the metadata block.
constexpr std::size_t most_summary_bytes = 512;

Diagnostic usage(const std::string& message, const std::string& path) {
    return {Severity::error, ExitStatus::usage, message, {.file = path}};
}

Diagnostic no_temporary_file(int error) {
    return {Severity::error,
            ExitStatus::output,
            std::string("cannot write a temporary file: ") + std::strerror(error),
            {}};
}

void append(Bytes& to, std::span<const std::byte> bytes) {
    to.insert(to.end(), bytes.begin(), bytes.end());
}

// The head goes in front of the payload, the CRC behind it.
std::size_t begin_block(Bytes& out, BlockType type) {
    const std::size_t begin = out.size();
    put_byte(out, static_cast<std::uint8_t>(type));
    for (int i = 0; i < 3; ++i) put_byte(out, 0);
    return begin;
}

void end_block(Bytes& out, std::size_t begin) {
    const std::size_t length = out.size() - begin - block_head_bytes;
    for (std::size_t i = 0; i < 3; ++i)
        out[begin + 1 + i] = static_cast<std::byte>((length >> (8 * i)) & 0xff);
    put_u32(out, crc32c(std::span<const std::byte>(out).subspan(begin)));
}

void put_block(Bytes& out, BlockType type, std::span<const std::byte> payload) {
    const std::size_t begin = begin_block(out, type);
    append(out, payload);
    end_block(out, begin);
}

// To a unit of the file: what the last bits of a sum are may differ from one machine to another.
double rounded(double value, double per_unit) {
    return std::round(value * per_unit) / per_unit;
}

std::span<const std::byte> bytes_of(std::string_view text) {
    return std::as_bytes(std::span(text.data(), text.size()));
}

Status check(const std::vector<Thumbnail>& thumbnails, const std::string& path) {
    for (const Thumbnail& thumbnail : thumbnails)
        if (thumbnail.png.size() + 8 > longest_payload)
            return usage("a thumbnail is longer than 16 MiB", path);
    return Done{};
}

}  // namespace

class Writer::Implementation {
public:
    Implementation(ReplaceFile file, std::string path, Quantum quantum, Metadata metadata)
        : file_(std::move(file)),
          path_(std::move(path)),
          quantum_(quantum),
          metadata_(std::move(metadata)) {}
    ~Implementation() {
        if (spill_) std::fclose(spill_);
    }
    Implementation(const Implementation&) = delete;
    Implementation& operator=(const Implementation&) = delete;

    Status append(const EncodedLayer& layer);
    Status set_thumbnails(std::vector<Thumbnail> thumbnails);
    Result<FileTotals> finish();

private:
    void frame(const EncodedLayer& layer);
    void count(const EncodedLayer& layer);
    Status spill();
    Status copy_layers();
    Summary summary() const;
    Bytes front() const;
    Bytes back(std::uint64_t front_bytes, std::uint64_t& total_bytes) const;

    ReplaceFile file_;
    std::string path_;
    Quantum quantum_;
    Metadata metadata_;

    std::vector<std::uint64_t> offsets_;  // of the layers, from the first one's block
    Bytes waiting_;
    std::FILE* spill_ = nullptr;
    std::uint64_t spilled_bytes_ = 0;

    FileTotals totals_;
    bool any_motion_ = false, all_estimated_ = true;
    Bounds motion_;
    double volume_mm3_ = 0, time_s_ = 0;
};

Status Writer::Implementation::append(const EncodedLayer& layer) {
    const auto defect = [&](const char* message) {
        return Diagnostic{Severity::error, ExitStatus::internal, message, {.file = path_}};
    };
    if (layer.quantum.nm != quantum_.nm) return defect("a layer has another quantum than the file");
    const double time_s = layer.state.estimated_time_s;
    if (!(time_s >= 0 && time_s <= longest_time_s)) return defect("a layer's time is out of range");
    if (!(layer.totals.volume_mm3 <= largest_volume_mm3))
        return defect("a layer's volume is out of range");
    if (totals_.layers == most_layers) return defect("the file would have too many layers");
    offsets_.push_back(spilled_bytes_ + waiting_.size());
    frame(layer);
    count(layer);
    if (waiting_.size() <= most_waiting_bytes) return Done{};
    return spill();
}

Status Writer::Implementation::set_thumbnails(std::vector<Thumbnail> thumbnails) {
    if (Status checked = check(thumbnails, path_); !checked) return checked;
    metadata_.thumbnails = std::move(thumbnails);
    return Done{};
}

void Writer::Implementation::frame(const EncodedLayer& layer) {
    LayerRecord record;
    record.layer = {totals_.layers, layer.state, layer.totals};
    record.start = {quantum_.quanta(layer.state.start_x_mm),
                    quantum_.quanta(layer.state.start_y_mm), quantum_.quanta(layer.state.z_mm)};
    std::size_t begin = begin_block(waiting_, BlockType::layer);
    encode_layer(record, waiting_);
    end_block(waiting_, begin);
    const std::span<const std::byte> bytes(layer.bytes);
    for (std::size_t i = 0; i < layer.chunks.size(); ++i) {
        const EncodedLayer::Chunk& chunk = layer.chunks[i];
        begin = begin_block(waiting_, BlockType::chunk);
        put_varint(waiting_, totals_.layers);
        put_varint(waiting_, i);
        put_varint(waiting_, chunk.operations);
        format::append(waiting_, bytes.subspan(chunk.begin, chunk.end - chunk.begin));
        end_block(waiting_, begin);
    }
}

void Writer::Implementation::count(const EncodedLayer& layer) {
    ++totals_.layers;
    totals_.chunks += layer.totals.chunks;
    totals_.operations += layer.totals.operations;
    volume_mm3_ += rounded(layer.totals.volume_mm3, scale::volume);
    time_s_ += layer.state.estimated_time_s;
    all_estimated_ = all_estimated_ && layer.state.estimated_time_s > 0;
    const Bounds& box = layer.totals.motion;
    if (!any_motion_) motion_ = box;
    any_motion_ = true;
    motion_.low = {std::min(motion_.low.x, box.low.x), std::min(motion_.low.y, box.low.y),
                   std::min(motion_.low.z, box.low.z)};
    motion_.high = {std::max(motion_.high.x, box.high.x), std::max(motion_.high.y, box.high.y),
                    std::max(motion_.high.z, box.high.z)};
}

Status Writer::Implementation::spill() {
    if (!spill_) spill_ = std::tmpfile();
    if (!spill_) return no_temporary_file(errno);
    if (std::fwrite(waiting_.data(), 1, waiting_.size(), spill_) != waiting_.size())
        return no_temporary_file(errno);
    spilled_bytes_ += waiting_.size();
    waiting_.clear();
    return Done{};
}

Status Writer::Implementation::copy_layers() {
    if (spill_) {
        std::rewind(spill_);
        Bytes piece(buffer_bytes);
        for (std::uint64_t left = spilled_bytes_; left > 0;) {
            const std::size_t wanted =
                static_cast<std::size_t>(std::min<std::uint64_t>(left, piece.size()));
            if (std::fread(piece.data(), 1, wanted, spill_) != wanted)
                return no_temporary_file(errno ? errno : EIO);
            file_.write(std::span<const std::byte>(piece).first(wanted));
            left -= wanted;
        }
    }
    if (!waiting_.empty()) file_.write(waiting_);
    return Done{};
}

Summary Writer::Implementation::summary() const {
    Summary summary;
    summary.layers = totals_.layers;
    summary.low_x_mm = quantum_.mm(motion_.low.x);
    summary.low_y_mm = quantum_.mm(motion_.low.y);
    summary.low_z_mm = quantum_.mm(motion_.low.z);
    summary.high_x_mm = quantum_.mm(motion_.high.x);
    summary.high_y_mm = quantum_.mm(motion_.high.y);
    summary.high_z_mm = quantum_.mm(motion_.high.z);
    summary.volume_mm3 = rounded(volume_mm3_, scale::volume);
    const double diameter_mm = metadata_.filament_diameter_mm;
    const double filament_mm = volume_mm3_ / (std::numbers::pi / 4 * diameter_mm * diameter_mm);
    summary.filament_mm = rounded(filament_mm, scale::filament);
    constexpr double mm3_per_cm3 = 1000;
    summary.mass_g =
        rounded(volume_mm3_ / mm3_per_cm3 * metadata_.filament_density_g_cm3, per_gram);
    summary.estimated_time_s = all_estimated_ ? rounded(time_s_, scale::time) : 0;
    return summary;
}

Bytes Writer::Implementation::front() const {
    Bytes out(magic.begin(), magic.end());
    put_u32(out, major_version | minor_version << 16);
    put_u32(out, quantum_.nm);
    put_u32(out, crc32c(out));
    put_block(out, BlockType::metadata, bytes_of(print_metadata(metadata_, totals_.summary)));
    if (!metadata_.configuration.empty())
        put_block(out, BlockType::configuration, bytes_of(metadata_.configuration));
    for (const Thumbnail& thumbnail : metadata_.thumbnails) {
        const std::size_t begin = begin_block(out, BlockType::thumbnail);
        put_u32(out, thumbnail.width);
        put_u32(out, thumbnail.height);
        format::append(out, thumbnail.png);
        end_block(out, begin);
    }
    return out;
}

Bytes Writer::Implementation::back(std::uint64_t front_bytes, std::uint64_t& total_bytes) const {
    const std::uint64_t index_offset = front_bytes + spilled_bytes_ + waiting_.size();
    Bytes out;
    std::size_t begin = begin_block(out, BlockType::index);
    for (const std::uint64_t offset : offsets_) put_u64(out, front_bytes + offset);
    end_block(out, begin);
    total_bytes = index_offset + out.size() + block_frame_bytes + end_payload_bytes;
    begin = begin_block(out, BlockType::end);
    put_u32(out, totals_.layers);
    put_u64(out, totals_.chunks);
    put_u64(out, totals_.operations);
    put_u64(out, total_bytes);
    put_u64(out, index_offset);
    end_block(out, begin);
    return out;
}

Result<FileTotals> Writer::Implementation::finish() {
    totals_.summary = summary();
    const Summary& sum = totals_.summary;
    if (!is_measure(sum.volume_mm3) || !is_measure(sum.filament_mm) || !is_measure(sum.mass_g) ||
        !is_measure(sum.estimated_time_s))
        return usage("the print is too large: its volume, filament or time is out of range", path_);
    const Bytes head = front();
    const Bytes tail = back(head.size(), totals_.bytes);
    file_.write(head);
    if (Status copied = copy_layers(); !copied) return copied.error();
    file_.write(tail);
    if (Status committed = file_.commit(); !committed) return committed.error();
    return totals_;
}

Writer::Writer(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
Writer::Writer(Writer&&) noexcept = default;
Writer::~Writer() = default;

Result<Writer> Writer::create(const std::string& path, Quantum quantum, Metadata metadata) {
    if (quantum.nm == 0 || quantum.nm > coarsest_quantum_nm)
        return usage("the quantum must be 1 to " + std::to_string(coarsest_quantum_nm) + " nm",
                     path);
    if (!(metadata.filament_diameter_mm > 0) || !is_measure(metadata.filament_diameter_mm) ||
        !is_measure(metadata.filament_density_g_cm3) || !is_measure(metadata.tolerance_mm))
        return usage("the metadata has a number out of range, or no filament diameter", path);
    for (const auto& [key, value] : metadata.extra)
        if (!is_extra_key(key)) return usage("metadata cannot have the key '" + key + "'", path);
    if (print_metadata(metadata, {}).size() + most_summary_bytes > longest_buffered_payload)
        return usage("the metadata is longer than 64 KiB", path);
    if (metadata.configuration.size() > longest_payload)
        return usage("the configuration is longer than 16 MiB", path);
    if (Status checked = check(metadata.thumbnails, path); !checked) return checked.error();
    Result<ReplaceFile> file = ReplaceFile::open(path);
    if (!file) return file.error();
    return Writer(
        std::make_unique<Implementation>(std::move(*file), path, quantum, std::move(metadata)));
}

Status Writer::append(const EncodedLayer& layer) {
    return implementation_->append(layer);
}

Status Writer::set_thumbnails(std::vector<Thumbnail> thumbnails) {
    return implementation_->set_thumbnails(std::move(thumbnails));
}

Result<FileTotals> Writer::finish() {
    return implementation_->finish();
}

}  // namespace lyr::format
