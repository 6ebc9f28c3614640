// The wires between the carpet loom's machine and the loom: the contents of each CAN identifier and GPIO
// line, and the loom's nominal figures. The machine's maps and the plant use the same numbers.
#pragma once

#include "kernel/base/time.hpp"

#include <cstdint>

namespace tappet::loom::wires {

// --- CANopen, 1 Mbit/s, 11-bit identifiers, little-endian (CiA 301); the nodes' objects are in nodes/*.eds

namespace node {
inline constexpr std::uint8_t main_drive = 1;    // CiA 402, velocity
inline constexpr std::uint8_t let_off_drive = 2; // CiA 402, velocity
inline constexpr std::uint8_t encoder = 3;       // CiA 406
inline constexpr std::uint8_t load_cell = 4;     // CiA 404
inline constexpr std::uint8_t feeder = 5;        // CiA 414-2
inline constexpr std::uint8_t dobby = 6;         // CiA 414
inline constexpr std::uint8_t count = 6;
inline constexpr std::uint8_t machine = 127; // the network's manager
} // namespace node

namespace cob {
// To the loom (RPDO).
inline constexpr std::uint32_t main_drive_command = 0x201; // {controlword u16, target velocity i32 0.1 rpm}
inline constexpr std::uint32_t let_off_drive_command =
    0x202;                                             // {controlword u16, target velocity i32 0.001 rpm}
inline constexpr std::uint32_t feeder_command = 0x205; // {selected colour u8, speed u16 windings/min}
inline constexpr std::uint32_t dobby_command = 0x206;  // {pick number u32, pattern bits u16}

// From the loom (TPDO).
inline constexpr std::uint32_t main_drive_status = 0x181; // {statusword u16, actual velocity i32 0.1 rpm}
inline constexpr std::uint32_t let_off_drive_status =
    0x182;                                                // {statusword u16, actual velocity i32 0.001 rpm}
inline constexpr std::uint32_t encoder_position = 0x183;  // {position u16 code, sample counter u16}
inline constexpr std::uint32_t load_cell_tension = 0x184; // {tension i16 0.1 N, status u8}
inline constexpr std::uint32_t feeder_status = 0x185;     // {status u8, windings in stock u16}
inline constexpr std::uint32_t dobby_status = 0x186;      // {pick number taken u32, level u8}; on change
} // namespace cob

inline constexpr Duration encoder_period = 1ms; // from the encoder's own clock
inline constexpr Duration load_cell_period = 1ms;
inline constexpr Duration drive_status_period = 2ms;
inline constexpr Duration feeder_status_period = 10ms;
inline constexpr Duration heartbeat_period = 100ms;
inline constexpr Duration drive_command_timeout = 100ms; // an enabled drive stops itself after this silence

inline constexpr int encoder_codes_per_turn = 4096;
inline constexpr int main_velocity_per_rpm = 10;
inline constexpr int let_off_velocity_per_rpm = 1'000;
inline constexpr int tension_per_n = 10;

namespace load_cell_bit {
inline constexpr std::uint8_t valid = 0x01;
inline constexpr std::uint8_t overload = 0x02;
} // namespace load_cell_bit
namespace feeder_bit {
inline constexpr std::uint8_t ready = 0x01;
inline constexpr std::uint8_t empty = 0x02;
} // namespace feeder_bit

namespace emergency_code { // CiA 402
inline constexpr std::uint16_t over_current = 0x2310;
inline constexpr std::uint16_t motor_blocked = 0x7121;
inline constexpr std::uint16_t command_lost = 0x8130;
} // namespace emergency_code

// --- GPIO, chip "loom-io": offsets

namespace line {
// Inputs of the machine.
inline constexpr unsigned emergency_stop = 0; // 1 = pressed (the opened circuit, inverted at the wire)
inline constexpr unsigned drop_wire = 1; // 1 = a drop wire has fallen; stays until the operator repaired it
inline constexpr unsigned weft_detector = 2; // a pulse of weft_pulse when a weft arrives
inline constexpr unsigned button_start = 3;
inline constexpr unsigned button_stop = 4;
inline constexpr unsigned button_acknowledge = 5;
inline constexpr unsigned input_count = 6;
// Outputs of the machine.
inline constexpr unsigned weft_release = 8; // solenoid valve: opens one dead time after the rising edge
inline constexpr unsigned brake = 9;        // electromagnetic: holds one dead time after the rising edge
inline constexpr unsigned lamp_run = 10;    // the loom runs
inline constexpr unsigned lamp_stop = 11;   // the loom stands, prepared: the operator may press start
inline constexpr unsigned lamp_fault = 12;  // something waits for repair and acknowledgement
inline constexpr unsigned yarn_cutter = 13;
inline constexpr unsigned first_output = 8;
inline constexpr unsigned output_count = 6;
inline constexpr unsigned chip_lines = 14;
} // namespace line

inline constexpr Duration weft_pulse = 3ms;

// --- Nominal figures of the loom, from its maker's data sheet

namespace nominal {
inline constexpr double speed_rpm = 600.0;
inline constexpr double weft_release_deg = 80.0; // the valve's effect is wanted here
inline constexpr double weft_arrival_deg = 240.0;
inline constexpr double weft_window_begin_deg = 215.0; // slow turns of a run-up arrive earlier
inline constexpr double weft_window_end_deg = 250.0;
inline constexpr double stop_deg = 310.0; // harnesses level, least warp tension
inline constexpr double stop_tolerance_deg = 10.0;
inline constexpr double shed_open_deg = 60.0;
inline constexpr double shed_closed_deg = 300.0;
inline constexpr Duration weft_release_dead = 2500us;
inline constexpr Duration brake_dead = 8ms;
inline constexpr double brake_distance_deg = 49.0; // from the line's edge to standstill, at speed_rpm
inline constexpr double tension_n = 300.0;
inline constexpr double tension_band_n = 30.0;
inline constexpr double pick_spacing_mm = 2.0;  // take-up of one turn
inline constexpr double beam_radius_mm = 400.0; // of a full warp beam
inline constexpr double oil_pressure_bar = 2.5;
inline constexpr double oil_pressure_least_bar = 1.0; // below it the loom must not run
inline constexpr int windings_per_pick = 2;

static_assert(stop_deg - brake_distance_deg > weft_window_end_deg,
              "a weft that is missing at the window's end must still leave room to brake to stop_deg");
} // namespace nominal

} // namespace tappet::loom::wires
