// The robot that operates on one page: the same arm loop as the other robot's, and above it the tool's loop,
// which locates the body by a camera and superimposes its motion on the tool's path.
#pragma once

#include "apps/two_robots/controllers.hpp"
#include "apps/two_robots/k361/behaviour.hpp"
#include "apps/two_robots/kinematics.hpp"
#include "apps/two_robots/tool/camera.hpp"
#include "apps/two_robots/tool/superposition.hpp"
#include "apps/two_robots/wires.hpp"
#include "drivers/can/restarter.hpp"
#include "drivers/udp/peer_clock.hpp"
#include "kernel/control/control.hpp"
#include "kernel/machine/table/compiled.hpp"
#include "kernel/machine/table/machine.hpp"
#include "kernel/services/browsing/browser_service.hpp"
#include "kernel/services/interpreter/command_interpreter.hpp"
#include "kernel/services/reporting/reporting.hpp"

namespace two_robots::k361 {

// clang-format off
// Actuators 1, 4 and 6 turn opposite to their joints.
inline constexpr auto counts_per_rad = counts_of({-94.14706, -103.23529, 51.44118, -175.0, 150.0, -131.64395});
inline constexpr std::array<double, 6> volts_per_rate{-2.5545, 2.678, 1.3735, -2.343, 2.0058, -1.7573};
inline constexpr std::array<double, 6> switch_angles{2.8, 1.8, 2.5, 2.9, 2.9, 2.9}; // near the ends, rad
inline constexpr std::array<double, 6> lowest{-2.9, -1.5, -2.6, -3.0, -2.9, -3.0}, highest{2.9, 1.9, 2.6, 3.0, 2.9, 3.0};
inline constexpr std::array<double, 6> ready{-1.499489, 0.144280, 1.621569, -0.901580, 1.480277, -0.597909}; // the tip above the chest, beside the hole

inline constexpr auto table = machine("k361",
    components(
        component<can::Bus<robot_signals>>("can", device("robot-can")),
        component<gpio::LinePort<robot_lines>>("io", device("robot-io")),
        component<ChainSwitch>("mode"),
        component<ChainSwitch>("geometry"), component<K361Kinematics>("kinematics"),
        component<MeasuredKinematics<ConeWrist>>("measured", set("l1", 1.020), set("l2", 0.480), set("l3", 0.645), set("l6", 0.120), properties_file("measured.cpf", optional)),
        component<JointSensor>("joints", set<counts_per_rad>("counts_per_rad"), set("absolute", true)),
        component<Idle>("idle"), component<Standing>("standing"), component<Turning>("turning"), component<Twisting>("twisting"),
        component<JointPath>("path", set<ready>("ready"), properties_file("path.cpf", optional)), component<Cartesian>("cartesian"),
        component<JointPid>("pid", set("kp", 2.0), set<lowest>("lowest"), set<highest>("highest"), properties_file("pid.cpf", optional)),
        component<JointFeedForward>("forward", set("kp", 10.0), set<lowest>("lowest"), set<highest>("highest"), properties_file("forward.cpf", optional)),
        component<JointEffector>("drives", set<volts_per_rate>("volts_per_rate"), properties_file("drives.cpf", optional)),
        component<Robot>("robot"),
        component<LedCamera>("camera", device("camera-link"), set("latency", 61ms)),
        component<ChainSwitch>("estimation"), component<BodyEstimator>("body"), component<KalmanBodyEstimator>("body_kalman"),
        component<Replay>("replay", set("tool_length", 0.40), properties_file("replay.cpf", optional)),
        component<Superposition>("superposition"),
        component<udp::PeerClock>("body_clock", device("body-time")), // clock of the robot that holds the body
        component<can::Restarter>("restarter", device("robot-can")),
        component<BrowserService>("browser"), component<CommandInterpreter>("interpreter")),
    activities( // threads; their priorities follow from the deadlines
        activity("can",  on_device("can"), at_most(8, 2ms), runs("can"), deadline(400us), budget(30us)),
        activity("tool", every(servo_period),                            deadline(900us), budget(200us),
            runs("estimation", "camera", "body", "body_kalman", "replay", "superposition")),
        activity("loop", every(servo_period, phase(1ms)),                deadline(1500us), budget(200us),
            runs("mode", "geometry", "kinematics", "measured", "joints", "idle", "standing", "turning", "twisting", "path", "cartesian", "pid", "forward", "drives", "robot")),
        activity("io",        on_device("io"), at_most(8, 2ms), runs("io"), deadline(1ms), budget(30us)),
        activity("clock",     every(servo_period), runs("body_clock"), deadline(1900us), budget(60us)),
        activity("restarter", every(100ms), not_real_time, runs("restarter")),
        activity("browser",   every(20ms),  not_real_time, runs("browser", "interpreter"), stack(224 * 1024))),
    connections( // data flow
        data("can.encoders_a.joint_1", "joints.counts_1", stale_after(20ms), hold), data("can.encoders_a.joint_2", "joints.counts_2", stale_after(20ms), hold),
        data("can.encoders_b.joint_3", "joints.counts_3", stale_after(20ms), hold), data("can.encoders_b.joint_4", "joints.counts_4", stale_after(20ms), hold),
        data("can.encoders_c.joint_5", "joints.counts_5", stale_after(20ms), hold), data("can.encoders_c.joint_6", "joints.counts_6", stale_after(20ms), hold),
        // the arm's loop
        data("joints.positions", "idle.positions"),      data("drives.sent", "idle.sent",      delayed),
        data("joints.positions", "standing.positions"),  data("drives.sent", "standing.sent",  delayed),
        data("joints.positions", "turning.positions"),   data("drives.sent", "turning.sent",   delayed),
        data("joints.positions", "twisting.positions"),  data("drives.sent", "twisting.sent",  delayed),
        data("joints.positions", "path.positions"),      data("drives.sent", "path.sent",      delayed),
        data("joints.positions", "cartesian.positions"), data("drives.sent", "cartesian.sent", delayed),
        data("idle.target",      "forward.target"), data("idle.rate",      "forward.rate"),
        data("standing.target",  "forward.target"), data("standing.rate",  "forward.rate"),
        data("turning.target",   "forward.target"), data("turning.rate",   "forward.rate"),
        data("twisting.target",  "forward.target"), data("twisting.rate",  "forward.rate"),
        data("path.target",      "forward.target"), data("path.rate",      "forward.rate"),
        data("cartesian.target", "forward.target"), data("cartesian.rate", "forward.rate"),
        data("path.target",      "pid.target"),     data("path.rate",      "pid.rate"),
        data("joints.positions", "forward.positions"), data("drives.sent", "forward.sent", delayed),
        data("joints.positions", "pid.positions"),     data("drives.sent", "pid.sent",     delayed),
        data("joints.calibrated", "forward.calibrated"), data("joints.calibrated", "pid.calibrated"),
        data("forward.wanted", "drives.wanted"), data("pid.wanted", "drives.wanted"),
        data("drives.volts_1", "can.drives_a.joint_1", stale_after(10ms), substitute(0.0)), data("drives.volts_2", "can.drives_a.joint_2", stale_after(10ms), substitute(0.0)),
        data("drives.volts_3", "can.drives_a.joint_3", stale_after(10ms), substitute(0.0)), data("drives.volts_4", "can.drives_b.joint_4", stale_after(10ms), substitute(0.0)),
        data("drives.volts_5", "can.drives_b.joint_5", stale_after(10ms), substitute(0.0)), data("drives.volts_6", "can.drives_b.joint_6", stale_after(10ms), substitute(0.0)),
        data("drives.enable", "io.enable", wakes, stale_after(50ms), substitute(false)), data("drives.release", "io.release", wakes, stale_after(50ms), substitute(false)),
        // the tool's loop
        data("camera.leds", "body.leds", stale_after(300ms), hold), data("camera.leds", "body_kalman.leds", stale_after(300ms), hold), // age since their exposure
        data("body.model", "body_kalman.before", stale_after(10ms), hold), data("body_kalman.model", "body.before", stale_after(10ms), hold, delayed),
        data("body.model", "replay.model", stale_after(10ms), hold), data("body.model", "superposition.model", stale_after(10ms), hold),
        data("body_kalman.model", "replay.model", stale_after(10ms), hold), data("body_kalman.model", "superposition.model", stale_after(10ms), hold),
        data("joints.positions", "replay.positions", stale_after(20ms), hold),
        data("replay.set_point", "superposition.set_point", stale_after(10ms), hold),
        data("superposition.command", "cartesian.command", stale_after(10ms), hold), // when stale, the arm stands still
        data("can.faulted", "restarter.faulted")),
    reactions( // execution flow
        uses("cartesian.posture", "kinematics.posture"), uses("twisting.posture", "kinematics.posture"), uses("replay.posture", "kinematics.posture"),
        uses("cartesian.posture", "measured.posture"),   uses("twisting.posture", "measured.posture"),   uses("replay.posture", "measured.posture"),
        when("io.start.rises", tell("robot.press_start")), when("io.ready.rises", tell("robot.press_ready")),
        when("io.work.rises",  tell("robot.press_work")),  when("io.stop.rises",  tell("robot.press_stop"))),
    behaviours(behaviour("robot", compiled<states>, slot(nodes(160), data_bytes(1024), depth(1), command_slots(24), text_bytes(8000),
        peers("mode", "path", "drives", "replay"), events("mode.fell_back"),
        operations("mode.run", "path.go_ready", "drives.power_on", "drives.power_off", "replay.operate", "replay.withdraw", "replay.sees_body")))),
    control( // feedback, in cascade
        level("tool",
            sensor("camera"), estimator("body"), estimator("body_kalman"), generator("replay"), controller("superposition")),
        level("arm",
            sensor("joints"),
            generator("idle"), generator("standing"), generator("turning"), generator("twisting"), generator("path"), generator("cartesian"),
            controller("pid", tracks("sent")), controller("forward", tracks("sent")), effector("drives")),
        process("kinematics"), process("measured"), process("robot"),
        exclusive("mode",
            fallback("off",   "idle",      "forward"),
            chain("stand",    "standing",  "forward"),
            chain("turn",     "turning",   "forward"),
            chain("twist",    "twisting",  "forward"),
            chain("path",     "path",      "forward"),
            chain("path_pid", "path",      "pid"), // for comparison
            chain("tool",     "cartesian", "forward")),
        exclusive("estimation", fallback("alpha_beta", "body"), chain("kalman", "body_kalman")),
        exclusive("geometry", fallback("as_drawn", "kinematics"), chain("as_measured", "measured")), // callers of the posture notice nothing
        loop("joints by feed-forward", gain("forward.kp"), transport(14ms)), // wires and drives
        loop("joints by PID", gain("pid.kp"), transport(14ms))),
    reporting( // what tappet-browse report writes to files
        report("joints.positions", every(5)), report("drives.sent", every(5)), report("body.model", every(10)), report("body_kalman.model", every(10)), report("replay.set_point", every(10)), report("mode.chain", on_change()),
        report("body_clock.ahead", on_change()), report("body_clock.error", on_change())));
// clang-format on

} // namespace two_robots::k361
