// What box and program this is.
#pragma once

#include "kernel/base/text.hpp"

#include <cstddef>

namespace tappet::os {

/// Not real-time, all of them.
[[nodiscard]] Sentence kernel_release() noexcept;
/// True on a PREEMPT_RT kernel.
[[nodiscard]] bool kernel_is_realtime() noexcept;
/// The size of this program's file; 0 when it cannot be told.
[[nodiscard]] std::size_t binary_bytes() noexcept;

} // namespace tappet::os
