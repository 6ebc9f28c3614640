// The older version.
#pragma once

#include "tests/bench/image/layouts/milling.hpp"

namespace tappet::layouts::older {

inline constexpr auto table = milling<OlderMill>();

} // namespace tappet::layouts::older
