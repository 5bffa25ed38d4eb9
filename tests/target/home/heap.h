// What the tests of this program have on the heap.

#pragma once

#include <atomic>
#include <cstddef>

namespace lyr::tests {

inline thread_local bool counts_allocations = false;  // of this thread
inline std::atomic<std::size_t> allocations{0};
inline std::atomic<std::size_t> held_bytes{0}, most_held_bytes{0};

}  // namespace lyr::tests
