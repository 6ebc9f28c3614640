// Sleep, for threads that are not real-time.
#pragma once

#include "kernel/base/time.hpp"

namespace tappet::os {

/// Sleeps for `time` at least. Not real-time.
void sleep_for(Duration time) noexcept;

} // namespace tappet::os
