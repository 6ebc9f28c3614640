// Converts between the machine's frames and those of Linux (struct canfd_frame, which begins like struct
// can_frame).
#pragma once

#include "drivers/can/frame.hpp"
#include "kernel/base/realtime.hpp"

#include <cstddef>
#include <cstring>
#include <linux/can.h>
#include <linux/can/error.h>

namespace tappet::can::wire {

/// State changes and losses only. One frame per bus error or missing acknowledgement would use a whole
/// processor on an unplugged bus; their consequences are reported as a state or by a confirmation's time-out.
inline constexpr can_err_mask_t error_mask =
    CAN_ERR_CRTL | CAN_ERR_BUSOFF | CAN_ERR_RESTARTED | CAN_ERR_TX_TIMEOUT;

/// Filters one identifier. The mask holds all flags: a bare identifier mask would pass the other format and
/// remote frames.
constexpr can_filter exactly(Identifier one) noexcept {
    return one.extended ? can_filter{one.id | CAN_EFF_FLAG, CAN_EFF_FLAG | CAN_RTR_FLAG | CAN_EFF_MASK}
                        : can_filter{one.id, CAN_EFF_FLAG | CAN_RTR_FLAG | CAN_SFF_MASK};
}

static_assert(offsetof(canfd_frame, len) == offsetof(can_frame, len) &&
              offsetof(canfd_frame, data) == offsetof(can_frame, data));

/// Returns the bytes that the kernel reads and writes for this frame.
constexpr std::size_t bytes_of(const Frame& frame) noexcept TAPPET_REALTIME {
    return frame.fd ? CANFD_MTU : CAN_MTU;
}

/// Writes as many bytes as bytes_of() returns.
inline void encode(const Frame& frame, canfd_frame& raw) noexcept TAPPET_REALTIME {
    raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0u) | (frame.remote ? CAN_RTR_FLAG : 0u);
    raw.len = frame.length;
    raw.flags = frame.bit_rate_switch ? std::uint8_t{CANFD_BRS} : std::uint8_t{0};
    raw.__res0 = raw.__res1 = 0;
    // Two constant lengths, because the compiler optimises these better than a variable one.
    std::memcpy(raw.data, frame.data.data(), CAN_MAX_DLEN);
    if (frame.fd) std::memcpy(raw.data, frame.data.data(), CANFD_MAX_DLEN);
}

/// Returns the state after an error frame, given the state before it.
inline BusError decode_error(const canfd_frame& raw, State before) noexcept TAPPET_REALTIME {
    BusError error{.state = before};
    if ((raw.can_id & CAN_ERR_CRTL) != 0) {
        const unsigned what = raw.data[1];
        error.overrun = (what & (CAN_ERR_CRTL_RX_OVERFLOW | CAN_ERR_CRTL_TX_OVERFLOW)) != 0;
        if ((what & CAN_ERR_CRTL_ACTIVE) != 0) error.state = State::active;
        if ((what & (CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING)) != 0) error.state = State::warning;
        if ((what & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0) error.state = State::passive;
    }
    error.transmit_timeout = (raw.can_id & CAN_ERR_TX_TIMEOUT) != 0;
    error.restarted = (raw.can_id & CAN_ERR_RESTARTED) != 0;
    if ((raw.can_id & CAN_ERR_BUSOFF) != 0) error.state = State::bus_off;
    error.transmit_errors = raw.data[6];
    error.receive_errors = raw.data[7];
    return error;
}

/// Decodes into a default-constructed frame. `bytes`, the kernel's length, gives the format. Returns false
/// when it is not a frame.
inline bool decode(const canfd_frame& raw, std::size_t bytes, State before, Frame& frame) noexcept
    TAPPET_REALTIME {
    frame.fd = bytes == CANFD_MTU;
    if ((!frame.fd && bytes != CAN_MTU) || raw.len > (frame.fd ? CANFD_MAX_DLEN : CAN_MAX_DLEN)) return false;
    frame.length = raw.len;
    if ((raw.can_id & CAN_ERR_FLAG) != 0) {
        frame.id = raw.can_id & CAN_ERR_MASK;
        frame.error = decode_error(raw, before);
    } else {
        frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
        frame.remote = (raw.can_id & CAN_RTR_FLAG) != 0;
        frame.id = raw.can_id & (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
    }
    if (!frame.fd) {
        std::memcpy(frame.data.data(), raw.data, CAN_MAX_DLEN);
        return true;
    }
    frame.bit_rate_switch = (raw.flags & CANFD_BRS) != 0;
    frame.error_state_indicator = (raw.flags & CANFD_ESI) != 0;
    std::memcpy(frame.data.data(), raw.data, CANFD_MAX_DLEN);
    return valid(frame);
}

} // namespace tappet::can::wire
