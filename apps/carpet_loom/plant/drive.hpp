// A velocity drive after CiA 402: its state machine, its process data and its emergency messages. Not its
// motor.
#pragma once

#include "apps/carpet_loom/plant/node.hpp"

namespace tappet::loom {

enum class DriveState : std::uint8_t {
    not_ready,
    switch_on_disabled,
    ready_to_switch_on,
    switched_on,
    operation_enabled,
    quick_stop_active,
    fault_reaction_active,
    fault,
};

/// What the power stage does with the motor.
enum class Power : std::uint8_t { off, follow, stop };

/// Quick stop option code (605Ah) 2: brake, then switch on disabled. Fault reaction: brake, then fault.
class Drive {
public:
    Drive(std::uint8_t id, Random& random) noexcept TAPPET_REALTIME
        : node_(id, wires::drive_status_period_us, random) {}

    [[nodiscard]] Node& node() noexcept TAPPET_REALTIME { return node_; }
    [[nodiscard]] const Node& node() const noexcept TAPPET_REALTIME { return node_; }
    [[nodiscard]] DriveState state() const noexcept TAPPET_REALTIME { return state_; }
    [[nodiscard]] Power power() const noexcept TAPPET_REALTIME;
    [[nodiscard]] std::uint16_t statusword() const noexcept TAPPET_REALTIME;
    /// In the unit of the wire.
    [[nodiscard]] std::int32_t target() const noexcept TAPPET_REALTIME { return target_; }
    [[nodiscard]] std::uint64_t faults() const noexcept TAPPET_REALTIME { return faults_; }

    /// The RPDO. A frame too short is refused with an emergency message and otherwise ignored.
    void command(const CanFrame& frame, Time now, FrameOutbox& out) noexcept TAPPET_REALTIME;
    /// Supervision and automatic transitions; the motor stands or not, follows its target or not.
    void supervise(bool standing, bool at_target, bool at_limit, Time now, FrameOutbox& out) noexcept
        TAPPET_REALTIME;
    void trip(std::uint16_t code, Time now, FrameOutbox& out) noexcept TAPPET_REALTIME;
    /// Power-up or NMT reset node.
    void restart() noexcept TAPPET_REALTIME;
    void send_status(std::int32_t actual, Time due, FrameOutbox& out) const noexcept TAPPET_REALTIME;

private:
    void control(std::uint16_t word) noexcept TAPPET_REALTIME;
    void send_emergency(std::uint16_t code, Time now, FrameOutbox& out) const noexcept TAPPET_REALTIME;

    Node node_;
    DriveState state_ = DriveState::not_ready;
    std::uint16_t controlword_ = 0;
    std::int32_t target_ = 0;
    Time last_command_{};
    bool at_target_ = false;
    bool at_limit_ = false;
    std::uint64_t faults_ = 0;
};

} // namespace tappet::loom
