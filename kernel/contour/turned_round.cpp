#include "kernel/contour/turned_round.h"

namespace lyr {

Path turned_round(const Path& open) {
    if (open.segments.empty()) return open;
    Path back{open.segments.back().end, {}};
    for (std::size_t i = open.segments.size(); i-- > 0;)
        back.segments.push_back(
            {i > 0 ? open.segments[i - 1].end : open.start, -open.segments[i].sagitta_mm});
    return back;
}

Contour turned_round(const Contour& closed) {
    if (const auto* circle = std::get_if<FullCircle>(&closed))
        return FullCircle{circle->centre, circle->radius_mm, !circle->counter_clockwise};
    const Path& path = std::get<Path>(closed);
    Path back = turned_round(path);
    back.start = path.start;
    return back;
}

}  // namespace lyr
