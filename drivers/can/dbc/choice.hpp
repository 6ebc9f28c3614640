// Attributes of messages whose values have names, and which of these say yes: CAN FD, and its bit rate
// switch.
#pragma once

#include <cstdint>
#include <string_view>

namespace tappet::can::dbc {

/// A file gives the names of values, or their numbers, which its definition counts.
struct Choice {
    std::string_view attribute{};
    std::uint64_t yes = 0; ///< a bit for each number
    bool usually = false;  ///< of messages that do not say it

    constexpr void define(unsigned number, std::string_view value) noexcept {
        if (number < 64 && says_yes(value)) yes |= std::uint64_t{1} << number;
    }
    [[nodiscard]] constexpr bool says_yes(std::string_view value) const noexcept {
        return value == "1" || value.ends_with("CAN_FD");
    }
    [[nodiscard]] constexpr bool says_yes(unsigned number) const noexcept {
        return number < 64 && (yes >> number & 1u) != 0;
    }
};

// As CANdb++ has them, for files that use the attributes and do not define them.
inline constexpr Choice can_fd{.attribute = "VFrameFormat", .yes = std::uint64_t{3} << 14};
inline constexpr Choice bit_rate_switch{.attribute = "CANFD_BRS", .yes = 2, .usually = true};

} // namespace tappet::can::dbc
