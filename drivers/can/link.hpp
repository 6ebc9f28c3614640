// The network interface behind a CAN socket, over rtnetlink: what it is set to, how its bus is, and down and
// up again.
#pragma once

#include "drivers/can/frame.hpp"
#include "kernel/base/text.hpp"

#include <cstddef>
#include <cstdint>
#include <expected>
#include <span>
#include <string_view>

namespace tappet::can {

struct Link {
    int index = 0;
    bool up = false;
    bool is_virtual = false;      ///< vcan: no bit rate, no controller
    std::uint32_t bit_rate = 0;   ///< 0: not set, or virtual
    std::uint32_t restart_ms = 0; ///< 0: stays bus-off, as a machine wants it
    State state = State::active;  ///< as the controller tells it now; active when it is virtual
};

/// Not real-time. Names the interface and the cure when it is not there or is no CAN interface.
std::expected<Link, Sentence> find_link(std::string_view interface);
/// What the kernel's answer (RTM_NEWLINK, its header first) says. The error names the cure when it is no CAN
/// interface.
std::expected<Link, Sentence> read_link(std::string_view interface, std::span<const std::byte> answer);
/// Whether a machine may send there, at the bit rate that its board says: up, of that rate, restarted by
/// nobody but us, not faulted. A virtual interface has no rate to compare.
std::expected<void, Sentence> fit(const Link& link, std::string_view interface, std::uint32_t bit_rate);

/// Not real-time. Down and up: the only way that drops what the kernel's queue and the controller still hold.
std::expected<void, Sentence> restart_link(const Link& link);

} // namespace tappet::can
