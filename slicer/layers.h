// Work that is the same for every plane, done on several threads and taken in order.

#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <functional>
#include <vector>

#include "kernel/region/region.h"
#include "slicer/slicer.h"

namespace lyr::slicer {

// The middle heights of a part's layers over the bed.
std::vector<double> layer_middles(double part_height_mm, double layer_height_mm);

SectionFigures figures_of(Region contours);
SectionFigures figures_of(const Section& section);  // solid by solid

// The contours of all solids as one region: what is printed of a layer. A single solid's are returned as they are.
RegionResult region_of(const Section& section, const Tolerance& tolerance);

unsigned thread_count(const Options& options);

// Calls work() on so many threads, this one among them. Where the system gives fewer threads,
// those that are there have to do. Whatever is thrown is thrown on, once all have ended.
void on_threads(unsigned threads, const std::function<void()>& work);

// Calls make(i) for i < count on `threads` threads and take(i, result) in order of i, on this thread.
// Batches keep no more than so many results a thread waiting. take() may return false to stop.
template <class Make, class Take>
bool in_order(std::size_t count, unsigned threads, Make make, Take take) {
    constexpr std::size_t batch_per_thread = 64;
    using Item = decltype(make(std::size_t{}));
    for (std::size_t first = 0; first < count;) {
        const std::size_t size = std::min(count - first, batch_per_thread * threads);
        std::vector<Item> items(size);
        std::atomic<std::size_t> next{0};
        on_threads(static_cast<unsigned>(std::min<std::size_t>(threads, size)), [&] {
            for (std::size_t i; (i = next.fetch_add(1)) < size;) items[i] = make(first + i);
        });
        for (std::size_t i = 0; i < size; ++i) {
            if (!take(first + i, std::move(items[i]))) return false;
        }
        first += size;
    }
    return true;
}

}  // namespace lyr::slicer
