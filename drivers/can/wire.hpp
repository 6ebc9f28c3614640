// Frames as Linux writes them (struct can_frame), to and from the machine's.
#pragma once

#include "drivers/can/frame.hpp"
#include "kernel/base/realtime.hpp"

#include <linux/can.h>
#include <linux/can/error.h>

namespace tappet::can::wire {

/// State changes and losses only. A frame per bus error or missing acknowledgement would cost a processor on
/// an unplugged bus; what they lead to is reported as a state, or by the time-out of a confirmation.
inline constexpr can_err_mask_t error_mask =
    CAN_ERR_CRTL | CAN_ERR_BUSOFF | CAN_ERR_RESTARTED | CAN_ERR_TX_TIMEOUT;

/// The mask holds all flags: a bare identifier mask would let the other format and remote frames through.
constexpr can_filter exactly(Identifier one) noexcept {
    return one.extended ? can_filter{one.id | CAN_EFF_FLAG, CAN_EFF_FLAG | CAN_RTR_FLAG | CAN_EFF_MASK}
                        : can_filter{one.id, CAN_EFF_FLAG | CAN_RTR_FLAG | CAN_SFF_MASK};
}

inline can_frame encode(const Frame& frame) noexcept TAPPET_REALTIME {
    can_frame raw{};
    raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0u) | (frame.remote ? CAN_RTR_FLAG : 0u);
    raw.len = frame.length;
    for (std::size_t i = 0; i < frame.length; ++i) raw.data[i] = frame.data[i];
    return raw;
}

/// The state that an error frame leaves, from the one before it.
inline BusError decode_error(const can_frame& raw, State before) noexcept TAPPET_REALTIME {
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

/// False for what is no classic frame.
inline bool decode(const can_frame& raw, State before, Frame& frame) noexcept TAPPET_REALTIME {
    if (raw.len > CAN_MAX_DLEN) return false;
    frame.length = raw.len;
    if ((raw.can_id & CAN_ERR_FLAG) != 0) {
        frame.id = raw.can_id & CAN_ERR_MASK;
        frame.error = decode_error(raw, before);
    } else {
        frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
        frame.remote = (raw.can_id & CAN_RTR_FLAG) != 0;
        frame.id = raw.can_id & (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
    }
    for (std::size_t i = 0; i < 8; ++i) frame.data[i] = raw.data[i];
    return true;
}

} // namespace tappet::can::wire
