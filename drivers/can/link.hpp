// The network interface behind a CAN socket, over rtnetlink: its settings, the state of its bus, and its
// restart.
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
    std::uint32_t mtu = 0;           ///< 16 for classical CAN, 72 for CAN FD
    std::uint32_t bit_rate = 0;      ///< 0: not set, or virtual
    std::uint32_t data_bit_rate = 0; ///< the same for CAN FD's data phase
    std::uint32_t restart_ms = 0;    ///< 0: stays bus-off, as a machine requires
    State state = State::active;     ///< as the controller reports it now; active for a virtual interface

    [[nodiscard]] bool takes_fd() const noexcept { return mtu == 72; }
};

/// Reads the interface. Not real-time. The error states the cure when it is missing or not a CAN interface.
std::expected<Link, Sentence> find_link(std::string_view interface);
/// Reads the kernel's answer (RTM_NEWLINK, starting at its header). The error states the cure when it is not
/// a CAN interface.
std::expected<Link, Sentence> read_link(std::string_view interface, std::span<const std::byte> answer);
/// Checks that a machine may send on this interface: it is up, has the board's bit rates, accepts CAN FD
/// where board or map use it, has no automatic restart, and is not faulted. A virtual interface has no rate
/// to compare.
std::expected<void, Sentence> fit(const Link& link, std::string_view interface, const Settings& settings);
/// Checks only that CAN FD frames pass.
std::expected<void, Sentence> fit_for_fd(const Link& link, std::string_view interface);

/// Takes the interface down and up: the only way to drop what the kernel's queue and the controller still
/// hold. Not real-time.
std::expected<void, Sentence> restart_link(const Link& link);

} // namespace tappet::can
