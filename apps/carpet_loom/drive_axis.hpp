// The common part of the loom's two CiA 402 drives: leads them to their goal each cycle and reports enabled
// and fault on change.
#pragma once

#include "drivers/canopen/cia402.hpp"
#include "kernel/component/port.hpp"
#include "kernel/pieces/changed.hpp"

namespace tappet::carpet {

/// A part of a component; real-time.
class DriveAxis {
public:
    void enable() noexcept TAPPET_REALTIME {
        control_.want(canopen::DriveGoal::enabled);
        control_.acknowledge();
    }
    void disable() noexcept TAPPET_REALTIME { control_.want(canopen::DriveGoal::off); }
    void quick_stop() noexcept TAPPET_REALTIME { control_.want(canopen::DriveGoal::quick_stop); }

    /// Runs a cycle from the statusword to the controlword. Returns true when the drive follows its target.
    bool lead(Input<std::int64_t>& statusword, Output<std::int64_t>& controlword, Output<bool>& enabled,
              Output<bool>& fault) noexcept TAPPET_REALTIME {
        const bool heard = statusword.good();
        const auto status = static_cast<std::uint16_t>(statusword.get());
        const canopen::DriveState state = canopen::drive_state(status);
        const bool follows = heard && state == canopen::DriveState::operation_enabled;
        controlword.write(heard ? control_.controlword(status) : canopen::controlword::disable_voltage);
        fault_.write(fault, !heard || state == canopen::DriveState::fault ||
                                state == canopen::DriveState::fault_reaction_active);
        enabled_.write(enabled, follows);
        return follows;
    }
    /// Forgets all earlier requests: the drive moves only when it is asked again.
    void start(Output<std::int64_t>& controlword, Output<double>& target) noexcept TAPPET_REALTIME {
        control_ = {};
        controlword.write(canopen::controlword::disable_voltage);
        target.write(0.0);
    }
    /// Writes the last commands of a component that stops; after that nobody leads the drive.
    void stop(Output<std::int64_t>& controlword, Output<double>& target, Output<bool>& enabled,
              Output<bool>& fault) noexcept TAPPET_REALTIME {
        controlword.write(canopen::controlword::quick_stop);
        target.write(0.0);
        fault_.write(fault, true);
        enabled_.write(enabled, false);
    }

private:
    canopen::DriveControl control_{};
    Changed<bool> enabled_, fault_;
};

} // namespace tappet::carpet
