// The robot that holds the body on one page. Its encoders are relative, so it first finds its zeros; then it
// breathes.
#pragma once

#include "apps/two_robots/controllers.hpp"
#include "apps/two_robots/k160/behaviour.hpp"
#include "apps/two_robots/kinematics.hpp"
#include "apps/two_robots/wires.hpp"
#include "drivers/can/restarter.hpp"
#include "drivers/udp/peer_clock.hpp"
#include "kernel/control/control.hpp"
#include "kernel/machine/table/compiled.hpp"
#include "kernel/machine/table/machine.hpp"
#include "kernel/services/browsing/browser_service.hpp"
#include "kernel/services/interpreter/command_interpreter.hpp"

namespace two_robots::k160 {

// clang-format off
// All actuators turn opposite to their joints.
inline constexpr auto counts_per_rad = counts_of({-120.0 * 114 * 106 * 100 / (30 * 40 * 48 * 14), -168.0 * 139 * 111 / (28 * 37 * 15),
                                                       -168.0 * 125 * 106 / (28 * 41 * 15), -150.857, -155.17, -100.0});
inline constexpr std::array<double, 6> volts_per_rate{-2.5, -2.5, -2.5, -2.0, -2.0, -2.0};
inline constexpr std::array<double, 6> switch_angles{0.35, 0.30, -0.25, 0.40, -0.30, 0.45}; // rad
inline constexpr std::array<double, 6> lowest{-2.9, -1.2, -2.6, -3.0, -2.1, -3.0}, highest{2.9, 1.9, 2.6, 3.0, 2.1, 3.0};
// The dummy's chest faces up, its hole is 0.75 m above the floor and 0.75 m from the other robot's axis.
inline constexpr std::array<double, 6> ready{1.570796, -0.605327, -2.035991, 0.0, 1.070521, 1.570796};
inline constexpr std::array<double, 3> breath_direction{0.0, 0.8, 0.6};

inline constexpr auto table = machine("k160",
    components(
        component<can::Bus<robot_signals>>("can", device("robot-can")),
        component<gpio::LinePort<robot_lines>>("io", device("robot-io")),
        component<ChainSwitch>("mode"),
        component<K160Kinematics>("kinematics"),
        component<JointSensor>("joints", set<counts_per_rad>("counts_per_rad")),
        component<Homing>("homing", set<switch_angles>("switch_angles"), properties_file("homing.cpf", optional)),
        component<Idle>("idle"), component<Standing>("standing"), component<Turning>("turning"), component<JointPath>("path", set<ready>("ready"), properties_file("path.cpf", optional)),
        component<BodySimulation>("breath", set<breath_direction>("direction"), properties_file("breath.cpf", optional)),
        component<JointPid>("pid", set("kp", 2.0), set<lowest>("lowest"), set<highest>("highest"), properties_file("pid.cpf", optional)),
        component<JointFeedForward>("forward", set("kp", 10.0), set<lowest>("lowest"), set<highest>("highest"), properties_file("forward.cpf", optional)),
        component<JointEffector>("drives", set<volts_per_rate>("volts_per_rate"), properties_file("drives.cpf", optional)),
        component<Robot>("robot"),
        component<udp::ClockAnswers>("time", device("time-port")),
        component<can::Restarter>("restarter", device("robot-can")),
        component<BrowserService>("browser"), component<CommandInterpreter>("interpreter")),
    activities( // threads; their priorities follow from the deadlines
        activity("can",  on_device("can"), at_most(8, 2ms), runs("can"), deadline(400us), budget(30us)),
        activity("loop", every(servo_period, phase(1ms)),                deadline(1500us), budget(200us),
            runs("mode", "kinematics", "joints", "homing", "idle", "standing", "turning", "path", "breath", "pid", "forward", "drives", "robot")),
        activity("io",        on_device("io"), at_most(8, 2ms), runs("io"), deadline(1ms), budget(30us)),
        activity("clock",     every(servo_period), runs("time"), deadline(1900us), budget(60us)),
        activity("restarter", every(100ms), not_real_time, runs("restarter")),
        activity("browser",   every(20ms),  not_real_time, runs("browser", "interpreter"), stack(224 * 1024))),
    connections( // data flow
        data("can.encoders_a.joint_1", "joints.counts_1", stale_after(20ms), hold), data("can.encoders_a.joint_2", "joints.counts_2", stale_after(20ms), hold),
        data("can.encoders_b.joint_3", "joints.counts_3", stale_after(20ms), hold), data("can.encoders_b.joint_4", "joints.counts_4", stale_after(20ms), hold),
        data("can.encoders_c.joint_5", "joints.counts_5", stale_after(20ms), hold), data("can.encoders_c.joint_6", "joints.counts_6", stale_after(20ms), hold),
        data("joints.positions", "idle.positions"),     data("drives.sent", "idle.sent",     delayed),
        data("joints.positions", "standing.positions"), data("drives.sent", "standing.sent", delayed),
        data("joints.positions", "turning.positions"),  data("drives.sent", "turning.sent",  delayed),
        data("joints.positions", "path.positions"),     data("drives.sent", "path.sent",     delayed),
        data("joints.positions", "breath.positions"),   data("drives.sent", "breath.sent",   delayed),
        data("idle.target",     "forward.target"), data("idle.rate",     "forward.rate"),
        data("standing.target", "forward.target"), data("standing.rate", "forward.rate"),
        data("turning.target",  "forward.target"), data("turning.rate",  "forward.rate"),
        data("path.target",     "forward.target"), data("path.rate",     "forward.rate"),
        data("breath.target",   "forward.target"), data("breath.rate",   "forward.rate"),
        data("path.target",     "pid.target"),     data("path.rate",     "pid.rate"),
        data("joints.positions", "forward.positions"), data("drives.sent", "forward.sent", delayed),
        data("joints.positions", "pid.positions"),     data("drives.sent", "pid.sent",     delayed),
        data("forward.wanted", "drives.wanted"), data("pid.wanted", "drives.wanted"),
        data("joints.calibrated", "forward.calibrated"), data("joints.calibrated", "pid.calibrated"),
        data("drives.volts_1", "can.drives_a.joint_1", stale_after(10ms), substitute(0.0)), data("drives.volts_2", "can.drives_a.joint_2", stale_after(10ms), substitute(0.0)),
        data("drives.volts_3", "can.drives_a.joint_3", stale_after(10ms), substitute(0.0)), data("drives.volts_4", "can.drives_b.joint_4", stale_after(10ms), substitute(0.0)),
        data("drives.volts_5", "can.drives_b.joint_5", stale_after(10ms), substitute(0.0)), data("drives.volts_6", "can.drives_b.joint_6", stale_after(10ms), substitute(0.0)),
        data("drives.enable", "io.enable", wakes, stale_after(50ms), substitute(false)), data("drives.release", "io.release", wakes, stale_after(50ms), substitute(false)),
        data("joints.positions", "homing.positions"),
        data("io.switch_1", "homing.switch_1"), data("io.switch_2", "homing.switch_2"), data("io.switch_3", "homing.switch_3"),
        data("io.switch_4", "homing.switch_4"), data("io.switch_5", "homing.switch_5"), data("io.switch_6", "homing.switch_6"),
        data("can.faulted", "restarter.faulted")),
    reactions( // execution flow
        uses("homing.turn", "turning.turn"), uses("homing.calibrate", "joints.calibrate"),
        uses("breath.posture", "kinematics.posture"),
        when("io.start.rises", tell("robot.press_start")), when("io.ready.rises", tell("robot.press_ready")),
        when("io.work.rises",  tell("robot.press_work")),  when("io.stop.rises",  tell("robot.press_stop"))),
    behaviours(behaviour("robot", compiled<states>, slot(nodes(160), data_bytes(1024), depth(2), command_slots(24), text_bytes(8000),
        peers("mode", "homing", "path", "drives"), events("mode.fell_back"),
        operations("mode.run", "homing.home", "homing.all_homed", "homing.forget", "path.go_ready", "path.is_ready", "drives.power_on", "drives.power_off")))),
    control( // feedback
        level("arm",
            sensor("joints"),
            generator("idle"), generator("standing"), generator("turning"), generator("path"), generator("breath"),
            controller("pid", tracks("sent")), controller("forward", tracks("sent")), effector("drives")),
        process("kinematics"), process("homing"), process("robot"),
        exclusive("mode",
            fallback("off",   "idle",     "forward"),
            chain("stand",    "standing", "forward"),
            chain("turn",     "turning",  "forward"),
            chain("path",     "path",     "forward"),
            chain("path_pid", "path",     "pid"), // for comparison
            chain("simulate", "breath",   "forward")),
        loop("joints by feed-forward", gain("forward.kp"), transport(14ms)), // wires and drives
        loop("joints by PID", gain("pid.kp"), transport(14ms))));
// clang-format on

} // namespace two_robots::k160
