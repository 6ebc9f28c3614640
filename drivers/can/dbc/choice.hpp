// Attributes of messages with named values, and the values that mean yes: CAN FD, its bit rate switch, and
// frames on demand.
#pragma once

#include "kernel/base/nearest.hpp"

#include <cstdint>
#include <string_view>

namespace tappet::can::dbc {

constexpr bool names_fd(std::string_view value) noexcept { return value == "1" || value.ends_with("CAN_FD"); }
constexpr bool names_one(std::string_view value) noexcept { return value == "1"; }
/// The names differ from maker to maker: "Cyclic", "cyclicAndSpontaneous", "OnChange", "IfActive", "Event".
constexpr bool names_demand(std::string_view value) noexcept {
    constexpr std::string_view parts[] = {"spont",   "event",  "change", "write",
                                          "trigger", "demand", "active", "request"};
    for (const std::string_view part : parts)
        for (std::size_t i = 0; i + part.size() <= value.size(); ++i) {
            std::size_t same = 0;
            while (same < part.size() && lower_case(value[i + same]) == part[same]) ++same;
            if (same == part.size()) return true;
        }
    return false;
}

/// A file states a value by its name, or by its number in the definition.
struct Choice {
    std::string_view attribute{};
    bool (*says_yes)(std::string_view) = nullptr;
    std::uint64_t yes = 0;      ///< one bit for each number
    bool usually = false;       ///< for messages that do not state it
    bool is_unreadable = false; ///< its definition: a number means nothing

    constexpr void define(unsigned number, std::string_view value) noexcept {
        if (number < 64 && says_yes(value)) yes |= std::uint64_t{1} << number;
    }
    [[nodiscard]] constexpr bool holds(unsigned number) const noexcept {
        return number < 64 && (yes >> number & 1u) != 0;
    }
};

// As in CANdb++, for files that use the attributes without a definition.
inline constexpr Choice can_fd{
    .attribute = "VFrameFormat", .says_yes = names_fd, .yes = std::uint64_t{3} << 14};
inline constexpr Choice bit_rate_switch{
    .attribute = "CANFD_BRS", .says_yes = names_one, .yes = 2, .usually = true};
inline constexpr Choice send_type{.attribute = "GenMsgSendType", .says_yes = names_demand};

} // namespace tappet::can::dbc
