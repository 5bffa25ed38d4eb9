// A wipe is read twice: once for its length, which says how fast the filament is drawn back, then piece by piece.

#include <cmath>
#include <optional>

#include "format/arc.h"
#include "format/chunk_decoder.h"
#include "format/layout.h"

namespace lyr::format {
namespace {

struct Piece {
    Point to;
    std::int64_t sagitta = 0;
};

// None: an arc that is none.
std::optional<double> length(const Point& from, const Piece& piece) {
    const auto dx = static_cast<double>(piece.to.x - from.x);
    const auto dy = static_cast<double>(piece.to.y - from.y);
    const auto rise = static_cast<double>(piece.sagitta);
    const double chord = std::hypot(dx, dy);
    if (piece.sagitta == 0) return chord;
    if (std::abs(rise) > most_sagitta_per_chord * chord) return std::nullopt;
    return arc_shape(Arc{from, piece.to, piece.sagitta}).length();
}

}  // namespace

bool ChunkDecoder::decode_wipe(Operation& out) {
    wipe_depth_mm_ = setting(scale::filament);
    wipe_left_ = cursor_.varint();
    // Each piece takes three bytes at least.
    if (wipe_left_ > cursor_.left() / 3) return fail("a wipe is cut short");
    const Cursor pieces = cursor_;
    wipe_way_quanta_ = 0;
    Point from = at_;
    for (std::uint64_t i = 0; i < wipe_left_ && !cursor_.bad(); ++i) {
        const Piece piece{step_from(from), cursor_.signed_varint()};
        if (!in_range(piece.to)) return false;
        const std::optional<double> way = length(from, piece);
        if (!way) return fail("an arc has no or too large a sagitta");
        wipe_way_quanta_ += *way;
        from = piece.to;
    }
    if (cursor_.bad()) return fail("a wipe is cut short");
    cursor_ = pieces;
    return wipe_left_ > 0 && decode_wipe_piece(out);
}

bool ChunkDecoder::decode_wipe_piece(Operation& out) {
    const Point from = at_;
    const Piece piece{step_from(from), cursor_.signed_varint()};
    out = Wipe{from, piece.to, piece.sagitta, wipe_depth_mm_, quantum_.mm(1) * wipe_way_quanta_};
    --wipe_left_;
    wipe_way_quanta_ -= length(from, piece).value_or(0);
    at_ = piece.to;
    return piece.to != from;
}

}  // namespace lyr::format
