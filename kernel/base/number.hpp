// Detection of NaN and infinity: the inputs of every machine refuse them, and components with a state ignore
// them.
#pragma once

#include "kernel/base/realtime.hpp"

#include <cstddef>
#include <cstring>
#include <limits>

namespace tappet {

/// Returns false for NaN and infinity. A constant expression for these too, unlike a test by subtraction.
constexpr bool is_number(double value) noexcept TAPPET_REALTIME {
    return value >= std::numeric_limits<double>::lowest() && value <= std::numeric_limits<double>::max();
}

/// Reads a float of 4 bytes or a double of 8. Real-time.
inline double real_at(const std::byte* value, std::size_t bytes) noexcept TAPPET_REALTIME {
    double number = 0;
    float single = 0;
    if (bytes == sizeof single) {
        std::memcpy(&single, value, sizeof single);
        return static_cast<double>(single);
    }
    std::memcpy(&number, value, sizeof number);
    return number;
}

} // namespace tappet
