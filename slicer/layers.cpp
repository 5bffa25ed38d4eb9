#include "slicer/layers.h"

#include <exception>
#include <mutex>
#include <system_error>
#include <thread>

namespace lyr::slicer {

std::vector<double> layer_middles(double part_height_mm, double layer_height_mm) {
    std::vector<double> middles;
    // A middle that meets the top within resolution is at the top, not below it; what is no number is below nothing.
    for (std::size_t i = 0;; ++i) {
        const double middle = (static_cast<double>(i) + 0.5) * layer_height_mm;
        if (!(middle < part_height_mm - resolution_mm)) return middles;
        middles.push_back(middle);
    }
}

SectionFigures figures_of(Region contours) {
    SectionFigures figures{.loops = contours.size()};
    for (const Contour& contour : contours) {
        figures.area_mm2 += area_mm2(contour);
        figures.length_mm += length_mm(contour);
        if (std::holds_alternative<FullCircle>(contour)) ++figures.circles;
        const SegmentCount segments = count(contour);
        figures.lines += segments.lines;
        figures.arcs += segments.arcs;
    }
    return figures;
}

SectionFigures figures_of(const Section& section) {
    std::vector<Contour> contours;
    for (const SolidSection& solid : section.solids) {
        contours.insert(contours.end(), solid.contours.begin(), solid.contours.end());
    }
    SectionFigures figures = figures_of(contours);
    figures.z_mm = section.z_mm;
    figures.open = section.open;
    return figures;
}

RegionResult region_of(const Section& section, const Tolerance& tolerance) {
    if (section.solids.size() == 1) return {.contours = section.solids.front().contours};
    std::vector<Region> regions;
    for (const SolidSection& solid : section.solids) regions.push_back(solid.contours);
    // Where solids share a wall that is no line or circle, each has arcs of its own for it: what is between them is
    // narrower than the tolerance.
    return united(regions, tolerance.unite_mm(), tolerance.total_mm);
}

unsigned thread_count(const Options& options) {
    return options.threads ? options.threads : std::max(1u, std::thread::hardware_concurrency());
}

void on_threads(unsigned threads, const std::function<void()>& work) {
    std::exception_ptr thrown;
    std::mutex lock;
    const auto guarded = [&] {
        try {
            work();
        } catch (...) {
            const std::lock_guard held(lock);
            if (!thrown) thrown = std::current_exception();
        }
    };
    {
        std::vector<std::jthread> helpers;
        try {
            while (helpers.size() + 1 < threads) helpers.emplace_back(guarded);
        } catch (const std::system_error&) {
            // No more threads to be had.
        }
        guarded();
    }
    if (thrown) std::rethrow_exception(thrown);
}

}  // namespace lyr::slicer
