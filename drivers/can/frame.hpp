// A classic CAN frame (ISO 11898-1) as the machine sees it, its place in arbitration and its length on the
// wire.
#pragma once

#include "kernel/base/time.hpp"

#include <array>
#include <cstdint>
#include <string_view>

namespace tappet::can {

/// What the controller says of the bus, in order of severity; from `unacknowledged` on nothing is sent.
enum class State : std::uint8_t {
    active,         ///< error active: fully working
    warning,        ///< an error counter reached 96
    passive,        ///< an error counter reached 128
    unacknowledged, ///< frames were handed over and nobody acknowledged them in time
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

struct Frame {
    std::uint32_t id = 0; ///< 11 bits, or 29 when extended
    bool extended = false;
    bool remote = false;
    std::uint8_t length = 0;
    std::array<std::uint8_t, 8> data{};
    Time stamp{};     ///< received: when it arrived; to send: when its contents were made
    BusError error{}; ///< in error frames only
    bool operator==(const Frame&) const = default;
};

/// An identifier as a filter takes it: exactly this one, of this format.
struct Identifier {
    std::uint32_t id = 0;
    bool extended = false;
    bool operator==(const Identifier&) const = default;
};

constexpr bool valid(Identifier identifier) noexcept {
    return identifier.id <= (identifier.extended ? 0x1FFF'FFFFu : 0x7FFu);
}
constexpr bool valid(const Frame& frame) noexcept {
    return valid(Identifier{frame.id, frame.extended}) && frame.length <= 8;
}

/// The bits of arbitration as a number: the lower one wins the bus.
/// Order on the wire: 11 bits of base, RTR (SRR when extended), IDE, 18 bits of extension, RTR.
constexpr std::uint32_t arbitration(const Frame& frame) noexcept {
    if (!frame.extended) return (frame.id << 21) | ((frame.remote ? 1u : 0u) << 20);
    return ((frame.id >> 18) << 21) | (3u << 19) | ((frame.id & 0x3FFFFu) << 1) | (frame.remote ? 1u : 0u);
}

/// Flag, its echo, delimiter and gap: what an error takes besides the frame that it spoilt.
inline constexpr std::uint32_t error_frame_bits = 31;

/// The most bits a frame takes on the wire, worst stuffing and interframe space included (Davis et al.,
/// 2007).
constexpr std::uint32_t worst_bits(const Frame& frame) noexcept {
    const std::uint32_t stuffable = frame.extended ? 54 : 34;
    const std::uint32_t payload = frame.remote ? 0 : 8u * frame.length;
    return payload + stuffable + 13 + (stuffable + payload - 1) / 4;
}

} // namespace tappet::can
