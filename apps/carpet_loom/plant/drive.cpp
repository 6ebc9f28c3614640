// The CiA 402 transitions; their numbers are the standard's.
#include "apps/carpet_loom/plant/drive.hpp"

namespace tappet::loom {
namespace {

enum class Order : std::uint8_t { none, disable_voltage, quick_stop, shutdown, switch_on, enable_operation };

// Bits 0 switch on, 1 enable voltage, 2 quick stop (active low), 3 enable operation.
constexpr Order order_of(std::uint16_t word) noexcept TAPPET_REALTIME {
    if ((word & 0x02u) == 0) return Order::disable_voltage;
    if ((word & 0x04u) == 0) return Order::quick_stop;
    if ((word & 0x01u) == 0) return Order::shutdown;
    return (word & 0x08u) == 0 ? Order::switch_on : Order::enable_operation;
}
static_assert(order_of(0x00) == Order::disable_voltage && order_of(0x02) == Order::quick_stop);
static_assert(order_of(0x06) == Order::shutdown && order_of(0x07) == Order::switch_on &&
              order_of(0x0F) == Order::enable_operation);

constexpr std::uint16_t fault_reset = 0x80;
constexpr Duration command_timeout = std::chrono::microseconds{wires::drive_command_timeout_us};

} // namespace

Power Drive::power() const noexcept TAPPET_REALTIME {
    if (!node_.alive()) return Power::off;
    switch (state_) {
    case DriveState::operation_enabled: return Power::follow;
    case DriveState::quick_stop_active:
    case DriveState::fault_reaction_active: return Power::stop;
    default: return Power::off;
    }
}

std::uint16_t Drive::statusword() const noexcept TAPPET_REALTIME {
    unsigned word = 0;
    switch (state_) {
    case DriveState::not_ready: word = 0x00; break;
    case DriveState::switch_on_disabled: word = 0x40; break;
    case DriveState::ready_to_switch_on: word = 0x21; break;
    case DriveState::switched_on: word = 0x23; break;
    case DriveState::operation_enabled: word = 0x27; break;
    case DriveState::quick_stop_active: word = 0x07; break;
    case DriveState::fault_reaction_active: word = 0x0F; break;
    case DriveState::fault: word = 0x08; break;
    }
    if (state_ != DriveState::not_ready) word |= 0x0010u; // voltage enabled: the mains are always there
    if (node_.operational()) word |= 0x0200u;             // remote
    if (at_target_ && state_ == DriveState::operation_enabled) word |= 0x0400u;
    if (at_limit_) word |= 0x0800u;
    return static_cast<std::uint16_t>(word);
}

void Drive::control(std::uint16_t word) noexcept TAPPET_REALTIME {
    const bool reset = (word & fault_reset) != 0 && (controlword_ & fault_reset) == 0;
    controlword_ = word;
    if (state_ == DriveState::fault) {
        if (reset) state_ = DriveState::switch_on_disabled; // 15
        return;
    }
    const Order order = order_of(word);
    switch (state_) {
    case DriveState::switch_on_disabled:
        if (order == Order::shutdown) state_ = DriveState::ready_to_switch_on; // 2
        break;
    case DriveState::ready_to_switch_on:
        if (order == Order::switch_on) state_ = DriveState::switched_on;              // 3
        if (order == Order::enable_operation) state_ = DriveState::operation_enabled; // 3 and 4
        if (order == Order::quick_stop || order == Order::disable_voltage)
            state_ = DriveState::switch_on_disabled; // 7
        break;
    case DriveState::switched_on:
        if (order == Order::enable_operation) state_ = DriveState::operation_enabled; // 4
        if (order == Order::shutdown) state_ = DriveState::ready_to_switch_on;        // 6
        if (order == Order::quick_stop || order == Order::disable_voltage)
            state_ = DriveState::switch_on_disabled; // 10
        break;
    case DriveState::operation_enabled:
        if (order == Order::switch_on) state_ = DriveState::switched_on;              // 5
        if (order == Order::shutdown) state_ = DriveState::ready_to_switch_on;        // 8
        if (order == Order::disable_voltage) state_ = DriveState::switch_on_disabled; // 9
        if (order == Order::quick_stop) state_ = DriveState::quick_stop_active;       // 11
        break;
    case DriveState::quick_stop_active:
        if (order == Order::disable_voltage) state_ = DriveState::switch_on_disabled; // 12
        break;
    default: break;
    }
}

void Drive::command(const CanFrame& frame, Time now, FrameOutbox& out) noexcept TAPPET_REALTIME {
    if (!node_.alive() || !node_.operational()) return;
    if (frame.length < wires::length::drive_command) {
        send_emergency(wires::emergency_code::wrong_length, now, out);
        return;
    }
    last_command_ = now;
    target_ = static_cast<std::int32_t>(field_of(frame, 2, 4));
    const bool was_faulty = state_ == DriveState::fault;
    control(static_cast<std::uint16_t>(field_of(frame, 0, 2)));
    if (was_faulty && state_ != DriveState::fault)
        send_emergency(wires::emergency_code::error_reset, now, out);
}

void Drive::supervise(bool standing, bool at_target, bool at_limit, Time now, FrameOutbox& out) noexcept
    TAPPET_REALTIME {
    at_target_ = at_target;
    at_limit_ = at_limit;
    const bool energised = state_ == DriveState::operation_enabled || state_ == DriveState::switched_on;
    if (energised && now - last_command_ > command_timeout)
        trip(wires::emergency_code::command_lost, now, out);
    if (state_ == DriveState::not_ready && node_.alive()) state_ = DriveState::switch_on_disabled; // 1
    if (!standing) return;
    if (state_ == DriveState::quick_stop_active) state_ = DriveState::switch_on_disabled; // 12
    if (state_ == DriveState::fault_reaction_active) state_ = DriveState::fault;          // 14
}

void Drive::trip(std::uint16_t code, Time now, FrameOutbox& out) noexcept TAPPET_REALTIME {
    if (state_ == DriveState::fault_reaction_active || state_ == DriveState::fault) return;
    state_ = DriveState::fault_reaction_active; // 13
    ++faults_;
    send_emergency(code, now, out);
}

void Drive::restart() noexcept TAPPET_REALTIME {
    state_ = DriveState::not_ready;
    controlword_ = 0;
    target_ = 0;
}

void Drive::send_status(std::int32_t actual, Time due, FrameOutbox& out) const noexcept TAPPET_REALTIME {
    out.push({FrameWriter(wires::cob::main_drive_status - wires::node::main_drive + node_.id())
                  .u16(statusword())
                  .i32(actual)
                  .frame(),
              due});
}

void Drive::send_emergency(std::uint16_t code, Time now, FrameOutbox& out) const noexcept TAPPET_REALTIME {
    if (!node_.alive()) return;
    // Error register (1001h): bit 0 generic, bit 4 communication; both clear when all errors are gone.
    const std::uint8_t reg = code == 0                     ? std::uint8_t{0}
                             : (code & 0xF000u) == 0x8000u ? std::uint8_t{0x11}
                                                           : std::uint8_t{0x01};
    out.push({FrameWriter(wires::cob::emergency + node_.id()).u16(code).u8(reg).u32(0).u8(0).frame(), now});
}

} // namespace tappet::loom
