// The process component that leads a robot (thesis fig. 3.10 b): turns people's requests into events of its
// state machine, which is a script.
#pragma once

#include "kernel/component/component.hpp"
#include "kernel/component/operation_interface.hpp"

namespace two_robots {

using namespace tappet;

/// Work means a moving body for one robot and an operation for the other: start_work is the thesis'
/// StartSimulation there, stop_work its StopSimulation. Real-time.
struct Robot {
    static constexpr bool behaviour_required = true;

    Event<> start_controller, move_ready, start_work, stop_work;

    bool do_start() noexcept TAPPET_REALTIME { return start_controller.emit(), true; }
    bool do_ready() noexcept TAPPET_REALTIME { return move_ready.emit(), true; }
    bool do_work() noexcept TAPPET_REALTIME { return start_work.emit(), true; }
    bool do_halt() noexcept TAPPET_REALTIME { return stop_work.emit(), true; }
    void press_start(Time) noexcept TAPPET_REALTIME { start_controller.emit(); }
    void press_ready(Time) noexcept TAPPET_REALTIME { move_ready.emit(); }
    void press_work(Time) noexcept TAPPET_REALTIME { start_work.emit(); }
    void press_stop(Time) noexcept TAPPET_REALTIME { stop_work.emit(); }

    // clang-format off
    static constexpr auto interface() {
        return facets(
            event<&Robot::start_controller>("start_controller", "power, and homing where it is needed"),
            event<&Robot::move_ready>("move_ready", "to where work begins"),
            event<&Robot::start_work>("start_work", "begins the robot's work"),
            event<&Robot::stop_work>("stop_work", "ends the robot's work"),
            command<&Robot::do_start>("start", "power, and homing where it is needed", for_people(Role::machine_operator, moves)),
            command<&Robot::do_ready>("ready", "to where work begins", for_people(Role::machine_operator, moves)),
            command<&Robot::do_work>("work", "begins the robot's work", for_people(Role::machine_operator, moves)),
            command<&Robot::do_halt>("halt", "ends the robot's work", for_people(Role::machine_operator)),
            operation<&Robot::press_start>("press_start", "a button at the machine"),
            operation<&Robot::press_ready>("press_ready", "a button at the machine"),
            operation<&Robot::press_work>("press_work", "a button at the machine"),
            operation<&Robot::press_stop>("press_stop", "a button at the machine"));
    }
    // clang-format on
};

} // namespace two_robots
