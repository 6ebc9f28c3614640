// The box that the small machines of these tests run on.
#pragma once

#include "kernel/machine/table/board.hpp"

namespace tappet::test {

inline constexpr Board board{
    .name = "test", .world = "host", .memory_budget_bytes = 4u << 20, .simulated = true};

} // namespace tappet::test
