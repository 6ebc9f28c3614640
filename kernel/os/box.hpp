// Identification of this box and this program.
#pragma once

#include "kernel/base/text.hpp"
#include "kernel/base/time.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tappet::os {

/// Not real-time, like all functions here.
[[nodiscard]] Sentence kernel_release() noexcept;
/// Returns true on a PREEMPT_RT kernel.
[[nodiscard]] bool kernel_is_realtime() noexcept;
/// Returns the size of this program's file; 0 when it is unknown.
[[nodiscard]] std::size_t binary_bytes() noexcept;

/// Returns this process's processor time so far. First in main: the kernel's time to load the program.
[[nodiscard]] Duration own_processor_time() noexcept;

/// Returns the box's time since 1970, UTC: for dates, not for intervals, because the clock may be set.
[[nodiscard]] std::int64_t wall_clock_ns() noexcept;

/// The linker's ID of this program (--build-id), in hexadecimal; empty when it was linked without.
struct BuildId {
    std::array<char, 40> digits{};
    std::size_t length = 0;
    [[nodiscard]] std::string_view view() const noexcept { return {digits.data(), length}; }
};
[[nodiscard]] BuildId build_id() noexcept;

} // namespace tappet::os
