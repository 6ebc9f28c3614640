// Attributes of messages with named values, and the values that mean yes: CAN FD, and its bit rate switch.
#pragma once

#include <cstdint>
#include <string_view>

namespace tappet::can::dbc {

/// A file states a value by its name, or by its number in the definition.
struct Choice {
    std::string_view attribute{};
    std::uint64_t yes = 0; ///< one bit for each number
    bool usually = false;  ///< for messages that do not state it

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

// As in CANdb++, for files that use the attributes without a definition.
inline constexpr Choice can_fd{.attribute = "VFrameFormat", .yes = std::uint64_t{3} << 14};
inline constexpr Choice bit_rate_switch{.attribute = "CANFD_BRS", .yes = 2, .usually = true};

} // namespace tappet::can::dbc
