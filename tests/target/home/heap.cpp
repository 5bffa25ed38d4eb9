#include "target/home/heap.h"

#include <malloc.h>

#include <cstdlib>
#include <new>

using namespace lyr::tests;

void* operator new(std::size_t size) {
    if (counts_allocations) ++allocations;
    void* memory = std::malloc(size);
    if (!memory) throw std::bad_alloc();
    const std::size_t bytes = ::malloc_usable_size(memory);
    const std::size_t held = held_bytes += bytes;
    std::size_t most = most_held_bytes;
    while (held > most && !most_held_bytes.compare_exchange_weak(most, held)) continue;
    return memory;
}
void operator delete(void* memory) noexcept {
    held_bytes -= ::malloc_usable_size(memory);
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    operator delete(memory);
}
