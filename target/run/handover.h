// A queue from one thread to another, in which few items wait.
//
// Contract
//  1. Items come out once each, in the order in which they went in.
//  2. push() waits while `most` items are inside, pop() while there are none.
//  3. After close() pop() gives what is left, and then none. After shut() both return at once, with nothing.

#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>

namespace lyr::run {

template <class Item>
class Handover {
public:
    explicit Handover(std::size_t most) : most_(most) {}

    void push(Item item) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return items_.size() < most_ || is_shut_; });
        if (is_shut_) return;
        items_.push_back(std::move(item));
        changed_.notify_all();
    }
    std::optional<Item> pop() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return !items_.empty() || is_closed_ || is_shut_; });
        if (items_.empty() || is_shut_) return std::nullopt;
        std::optional<Item> item(std::move(items_.front()));
        items_.pop_front();
        changed_.notify_all();
        return item;
    }
    void close() { end(is_closed_); }
    void shut() { end(is_shut_); }

private:
    void end(bool& how) {
        const std::lock_guard lock(mutex_);
        how = true;
        changed_.notify_all();
    }

    const std::size_t most_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Item> items_;
    bool is_closed_ = false, is_shut_ = false;
};

}  // namespace lyr::run
