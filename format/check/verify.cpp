// One pass over the blocks. Each right one tells its place in the print; what lies between the place
// that was due and that of the next right block is what the bad bytes between them have cost.

#include "format/check/verify.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "format/bytes.h"
#include "format/check/place.h"
#include "format/check/scan.h"
#include "format/chunk_decoder.h"
#include "format/crc32c.h"
#include "format/layer_record.h"
#include "format/layout.h"
#include "format/metadata_text.h"

namespace lyr::format {
namespace {

using Bytes = std::span<const std::byte>;

std::string_view text_of(Bytes bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

bool is(const Piece& piece, BlockType type) {
    return piece.type == static_cast<std::uint8_t>(type);
}

// As far as there is anything.
bool begins_as_print(Bytes head) {
    const Bytes first = head.first(std::min(head.size(), magic.size()));
    return std::equal(first.begin(), first.end(), magic.begin());
}

std::string hexadecimal(std::uint8_t type) {
    constexpr std::string_view digits = "0123456789abcdef";
    return std::string("0x") + digits[type >> 4] + digits[type & 15];
}

std::string kind_of(std::uint8_t type) {
    switch (static_cast<BlockType>(type)) {
        case BlockType::metadata:
            return "the metadata";
        case BlockType::layer:
            return "a layer's block";
        case BlockType::chunk:
            return "a chunk";
        case BlockType::index:
            return "the index";
        case BlockType::end:
            return "the end block";
        case BlockType::thumbnail:
            return "a thumbnail";
        case BlockType::configuration:
            return "the configuration";
    }
    return "a block of type " + hexadecimal(type);
}

// The layer at hand; `sound` while nothing of it was wrong.
struct OpenLayer {
    CheckedLayer layer;
    LayerTotals totals;
    std::uint64_t chunks = 0, operations = 0;
    bool sound = false;
};

class Verifier {
public:
    explicit Verifier(FileView& file) : file_(file) { out_.bytes = file.size(); }

    Verification run() {
        if (!read_prologue()) return std::move(out_);
        find_stated_layers();
        Scanner scanner(file_);
        while (const std::optional<Piece> piece = scanner.next()) {
            if (piece->right)
                take(*piece);
            else
                bad_.push_back(*piece);
        }
        finish();
        std::stable_sort(out_.findings.begin(), out_.findings.end(),
                         [](const Finding& a, const Finding& b) { return a.begin < b.begin; });
        return std::move(out_);
    }

private:
    void find(std::uint64_t begin, std::uint64_t end, std::string what,
              ExitStatus status = ExitStatus::input) {
        out_.findings.push_back({begin, end, std::move(what), status});
    }

    bool read_prologue() {
        const bool known = is_print(file_.at(0, print_head_bytes));
        const Bytes head = file_.at(0, prologue_bytes);
        const bool named = begins_as_print(head);
        const auto stop = [&](const char* what) { return find(0, head.size(), what), false; };
        if (head.empty()) return stop("the file is empty");
        if (!known) return stop(no_print);
        out_.cut_short = head.size() < prologue_bytes;
        if (out_.cut_short) return stop("the file is cut short within its prologue");
        if (!named || crc32c(head.first(12)) != get_u32(head.data() + 12)) {
            find(0, prologue_bytes, "the prologue is damaged (its CRC is wrong)");
            return true;
        }
        const std::uint32_t version = get_u32(head.data() + 4), nm = get_u32(head.data() + 8);
        out_.major = version & 0xffff;
        out_.minor = version >> 16;
        if (out_.major != major_version) {
            find(0, prologue_bytes, "the file has another major version of the format",
                 ExitStatus::unsupported);
            return false;
        }
        if (nm >= 1 && nm <= coarsest_quantum_nm)
            out_.quantum = Quantum{nm};
        else
            find(0, prologue_bytes, "the quantum is out of range");
        return true;
    }

    void find_stated_layers() {
        constexpr std::size_t end_bytes = block_frame_bytes + end_payload_bytes;
        if (file_.size() < prologue_bytes + end_bytes) return;
        const std::optional<Piece> last = Scanner(file_, file_.size() - end_bytes).next();
        if (last->right && last->end == file_.size() && is(*last, BlockType::end))
            state_layers(get_u32(last->payload(file_).data()));
    }

    void state_layers(std::uint32_t layers) {
        if (!out_.stated_layers && layers != 0) out_.stated_layers = layers;
    }

    void take(const Piece& piece) {
        ++out_.blocks;
        switch (static_cast<BlockType>(piece.type)) {
            case BlockType::metadata:
                return take_metadata(piece);
            case BlockType::layer:
                return take_layer(piece);
            case BlockType::chunk:
                return take_chunk(piece);
            case BlockType::index:
                return take_index(piece);
            case BlockType::end:
                return take_end(piece);
            default:
                return take_extra(piece);
        }
    }

    // What stands where. Tells of what is lost in front of it; false: it is not after what was before.
    bool arrive(const Piece& piece, const PrintPlace& place) {
        tell_losses(piece.begin, place);
        const bool in_order = !(place < due_);
        if (!in_order) find(piece.begin, piece.end, name_of(place) + " is out of place");
        return in_order;
    }

    void expect_behind(const PrintPlace& place, std::uint64_t chunks_of_layer) {
        due_ = behind(place, chunks_of_layer, out_.stated_layers);
        chunks_of_layer_ = chunks_of_layer;
    }

    void tell_losses(std::uint64_t at, const PrintPlace& next) {
        // A layer whose own block is lost may have ended with any chunk.
        const bool may_have_ended = chunks_of_layer_ == unknown_chunks && due_.layer != next.layer;
        if (may_have_ended) due_ = behind(due_, 0, out_.stated_layers);
        const std::string lost = name_of_range(due_, next, out_.stated_layers);
        if (bad_.empty() && !lost.empty()) find(at, at, lost + " missing");
        if (!lost.empty()) complete_ = false;
        if (!bad_.empty()) tell_bad(next, lost);
        bad_.clear();
    }

    // Each bad piece by what it was, if there are as many as places are missing.
    void tell_bad(const PrintPlace& next, const std::string& lost) {
        std::vector<std::string> names;
        const auto has_place = [](const Piece& bad) { return (bad.type & skippable_bit) == 0; };
        const auto most =
            static_cast<std::size_t>(std::count_if(bad_.begin(), bad_.end(), has_place));
        PrintPlace place = due_;
        // Of a layer whose own block is lost: as many chunks as the layer before, if nothing tells.
        const auto follower = [&] {
            if (!place.front && place.layer == next.layer)
                return PrintPlace{place.layer, place.part + 1};
            return behind(place, chunks_of_layer_, out_.stated_layers);
        };
        for (; names.size() < most && place < next; place = follower())
            names.push_back(name_of(place));
        // A place that has lost its type, too.
        const bool all = most < bad_.size() && place < next && follower() == next;
        if (all) names.push_back(name_of(place)), place = next;
        const bool each =
            (names.size() == most || (all && names.size() == bad_.size())) && place == next;
        std::size_t named = 0;
        for (const Piece& bad : bad_) {
            const bool by_place = each && (all || has_place(bad)) && named < names.size();
            std::string what = by_place ? names[named++] : kind_of(bad.type);
            if (!each && &bad == &bad_.front() && !lost.empty())
                what = "here " + lost + " lost: " + what;
            find(bad.begin, bad.end, what + " is damaged (CRC)");
        }
        complete_ = false;
    }

    void take_metadata(const Piece& piece) {
        if (!arrive(piece, metadata_place)) return;
        if (piece.end - piece.begin > buffer_bytes)
            return find(piece.begin, piece.end, "the metadata is longer than allowed");
        expect_behind(metadata_place, 0);
        ParsedMetadata parsed = parse_metadata(text_of(piece.payload(file_)));
        if (parsed.error) return find(piece.begin, piece.end, *parsed.error);
        out_.metadata = std::move(parsed.metadata);
        out_.summary = parsed.summary;
        if (parsed.summary.layers != 0) out_.stated_layers = parsed.summary.layers;
    }

    void take_extra(const Piece& piece) {
        if (!(piece.type & skippable_bit))
            return find(piece.begin, piece.end,
                        "a reader is needed that knows blocks of type " + hexadecimal(piece.type),
                        ExitStatus::unsupported);
        if (due_ == metadata_place) {
            tell_losses(piece.begin, {0, 0});
            expect_behind(metadata_place, 0);
        }
        const bool in_front = !open_ && out_.layers.empty();
        const Bytes payload = piece.payload(file_);
        if (!in_front || !out_.metadata) return;
        if (is(piece, BlockType::configuration)) out_.metadata->configuration = text_of(payload);
        if (!is(piece, BlockType::thumbnail)) return;
        if (payload.size() < 8) return find(piece.begin, piece.end, "a thumbnail has no size");
        out_.metadata->thumbnails.push_back({get_u32(payload.data()),
                                             get_u32(payload.data() + 4),
                                             {payload.begin() + 8, payload.end()}});
    }

    void take_layer(const Piece& piece) {
        const char* why = "it is longer than allowed";
        std::optional<LayerRecord> record;
        if (piece.end - piece.begin <= buffer_bytes)
            record = decode_layer(piece.payload(file_), out_.quantum.value_or(Quantum{}), why);
        if (!record) {
            close_layer(piece.begin);
            return find(piece.begin, piece.end,
                        std::string("a layer's block makes no sense: ") + why);
        }
        const PrintPlace place{record->layer.index, 0};
        if (!arrive(piece, place)) return close_layer(piece.begin);
        close_layer(piece.begin);
        offsets_.push_back(piece.begin);
        expect_behind(place, record->layer.totals.chunks);
        open_.emplace();
        open_->layer = {record->layer.index, piece.begin, piece.end};
        open_->totals = record->layer.totals;
        decoder_.begin_layer(record->start, out_.quantum.value_or(Quantum{}));
        open_->sound = true;
    }

    void close_layer(std::uint64_t at) {
        if (!open_) return;
        const CheckedLayer& layer = open_->layer;
        const bool all_chunks = open_->chunks == open_->totals.chunks;
        if (open_->sound && all_chunks && open_->operations != open_->totals.operations) {
            find(at, at,
                 "layer " + std::to_string(std::uint64_t{layer.index} + 1) +
                     " has another number of operations than it says");
        } else if (open_->sound && all_chunks) {
            if (layer.index == out_.whole_from_start) ++out_.whole_from_start;
            out_.layers.push_back(layer);
        }
        open_.reset();
    }

    void take_chunk(const Piece& piece) {
        const Bytes payload = piece.payload(file_);
        Cursor cursor(payload);
        const std::uint64_t layer = cursor.varint(), chunk = cursor.varint();
        const std::uint64_t operations = cursor.varint();
        if (cursor.bad() || piece.end - piece.begin > buffer_bytes) {
            if (open_) open_->sound = false;
            return find(piece.begin, piece.end, "a chunk has no head, or is too long");
        }
        const PrintPlace place{layer, chunk + 1};
        const bool due = place == due_;
        const bool in_order = arrive(piece, place);
        ++out_.chunks;
        out_.operations += operations;
        const bool of_open = open_ && open_->layer.index == layer;
        if (open_ && !of_open) close_layer(piece.begin);
        if (of_open && !due) open_->sound = false;
        if (!in_order) return;
        expect_behind(place, of_open ? open_->totals.chunks : unknown_chunks);
        if (!of_open || !open_->sound) return;
        const std::uint64_t begin = piece.begin + block_head_bytes + cursor.offset();
        decoder_.begin_chunk(payload.subspan(cursor.offset()), operations);
        decode(piece, place, begin);
        open_->layer.end = piece.end;
        ++open_->chunks;
        open_->operations += operations;
    }

    void decode(const Piece& piece, const PrintPlace& place, std::uint64_t begin) {
        Operation operation;
        ChunkDecoder::Step step = ChunkDecoder::Step::operation;
        while (step == ChunkDecoder::Step::operation) step = decoder_.next(operation);
        if (step == ChunkDecoder::Step::end) return;
        open_->sound = false;
        find(piece.begin, piece.end,
             name_of(place) + " makes no sense: " + decoder_.error() + " at byte " +
                 std::to_string(begin + decoder_.end_offset()));
    }

    void take_index(const Piece& piece) {
        if (!arrive(piece, index_place)) return;
        close_layer(piece.begin);
        index_offset_ = piece.begin;
        expect_behind(index_place, 0);
        const Bytes payload = piece.payload(file_);
        const auto leads_to = [&](std::uint64_t layer, std::uint64_t offset) {
            return (layer + 1) * index_entry_bytes <= payload.size() &&
                   get_u64(payload.data() + layer * index_entry_bytes) == offset;
        };
        bool right = !complete_ || payload.size() == offsets_.size() * index_entry_bytes;
        for (std::size_t i = 0; complete_ && i < offsets_.size(); ++i)
            right = right && leads_to(i, offsets_[i]);
        if (!right) find(piece.begin, piece.end, "the index does not lead to the layers");
    }

    void take_end(const Piece& piece) {
        if (!arrive(piece, end_place)) return;
        ended_ = true;
        expect_behind(end_place, 0);
        const Bytes payload = piece.payload(file_);
        if (payload.size() != end_payload_bytes)
            return find(piece.begin, piece.end, "the end block has no totals");
        // Behind a loss they are of another file.
        if (!complete_ || !out_.findings.empty()) return;
        const std::byte* at = payload.data();
        if (get_u32(at) != offsets_.size() || get_u64(at + 4) != out_.chunks ||
            get_u64(at + 12) != out_.operations ||
            (out_.stated_layers && *out_.stated_layers != offsets_.size()))
            find(piece.begin, piece.end,
                 "the file has another number of layers, chunks or operations than it says");
        else if (get_u64(at + 20) != piece.end || get_u64(at + 28) != index_offset_)
            find(piece.begin, piece.end, "the end block is out of place");
    }

    void finish() {
        close_layer(out_.bytes);
        if (ended_ && due_ == nothing_place) {
            if (!bad_.empty())
                find(bad_.front().begin, out_.bytes, "something follows the end of the print");
            return;
        }
        out_.cut_short = bad_.empty() || !is_framed(bad_.back());
        const std::string due = name_of(due_);
        if (!out_.cut_short) {
            const PrintPlace reached = end_behind_bad();
            tell_losses(out_.bytes, reached);
            out_.cut_short = !(reached == nothing_place);
            if (!out_.cut_short) return;
            return find(out_.bytes, out_.bytes,
                        "the file is cut short: " + name_of(reached) + " is due here");
        }
        const std::uint64_t begin = bad_.empty() ? out_.bytes : bad_.back().begin;
        if (!bad_.empty()) bad_.pop_back();
        if (!bad_.empty()) tell_bad(due_, "");
        find(begin, out_.bytes, "the file is cut short: " + due + " is due here");
    }

    // It was written whole: it has the end block's length, or one that leads to the file's end.
    bool is_framed(const Piece& bad) {
        const std::uint64_t size = bad.end - bad.begin;
        if (size < block_frame_bytes) return false;
        const std::uint32_t head = file_.u32_at(bad.begin);
        return size == block_frame_bytes + (head >> 8) ||
               (due_ == end_place && size == block_frame_bytes + end_payload_bytes);
    }

    // As far as the bad pieces reach if each was one block.
    PrintPlace end_behind_bad() const {
        PrintPlace place = due_;
        for (std::size_t i = 0; i < bad_.size(); ++i)
            place = behind(place, chunks_of_layer_, out_.stated_layers);
        return place;
    }

    FileView& file_;
    Verification out_;
    std::vector<Piece> bad_;  // since the last right one
    PrintPlace due_ = metadata_place;
    std::uint64_t chunks_of_layer_ = 0;  // of the layer that is due or begun
    bool complete_ = true;               // nothing is lost so far
    bool ended_ = false;
    std::optional<OpenLayer> open_;
    MotionHistory history_;
    ChunkDecoder decoder_{history_};
    std::vector<std::uint64_t> offsets_;
    std::uint64_t index_offset_ = 0;
};

}  // namespace

// Whatever the first bytes are, where metadata follow the prologue it is one.
bool is_print(std::span<const std::byte> head) {
    head = head.first(std::min(head.size(), print_head_bytes));
    if (begins_as_print(head)) return true;
    if (head.size() <= prologue_bytes) return false;
    FileView view(head);
    const std::optional<Piece> first = Scanner(view).next();
    return first->right && is(*first, BlockType::metadata);
}

Verification verify(FileView& file) {
    return Verifier(file).run();
}

Verification verify(std::span<const std::byte> file) {
    FileView view(file);
    return verify(view);
}

}  // namespace lyr::format
