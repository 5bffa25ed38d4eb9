#include "kernel/toolpath/row_cover.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lyr {
namespace {

void append_difference(std::span<const HatchSpan> a, std::span<const HatchSpan> b,
                       std::vector<HatchSpan>& out) {
    auto cut = b.begin();
    for (const HatchSpan& span : a) {
        double at = span.start_mm;
        while (cut != b.end() && cut->end_mm <= at) ++cut;
        for (auto next = cut; next != b.end() && next->start_mm < span.end_mm; ++next) {
            if (next->start_mm > at) out.push_back({at, next->start_mm});
            at = std::max(at, next->end_mm);
        }
        if (at < span.end_mm) out.push_back({at, span.end_mm});
    }
}

void append_union(std::span<const HatchSpan> a, std::span<const HatchSpan> b,
                  std::vector<HatchSpan>& out) {
    const std::size_t first = out.size();
    while (!a.empty() || !b.empty()) {
        const bool from_a = b.empty() || (!a.empty() && a[0].start_mm <= b[0].start_mm);
        auto& source = from_a ? a : b;
        if (out.size() > first && source[0].start_mm <= out.back().end_mm) {
            out.back().end_mm = std::max(out.back().end_mm, source[0].end_mm);
        } else {
            out.push_back(source[0]);
        }
        source = source.subspan(1);
    }
}

void append_common(std::span<const HatchSpan> a, std::span<const HatchSpan> b,
                   std::vector<HatchSpan>& out) {
    while (!a.empty() && !b.empty()) {
        const HatchSpan both{std::max(a[0].start_mm, b[0].start_mm),
                             std::min(a[0].end_mm, b[0].end_mm)};
        if (both.start_mm < both.end_mm) out.push_back(both);
        auto& ends_first = a[0].end_mm < b[0].end_mm ? a : b;
        ends_first = ends_first.subspan(1);
    }
}

double longest_of(std::span<const HatchSpan> intervals) {
    double longest = 0;
    for (const HatchSpan& span : intervals)
        longest = std::max(longest, span.end_mm - span.start_mm);
    return longest;
}

}  // namespace

RowCover::RowCover(std::span<const Contour> region, double pitch_mm) {
    Hatch rows = hatch(region, 0, pitch_mm);
    first_row_ = std::llround(rows.first_offset_mm / pitch_mm - 0.5);
    starts_ = std::move(rows.row_start);
    intervals_ = std::move(rows.spans);
}

double RowCover::length_mm() const {
    double length = 0;
    for (const HatchSpan& span : intervals_) length += span.end_mm - span.start_mm;
    return length;
}

double RowCover::longest_mm() const {
    return longest_of(intervals_);
}

double RowCover::longest_pair_mm() const {
    double longest = 0;
    std::vector<HatchSpan> both;
    for (std::int64_t k = first_row_; k < last_row(); ++k) {
        both.clear();
        append_common(row(k), row(k + 1), both);
        longest = std::max(longest, longest_of(both));
    }
    return longest;
}

std::span<const HatchSpan> RowCover::row(std::int64_t number) const {
    if (number < first_row_ || number >= last_row()) return {};
    const auto k = static_cast<std::size_t>(number - first_row_);
    return std::span(intervals_).subspan(starts_[k], starts_[k + 1] - starts_[k]);
}

RowCover RowCover::without(const RowCover& other) const {
    RowCover result;
    if (empty()) return result;
    result.first_row_ = first_row_;
    for (std::int64_t k = first_row_; k < last_row(); ++k) {
        result.begin_row();
        append_difference(row(k), other.row(k), result.intervals_);
    }
    result.begin_row();
    return result;
}

RowCover RowCover::with(const RowCover& other) const {
    if (empty()) return other;
    if (other.empty()) return *this;
    RowCover result;
    result.first_row_ = std::min(first_row_, other.first_row_);
    const std::int64_t last = std::max(last_row(), other.last_row());
    for (std::int64_t k = result.first_row_; k < last; ++k) {
        result.begin_row();
        append_union(row(k), other.row(k), result.intervals_);
    }
    result.begin_row();
    return result;
}

RowCover RowCover::common(const RowCover& other) const {
    RowCover result;
    if (empty() || other.empty()) return result;
    result.first_row_ = std::max(first_row_, other.first_row_);
    const std::int64_t last = std::min(last_row(), other.last_row());
    for (std::int64_t k = result.first_row_; k < last; ++k) {
        result.begin_row();
        append_common(row(k), other.row(k), result.intervals_);
    }
    result.begin_row();
    return result;
}

}  // namespace lyr
