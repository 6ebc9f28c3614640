// Page faults of the calling thread. After arming a real-time thread has none: each is an access to memory
// that was not present, and costs microseconds to milliseconds.
#pragma once

#include "kernel/base/realtime.hpp"

#include <cstdint>

namespace tappet::os {

struct PageFaults {
    std::uint64_t minor = 0; ///< the page was in memory, but not mapped
    std::uint64_t major = 0; ///< the page was fetched from a disk
    constexpr bool operator==(const PageFaults&) const = default;
};

constexpr PageFaults operator-(const PageFaults& late, const PageFaults& early) noexcept TAPPET_REALTIME {
    return {late.minor - early.minor, late.major - early.major};
}

/// Returns those since the thread began. One system call that does not block.
PageFaults page_faults_of_this_thread() noexcept TAPPET_REALTIME;
/// Returns those of all threads, including threads that ended.
PageFaults page_faults_of_this_process() noexcept TAPPET_REALTIME;

} // namespace tappet::os
