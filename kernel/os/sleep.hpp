// Sleeping, for threads that are not real-time.
#pragma once

#include "kernel/base/time.hpp"

namespace tappet::os {

/// At least so long; not real-time.
void sleep_for(Duration time) noexcept;

} // namespace tappet::os
