// What is no number: the border of every machine refuses it, and what keeps a state forgets it.
#pragma once

#include "kernel/base/realtime.hpp"

namespace tappet {

/// False: not a number, or infinite.
constexpr bool is_number(double value) noexcept TAPPET_REALTIME { return value - value == 0.0; }

} // namespace tappet
