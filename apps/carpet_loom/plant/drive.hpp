// A velocity drive of the loom without its motor: a CiA 402 automaton that supervises itself, its process
// data and its emergency messages.
#pragma once

#include "apps/carpet_loom/plant/node.hpp"
#include "drivers/canopen/simulated_drive.hpp"

namespace tappet::loom {

using canopen::DriveState;
using Power = canopen::SimulatedDrive::Power;

class Drive {
public:
    Drive(std::uint8_t id, int velocity_per_rpm, Random& random) noexcept TAPPET_REALTIME
        : node_(id, random),
          velocity_per_rpm_(velocity_per_rpm) {}

    [[nodiscard]] canopen::SimulatedNode& node() noexcept TAPPET_REALTIME { return node_; }
    [[nodiscard]] const canopen::SimulatedNode& node() const noexcept TAPPET_REALTIME { return node_; }
    [[nodiscard]] DriveState state() const noexcept TAPPET_REALTIME { return drive_.state(); }
    [[nodiscard]] Power power() const noexcept TAPPET_REALTIME {
        return node_.alive() ? drive_.power() : Power::off;
    }
    [[nodiscard]] std::uint16_t statusword() const noexcept TAPPET_REALTIME;
    /// Returns the target velocity in the unit of the wire.
    [[nodiscard]] std::int32_t target() const noexcept TAPPET_REALTIME { return target_; }
    [[nodiscard]] std::uint64_t faults() const noexcept TAPPET_REALTIME { return faults_; }

    /// Handles a received command.
    void command(Time now, Wire& wire) noexcept TAPPET_REALTIME;
    /// Runs supervision and automatic transitions, given the motor's standstill, target and limit.
    void supervise(bool standing, bool at_target, bool at_limit, Time now, Wire& wire) noexcept
        TAPPET_REALTIME;
    void trip(std::uint16_t code, Time now, Wire& wire) noexcept TAPPET_REALTIME;
    /// Handles power-up or NMT reset node.
    void restart() noexcept TAPPET_REALTIME;
    /// Sends its process data when due.
    void send_status(double actual_rpm, Wire& wire) noexcept TAPPET_REALTIME;

private:
    void send_emergency(std::uint16_t code, Time now, Wire& wire) noexcept TAPPET_REALTIME;

    Node<canopen::dictionary<files::drive_eds>> node_;
    int velocity_per_rpm_;
    canopen::SimulatedDrive drive_;
    std::int32_t target_ = 0;
    Time last_command_{};
    bool at_target_ = false;
    bool at_limit_ = false;
    std::uint64_t faults_ = 0;
};

} // namespace tappet::loom
