// Frames and numbers as peers write them.
#pragma once

#include "drivers/can/frame.hpp"

#include <bit>
#include <cstdio>
#include <string>

namespace tappet::can {

inline std::string hex_of(const Frame& frame, std::string_view digits = "0123456789abcdef") {
    std::string hex;
    for (std::size_t i = 0; i < frame.length; ++i) {
        hex += digits[frame.data[i] >> 4];
        hex += digits[frame.data[i] & 15];
    }
    return hex;
}
inline std::string bits_of(double value) {
    char text[17] = {};
    std::snprintf(text, sizeof text, "%016llx",
                  static_cast<unsigned long long>(std::bit_cast<std::uint64_t>(value)));
    return text;
}

} // namespace tappet::can
