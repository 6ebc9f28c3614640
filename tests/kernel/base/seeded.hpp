// Tests that draw from a new random seed each time and print it on failure; and values that are not numbers.
#pragma once

#include "kernel/base/random.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <string>

namespace tappet::test {

inline constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
inline constexpr double infinite = std::numeric_limits<double>::infinity();

struct Seeded : testing::Test {
    std::uint64_t seed = std::random_device{}();
    Random random{seed};
    testing::ScopedTrace trace{__FILE__, __LINE__, "seed " + std::to_string(seed)};
};

} // namespace tappet::test
