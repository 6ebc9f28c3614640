// The network interface behind a CAN socket, over rtnetlink: what it is set to, how its bus is, and down and
// up again.
#pragma once

#include "drivers/can/device.hpp"
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
    bool is_virtual = false;         ///< vcan: no bit rate, no controller
    std::uint32_t mtu = 0;           ///< 16 of classical CAN, 72 of CAN FD
    std::uint32_t bit_rate = 0;      ///< 0: not set, or virtual
    std::uint32_t data_bit_rate = 0; ///< likewise, of CAN FD's data phase
    std::uint32_t restart_ms = 0;    ///< 0: stays bus-off, as a machine wants it
    State state = State::active;     ///< as the controller tells it now; active when it is virtual

    [[nodiscard]] bool takes_fd() const noexcept { return mtu == 72; }
};

/// Not real-time. Names the interface and the cure when it is not there or is no CAN interface.
std::expected<Link, Sentence> find_link(std::string_view interface);
/// What the kernel's answer (RTM_NEWLINK, its header first) says. The error names the cure when it is no CAN
/// interface.
std::expected<Link, Sentence> read_link(std::string_view interface, std::span<const std::byte> answer);
/// Whether a machine may send there, at the bit rates that its board says: up, of those rates, for CAN FD
/// where board or map speak of it, restarted by nobody but us, not faulted. A virtual interface has no rate
/// to compare.
std::expected<void, Sentence> fit(const Link& link, std::string_view interface, const Settings& settings);
/// Of that, whether CAN FD frames pass.
std::expected<void, Sentence> fit_for_fd(const Link& link, std::string_view interface);

/// Not real-time. Down and up: the only way that drops what the kernel's queue and the controller still hold.
std::expected<void, Sentence> restart_link(const Link& link);

} // namespace tappet::can
