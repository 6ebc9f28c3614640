// The network interface behind a CAN socket, over rtnetlink: what it is set to, and down and up again.
#pragma once

#include "kernel/base/text.hpp"

#include <cstdint>
#include <expected>
#include <string_view>

namespace tappet::can {

struct Link {
    int index = 0;
    bool up = false;
    bool is_virtual = false;      ///< vcan: no bit rate, no controller
    std::uint32_t bit_rate = 0;   ///< 0: not set, or virtual
    std::uint32_t restart_ms = 0; ///< 0: stays bus-off, as a machine wants it
};

/// Not real-time. Names the interface and the cure when it is not there or is no CAN interface.
std::expected<Link, Sentence> find_link(std::string_view interface);

/// Not real-time. Down and up: the only way that drops what the kernel's queue and the controller still hold.
std::expected<void, Sentence> restart_link(const Link& link);

} // namespace tappet::can
