// A wipe is one operation for all its pieces, because the filament is drawn back evenly over them.

#include <algorithm>
#include <cmath>

#include "format/arc.h"
#include "format/encoder_state.h"
#include "format/layer_record.h"
#include "format/layout.h"

namespace lyr::format {
namespace {

// Longer wipes are written as several, so that each is a small part of a chunk.
constexpr std::size_t most_pieces = 200;
constexpr std::size_t most_piece_bytes = 3 * longest_varint;
constexpr std::size_t most_head_bytes = 1 + 2 * longest_varint;

}  // namespace

std::vector<LayerEncoder::Implementation::Wiped> LayerEncoder::Implementation::rounded(
    std::span<const WipePiece> pieces) {
    std::vector<Wiped> wiped;
    Point from = at_;
    for (const WipePiece& piece : pieces) {
        const auto x = quanta(piece.x_mm), y = quanta(piece.y_mm), rise = quanta(piece.sagitta_mm);
        if (!x || !y || !rise) return {};
        Wiped next{{*x, *y, from.z}, 0, 0};
        if (next.to == from) continue;
        next.sagitta = narrowed(from, next.to, *rise);
        next.length = next.sagitta != 0 ? arc_shape(Arc{from, next.to, next.sagitta}).length()
                                        : std::hypot(static_cast<double>(next.to.x - from.x),
                                                     static_cast<double>(next.to.y - from.y));
        from = next.to;
        wiped.push_back(next);
    }
    return wiped;
}

// As the filament is drawn back evenly over all of a wipe, the depth in between follows from the way.
void LayerEncoder::Implementation::wipe(std::span<const WipePiece> pieces, double depth_mm) {
    if (!checked(depth_mm, scale::filament, "a retraction")) return;
    const std::vector<Wiped> all = rounded(pieces);
    if (all.empty()) return retract_to(depth_mm);
    double way = 0, done = 0;
    for (const Wiped& piece : all) way += piece.length;
    const double begin_mm = depth_mm_;
    for (std::size_t first = 0; first < all.size(); first += most_pieces) {
        const auto part = std::span(all).subspan(first, std::min(most_pieces, all.size() - first));
        for (const Wiped& piece : part) done += piece.length;
        put_wipe(part, first + most_pieces < all.size()
                           ? begin_mm + (depth_mm - begin_mm) * done / way
                           : depth_mm);
    }
}

void LayerEncoder::Implementation::put_wipe(std::span<const Wiped> pieces, double depth_mm) {
    begin_operation(most_head_bytes + pieces.size() * most_piece_bytes);
    put_byte(out_.bytes, opcode::wipe);
    put_varint(out_.bytes, setting(depth_mm, scale::filament));
    put_varint(out_.bytes, pieces.size());
    for (const Wiped& piece : pieces) {
        put_step(piece.to, false);
        put_signed(out_.bytes, piece.sagitta);
        if (piece.sagitta != 0) {
            const ArcShape shape = arc_shape(Arc{at_, piece.to, piece.sagitta});
            include_arc(shape.center_x, shape.center_y, shape.radius, shape.start_angle_rad,
                        shape.sweep_rad);
        }
        include(piece.to);
        travelled_ += piece.length;
        at_ = piece.to;
    }
    depth_mm_ = depth_mm;
    given_x_mm_ = quantum_.mm(at_.x);
    given_y_mm_ = quantum_.mm(at_.y);
}

}  // namespace lyr::format
