// A disk that takes nothing, or little.

#pragma once

#include <doctest/doctest.h>
#include <sys/resource.h>

#include <csignal>

namespace lyr::tests {

// While it lives no file of this process can be written but for its first bytes.
class FullDisk {
public:
    explicit FullDisk(rlim_t bytes = 0) {
        was_told_ = std::signal(SIGXFSZ, SIG_IGN);
        REQUIRE(::getrlimit(RLIMIT_FSIZE, &before_) == 0);
        const rlimit some{bytes, before_.rlim_max};
        REQUIRE(::setrlimit(RLIMIT_FSIZE, &some) == 0);
    }
    ~FullDisk() {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, was_told_);
    }

private:
    rlimit before_{};
    void (*was_told_)(int) = nullptr;
};

}  // namespace lyr::tests
