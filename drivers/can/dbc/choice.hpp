// Attributes of messages with named values, and the values that mean yes: CAN FD, its bit rate switch, and
// frames on demand.
#pragma once

#include "drivers/can/dbc/nearly.hpp"

#include <cstdint>
#include <string_view>

namespace tappet::can::dbc {

enum class Says : std::uint8_t { no, yes, unknown };

constexpr Says says_fd(std::string_view value) noexcept {
    if (value == "1" || value.ends_with("CAN_FD")) return Says::yes;
    constexpr std::string_view classical = "0 StandardCAN ExtendedCAN J1939PG reserved Reserved";
    return names(classical, value) ? Says::no : Says::unknown;
}
constexpr Says says_switch(std::string_view value) noexcept {
    return value == "1" ? Says::yes : value == "0" ? Says::no : Says::unknown;
}
/// The names differ from maker to maker: a message is cyclic alone only with a name that is known to mean it.
constexpr Says says_demand(std::string_view value) noexcept {
    constexpr std::string_view cyclic[] = {
        "",        "cyclic", "periodic", "cyclicx",          "fixedperiodic", "nomsgsendtype",
        "notused", "unused", "reserved", "vectorleerstring", "none"};
    for (const std::string_view each : cyclic) {
        std::size_t same = 0;
        bool is_same = true;
        for (const char c : value) {
            if (c == '_' || c == ' ') continue;
            is_same = is_same && same < each.size() && lower_case(c) == each[same];
            ++same;
        }
        if (is_same && same == each.size()) return Says::no;
    }
    return Says::yes;
}

/// A file states a value by its name, or by its number in the definition.
struct Choice {
    std::string_view attribute{};
    Says (*says)(std::string_view) = nullptr;
    std::uint64_t yes = 0, unknown = 0; ///< one bit for each number
    unsigned count = 64;                ///< numbers from 0 on
    bool usually = false;               ///< for messages that do not state it
    bool is_defined = false;
    bool is_used = false; ///< by number

    /// Returns false when there are too many.
    constexpr bool define(std::string_view value) noexcept {
        if (count == 64) return false;
        const Says what = says(value);
        yes |= std::uint64_t{what == Says::yes} << count;
        unknown |= std::uint64_t{what == Says::unknown} << count;
        ++count;
        return true;
    }
    [[nodiscard]] constexpr Says of(std::uint32_t number) const noexcept {
        if (number >= count || (unknown >> number & 1u) != 0) return Says::unknown;
        return (yes >> number & 1u) != 0 ? Says::yes : Says::no;
    }
};

// As in CANdb++, for files that use the attributes without a definition.
inline constexpr Choice can_fd{.attribute = "VFrameFormat", .says = says_fd, .yes = std::uint64_t{3} << 14};
inline constexpr Choice bit_rate_switch{
    .attribute = "CANFD_BRS", .says = says_switch, .yes = 2, .usually = true};
inline constexpr Choice send_type{.attribute = "GenMsgSendType", .says = says_demand};

} // namespace tappet::can::dbc
