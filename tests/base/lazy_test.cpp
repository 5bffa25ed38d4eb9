#include "base/lazy.h"

#include <doctest/doctest.h>

#include <new>
#include <thread>
#include <vector>

using namespace lyr;

TEST_CASE("lazy 1: made once, whoever comes first") {
    const Lazy<int> value;
    std::atomic<int> calls = 0, wrong = 0;
    {
        std::vector<std::jthread> threads;
        for (int t = 0; t < 8; ++t)
            threads.emplace_back([&] {
                for (int i = 0; i < 1000; ++i)
                    if (value.get([&] { return 41 + ++calls; }) != 42) ++wrong;
            });
    }
    CHECK(calls == 1);
    CHECK(wrong == 0);
}

TEST_CASE("lazy 2: what could not be made is tried again") {
    const Lazy<int> value;
    CHECK_THROWS_AS(value.get([]() -> int { throw std::bad_alloc(); }), std::bad_alloc);
    CHECK(value.get([] { return 7; }) == 7);
    CHECK(value.get([]() -> int { throw std::bad_alloc(); }) == 7);
}
