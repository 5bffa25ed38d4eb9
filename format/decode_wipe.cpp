// A wipe is read twice: once for its length, which says how fast the filament is drawn back, then piece by piece. What is
// behind it goes on from where it began, so that readers which pass it over find the same places.

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
    if (piece.sagitta == 0)
        return std::hypot(static_cast<double>(piece.to.x - from.x),
                          static_cast<double>(piece.to.y - from.y));
    if (!is_arc(from, piece.to, piece.sagitta)) return std::nullopt;
    return arc_shape(Arc{from, piece.to, piece.sagitta}).length();
}

}  // namespace

bool ChunkDecoder::decode_wipe(Operation& out) {
    const std::uint64_t bytes = cursor_.varint();
    if (bytes > cursor_.left()) return fail("a wipe is cut short");
    wipe_end_ = cursor_.offset() + static_cast<std::size_t>(bytes);
    wipe_depth_mm_ = setting(scale::filament);
    wipe_left_ = 0;
    const Cursor pieces = cursor_;
    Point from = head();
    while (!error_ && !cursor_.bad() && cursor_.offset() < wipe_end_) {
        const Piece piece{step_from(from), cursor_.signed_varint()};
        if (!in_range(piece.to)) return false;
        const std::optional<double> way = length(from, piece);
        if (!way) return fail("an arc has no or too large a sagitta");
        wipe_left_ += *way;
        from = piece.to;
    }
    if (cursor_.bad() || cursor_.offset() != wipe_end_) return fail("a wipe is cut short");
    cursor_ = pieces;
    wipes_ = true;
    return decode_wipe_piece(out);
}

bool ChunkDecoder::decode_wipe_piece(Operation& out) {
    if (cursor_.offset() == wipe_end_) {
        wipes_ = false;
        return false;
    }
    const Point from = head();
    const Piece piece{step_from(from), cursor_.signed_varint()};
    out = Wipe{from, piece.to, piece.sagitta, wipe_depth_mm_, quantum_.mm(1) * wipe_left_};
    wipe_left_ -= length(from, piece).value_or(0);
    wiped_to_ = piece.to;
    wiped_ = wiped_to_ != at_;
    return piece.to != from;
}

}  // namespace lyr::format
