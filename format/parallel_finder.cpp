#include "format/parallel_finder.h"

#include <algorithm>
#include <cmath>

#include "format/layout.h"

namespace lyr::format {
namespace {

// Beyond this the difference is no smaller than what a motion costs by itself.
constexpr std::int64_t most_off_quanta = 48;
constexpr std::int64_t most_repeated_off = 8;
// Shorter runs cost more than they save.
constexpr std::size_t fewest_motions = 3;
// Walls are less than 16 mm apart, at a quantum of 1 um, and not upon each other.
constexpr double nearest_quanta = 2, farthest_quanta = 16384;
// Motions of one direction that are looked at, and of these the ones that are followed.
constexpr int most_looks = 24, most_candidates = 6;
// As many ends make the distance certain to a small part of a quantum.
constexpr std::size_t enough_ends = 16;

bool is_near(std::int64_t off) {
    return off >= -most_off_quanta && off <= most_off_quanta;
}

}  // namespace

// Half a sector further if `turned` is 0.5, so that directions at a border meet once.
std::size_t ParallelFinder::sector(const Vector& direction, double turned) {
    const double along = direction.y / (std::abs(direction.x) + std::abs(direction.y));
    const double turn = direction.x < 0 ? 2 - along : along < 0 ? 4 + along : along;
    return static_cast<std::size_t>(turn * (sectors / 4) + turned) % sectors;
}

void ParallelFinder::add(const PlaneMotion& motion) {
    const std::uint64_t number = history_.count();
    const Course course = course_of(motion);
    history_.add(motion);
    at(courses_, number) = course;
    std::uint64_t& newest = newest_[sector(course.end, 0)];
    at(older_, number) = newest;
    newest = number;
}

// Null: nothing leaves the motion's end.
const Course* ParallelFinder::next(std::uint64_t number) const {
    const PlaneMotion &old = history_[number], &after = history_[number + 1];
    const bool joined = after.from_x == old.to_x && after.from_y == old.to_y;
    return joined ? &course(number + 1) : nullptr;
}

Place ParallelFinder::end_beside(std::uint64_t number, std::int64_t distance) const {
    const Course &old = course(number), *after = next(number);
    return format::end_beside(history_[number], old, after ? after->start : old.end,
                              after ? after->size : old.size,
                              static_cast<double>(distance) / scale::distance);
}

std::int64_t ParallelFinder::sagitta_beside(std::uint64_t number, std::int64_t distance) const {
    return format::sagitta_beside(history_[number], course(number),
                                  static_cast<double>(distance) / scale::distance);
}

std::optional<double> ParallelFinder::distance(const PlaneMotion& motion,
                                               std::uint64_t number) const {
    const PlaneMotion& old = history_[number];
    const Course &ends = course(number), *after = next(number);
    const Vector start = after ? after->start : ends.end;
    const double size = after ? after->size : ends.size, one = ends.size * size;
    const double cosine = ends.end.x * start.x + ends.end.y * start.y;
    if (cosine < -0.5 * one) return std::nullopt;
    // The corner moves by this when the distance grows by 1.
    const double x = -(ends.end.y * size + start.y * ends.size) / (one + cosine);
    const double y = (ends.end.x * size + start.x * ends.size) / (one + cosine);
    const double way_x = static_cast<double>(motion.to_x) - old.to_x;
    const double way_y = static_cast<double>(motion.to_y) - old.to_y;
    const double apart = (way_x * x + way_y * y) / (x * x + y * y);
    const double off = std::abs(way_x * y - way_y * x);
    if (off > static_cast<double>(most_off_quanta) || std::abs(apart) < nearest_quanta ||
        std::abs(apart) > farthest_quanta)
        return std::nullopt;
    return apart;
}

std::size_t ParallelFinder::extent(std::span<const PlaneMotion> motions,
                                   const Alike& beside) const {
    const std::uint64_t known = history_.count() - 1 - beside.what;
    const std::size_t most = std::min<std::size_t>(motions.size(), static_cast<std::size_t>(known));
    for (std::size_t i = 0; i < most; ++i) {
        const PlaneMotion& motion = motions[i];
        const std::uint64_t what = beside.what + i;
        const Place end = end_beside(what, beside.distance);
        if (!is_near(motion.to_x - end.x) || !is_near(motion.to_y - end.y)) return i;
        const std::int64_t sagitta = sagitta_beside(what, beside.distance);
        if (!is_near(motion.sagitta - sagitta)) return i;
    }
    return most;
}

std::int64_t ParallelFinder::mean_distance(std::span<const PlaneMotion> motions,
                                           const Alike& beside) const {
    const std::size_t ends = std::min(beside.count, enough_ends);
    double sum = 0;
    std::size_t counted = 0;
    for (std::size_t i = 0; i < ends; ++i)
        if (const auto apart = distance(motions[i], beside.what + i)) sum += *apart, ++counted;
    if (counted == 0) return beside.distance;
    return std::llround(sum / static_cast<double>(counted) * scale::distance);
}

std::size_t ParallelFinder::repeated(std::span<const PlaneMotion> motions,
                                     std::uint64_t what) const {
    const auto back = static_cast<std::size_t>(history_.count() - what);
    for (std::size_t i = 0; i < motions.size(); ++i) {
        const PlaneMotion& motion = motions[i];
        const PlaneMotion& old = i < back ? history_[what + i] : motions[i - back];
        const auto off = [](std::int64_t from, std::int64_t to, std::int64_t old_from,
                            std::int64_t old_to) { return to - from - (old_to - old_from); };
        if (std::abs(off(motion.from_x, motion.to_x, old.from_x, old.to_x)) > most_repeated_off ||
            std::abs(off(motion.from_y, motion.to_y, old.from_y, old.to_y)) > most_repeated_off ||
            std::abs(motion.sagitta - old.sagitta) > most_repeated_off)
            return i;
    }
    return motions.size();
}

std::optional<Alike> ParallelFinder::find(std::span<const PlaneMotion> motions) const {
    const std::uint64_t count = history_.count(), first = count - history_.kept();
    if (count == 0 || motions.size() < fewest_motions) return std::nullopt;
    const Vector end = course_of(motions[0]).end;
    const std::size_t here = sector(end, 0);
    const std::size_t beyond = sector(end, 0.5) == here ? here + sectors - 1 : here + 1;
    Alike best;
    int looks = 0, candidates = 0;
    for (const std::size_t in : {here, beyond % sectors}) {
        for (std::uint64_t what = newest_[in];
             what != none && what >= first && looks < most_looks && candidates < most_candidates;
             what = at(older_, what)) {
            ++looks;
            Alike alike{what, 0, repeated(motions, what), true};
            if (alike.count > 0) ++candidates;
            if (alike.count > best.count) best = alike;
            const auto apart = what + 1 < count ? distance(motions[0], what) : std::nullopt;
            if (!apart) continue;
            ++candidates;
            alike = {what, std::llround(*apart * scale::distance), 0, false};
            alike.count = extent(motions, alike);
            if (alike.count > best.count) best = alike;
        }
    }
    if (best.count < fewest_motions) return std::nullopt;
    if (best.repeated) return best;
    best.distance = mean_distance(motions, best);
    best.count = extent(motions, best);
    if (best.count < fewest_motions) return std::nullopt;
    return best;
}

}  // namespace lyr::format
