// What box and program this is.
#pragma once

#include "kernel/base/text.hpp"
#include "kernel/base/time.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tappet::os {

/// Not real-time, all of them.
[[nodiscard]] Sentence kernel_release() noexcept;
/// True on a PREEMPT_RT kernel.
[[nodiscard]] bool kernel_is_realtime() noexcept;
/// The size of this program's file; 0 when it cannot be told.
[[nodiscard]] std::size_t binary_bytes() noexcept;

/// Processor time of this process so far. Called first in main it tells what the kernel took to load the
/// program.
[[nodiscard]] Duration own_processor_time() noexcept;

/// Since 1970, UTC, as the box believes: for dates, not for intervals, since it may be set.
[[nodiscard]] std::int64_t wall_clock_ns() noexcept;

/// The linker's mark of this program (--build-id), in hexadecimal; empty when it was linked without.
struct BuildId {
    std::array<char, 40> digits{};
    std::size_t length = 0;
    [[nodiscard]] std::string_view view() const noexcept { return {digits.data(), length}; }
};
[[nodiscard]] BuildId build_id() noexcept;

} // namespace tappet::os
