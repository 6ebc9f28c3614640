// The newer version.
#pragma once

#include "tests/bench/image/layouts/milling.hpp"

namespace tappet::layouts::newer {

inline constexpr auto table = milling<NewerMill>();

} // namespace tappet::layouts::newer
