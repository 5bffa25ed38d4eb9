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

SectionFigures figures_of(const Section& section) {
    SectionFigures figures{.z_mm = section.z_mm, .open = section.open};
    for (const SolidSection& solid : section.solids) {
        for (const Contour& contour : solid.contours) {
            figures.area_mm2 += area_mm2(contour);
            figures.length_mm += length_mm(contour);
            ++figures.loops;
            if (std::holds_alternative<FullCircle>(contour)) ++figures.circles;
            const SegmentCount segments = count(contour);
            figures.lines += segments.lines;
            figures.arcs += segments.arcs;
        }
    }
    return figures;
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
