// Work that is the same for every plane, done on several threads and taken in order.

#pragma once

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
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

// What is made by several threads and waits to be taken by one in order.
template <class Item>
class Line {
public:
    // At most `room` items wait.
    Line(std::size_t count, std::size_t room) : count_(count), waiting_(room) {}

    // Takes or makes one item, waiting for one if it must. False: there is nothing more to do.
    template <class Make, class Take>
    bool work(bool takes, Make& make, Take& take) {
        std::unique_lock held(lock_);
        changed_.wait(held, [&] {
            return stopped_ || (takes && can_take()) || can_make() ||
                   (takes ? taken_ == count_ : made_ == count_);
        });
        if (stopped_) return false;
        if (takes && can_take()) {
            Item item = std::move(*slot(taken_));
            held.unlock();
            const bool goes_on = take(taken_, std::move(item));
            held.lock();
            slot(taken_).reset();
            ++taken_;
            stopped_ = stopped_ || !goes_on;
        } else if (can_make()) {
            const std::size_t i = made_++;
            held.unlock();
            Item item = make(i);
            held.lock();
            slot(i) = std::move(item);
        } else {
            return false;
        }
        changed_.notify_all();
        return true;
    }

    void stop() {
        const std::lock_guard held(lock_);
        stopped_ = true;
        changed_.notify_all();
    }

    bool is_taken() const { return !stopped_; }

private:
    bool can_take() { return taken_ < count_ && slot(taken_).has_value(); }
    bool can_make() const { return made_ < count_ && made_ < taken_ + waiting_.size(); }
    std::optional<Item>& slot(std::size_t i) { return waiting_[i % waiting_.size()]; }

    std::mutex lock_;
    std::condition_variable changed_;
    std::size_t count_, made_ = 0, taken_ = 0;  // made_: begun
    std::vector<std::optional<Item>> waiting_;
    bool stopped_ = false;
};

// Calls make(i) for i < count on `threads` threads and take(i, result) in order of i, on this thread, as soon as it can: make()
// must not depend on what take() does. No more than so many results a thread wait. take() may return false to stop.
template <class Make, class Take>
bool in_order(std::size_t count, unsigned threads, Make make, Take take) {
    constexpr std::size_t waiting_per_thread = 64;
    threads = static_cast<unsigned>(std::clamp<std::size_t>(count, 1, threads));
    Line<decltype(make(std::size_t{}))> line(count, waiting_per_thread * threads);
    const auto taker = std::this_thread::get_id();
    on_threads(threads, [&] {
        const bool takes = std::this_thread::get_id() == taker;
        try {
            while (line.work(takes, make, take)) {
            }
        } catch (...) {
            line.stop();
            throw;
        }
    });
    return line.is_taken();
}

}  // namespace lyr::slicer
