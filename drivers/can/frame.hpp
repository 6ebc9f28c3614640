// A CAN frame (ISO 11898-1), classical or CAN FD, and its priority in arbitration.
#pragma once

#include "kernel/base/time.hpp"

#include <array>
#include <cstdint>
#include <string_view>

namespace tappet::can {

/// The state of the bus as the controller reports it, by severity; from `unacknowledged` on nothing is sent.
enum class State : std::uint8_t {
    active,         ///< error active: fully working
    warning,        ///< an error counter reached 96
    passive,        ///< an error counter reached 128
    unacknowledged, ///< frames were handed over and not acknowledged in time
    bus_off,        ///< the controller left the bus; it stays away until restart()
    down,           ///< the interface is down or gone
};
constexpr std::string_view to_text(State state) noexcept {
    switch (state) {
    case State::active: return "active";
    case State::warning: return "warning";
    case State::passive: return "passive";
    case State::unacknowledged: return "unacknowledged";
    case State::bus_off: return "bus-off";
    case State::down: return "down";
    }
    return "unknown";
}
constexpr bool faulted(State state) noexcept { return state >= State::unacknowledged; }

/// The contents of an error frame.
struct BusError {
    State state = State::active;
    bool restarted = false;        ///< the controller came back
    bool transmit_timeout = false; ///< the driver gave up on a frame
    bool overrun = false;          ///< the controller lost frames before the kernel saw them
    std::uint8_t transmit_errors = 0;
    std::uint8_t receive_errors = 0;
    bool operator==(const BusError&) const = default;
};

enum class Format : std::uint8_t {
    classical,      ///< up to 8 bytes
    flexible,       ///< CAN FD in one bit rate, up to 64 bytes
    flexible_faster ///< CAN FD that switches to the data bit rate
};

/// Returns the least valid frame length for so many bytes; above 8, CAN FD has only certain lengths. -1:
/// longer than any frame.
constexpr int padded_length(unsigned bytes) noexcept {
    for (const int length : {0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64})
        if (bytes <= static_cast<unsigned>(length)) return length;
    return -1;
}

/// Data of the longest frame; bytes behind a shorter frame's length have no meaning.
using Payload = std::array<std::uint8_t, 64>;

struct Frame {
    std::uint32_t id = 0; ///< 11 bits, or 29 when extended
    bool extended = false;
    bool remote = false;
    bool fd = false;
    bool bit_rate_switch = false;       ///< CAN FD only
    bool error_state_indicator = false; ///< CAN FD only, received: its sender is error passive
    std::uint8_t length = 0;
    Payload data{};
    Time stamp{};     ///< received: time of arrival; to send: when its contents were made
    BusError error{}; ///< in error frames only
    bool operator==(const Frame&) const = default;
};

/// An identifier for a filter: matches exactly this number in this format.
struct Identifier {
    std::uint32_t id = 0;
    bool extended = false;
    bool operator==(const Identifier&) const = default;
};

constexpr bool valid(Identifier identifier) noexcept {
    return identifier.id <= (identifier.extended ? 0x1FFF'FFFFu : 0x7FFu);
}
/// CAN FD has no remote frames, and classical CAN has no second bit rate.
constexpr bool valid(const Frame& frame) noexcept {
    if (!valid(Identifier{frame.id, frame.extended})) return false;
    return frame.fd ? !frame.remote && padded_length(frame.length) == frame.length
                    : frame.length <= 8 && !frame.bit_rate_switch;
}
constexpr Format format_of(const Frame& frame) noexcept {
    // In the order of the enumeration and without a branch: called for every frame that arrives.
    return static_cast<Format>(unsigned{frame.fd} * (1u + unsigned{frame.bit_rate_switch}));
}
constexpr void set_format(Frame& frame, Format format) noexcept {
    frame.fd = format != Format::classical;
    frame.bit_rate_switch = format == Format::flexible_faster;
}

/// Returns the arbitration bits as a number; the lowest number wins the bus.
/// Order on the wire: 11 bits of base, RTR (SRR when extended), IDE, 18 bits of extension, RTR.
constexpr std::uint32_t arbitration(const Frame& frame) noexcept {
    if (!frame.extended) return (frame.id << 21) | ((frame.remote ? 1u : 0u) << 20);
    return ((frame.id >> 18) << 21) | (3u << 19) | ((frame.id & 0x3FFFFu) << 1) | (frame.remote ? 1u : 0u);
}

} // namespace tappet::can
