// The state diagram of an axis (PLCopen, Function blocks for motion control, part 1, 2.1): its modes, and the
// commands that each mode accepts.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/type_tag.hpp"
#include "kernel/motion/refused.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <initializer_list>
#include <string_view>

namespace tappet::motion {

enum class AxisMode : std::uint8_t {
    disabled,            ///< power off
    standstill,          ///< power on, accepts any motion
    homing,              ///< searches for its reference
    discrete_motion,     ///< moves to a position
    continuous_motion,   ///< moves at a speed, until another command
    synchronized_motion, ///< follows a master
    stopping,            ///< decelerates to rest; accepts no motion until the stop is released
    error_stop           ///< a fault: only a reset leaves it
};

/// Commands to an axis, and events. The last five have no function block of their own.
enum class AxisCommand : std::uint8_t {
    power_on,    ///< MC_Power, Enable
    power_off,   ///< MC_Power, not Enable
    home,        ///< MC_Home
    move,        ///< MC_MoveAbsolute, MC_MoveRelative, MC_MoveAdditive
    move_on,     ///< MC_MoveVelocity, MC_TorqueControl
    superimpose, ///< MC_MoveSuperimposed: the present motion continues
    synchronize, ///< MC_GearIn, MC_CamIn
    release,     ///< MC_GearOut, MC_CamOut
    halt,        ///< MC_Halt
    stop,        ///< MC_Stop
    reset,       ///< MC_Reset of a powered axis
    done,        ///< the motion has ended; of a stop, also that it was released
    error        ///< a fault was found
};

namespace detail {

struct AxisRow {
    AxisCommand command;
    std::uint8_t from; ///< one bit for each mode
    AxisMode to;
};

consteval std::uint8_t any_of(std::initializer_list<AxisMode> modes) {
    unsigned bits = 0;
    for (const AxisMode mode : modes) bits |= 1U << static_cast<unsigned>(mode);
    return static_cast<std::uint8_t>(bits);
}

inline constexpr auto axis_rows = [] {
    using enum AxisMode;
    using enum AxisCommand;
    constexpr auto moves = any_of({discrete_motion, continuous_motion, synchronized_motion});
    constexpr auto takes_motion =
        any_of({standstill, discrete_motion, continuous_motion, synchronized_motion});
    constexpr auto powered =
        any_of({standstill, homing, discrete_motion, continuous_motion, synchronized_motion, stopping});
    return std::array{
        AxisRow{power_on, any_of({disabled}), standstill},
        AxisRow{power_off, powered, disabled},
        AxisRow{home, any_of({standstill}), homing},
        AxisRow{move, takes_motion, discrete_motion},
        AxisRow{move_on, takes_motion, continuous_motion},
        AxisRow{superimpose, any_of({standstill, discrete_motion}), discrete_motion},
        AxisRow{superimpose, any_of({continuous_motion}), continuous_motion},
        AxisRow{superimpose, any_of({synchronized_motion}), synchronized_motion},
        AxisRow{synchronize, takes_motion, synchronized_motion},
        AxisRow{release, any_of({synchronized_motion}), continuous_motion},
        AxisRow{halt, moves, discrete_motion},
        AxisRow{stop, any_of({standstill, homing, discrete_motion, continuous_motion, synchronized_motion}),
                stopping},
        AxisRow{reset, any_of({error_stop}), standstill},
        AxisRow{done, any_of({homing, discrete_motion, stopping}), standstill},
        AxisRow{error,
                any_of({disabled, standstill, homing, discrete_motion, continuous_motion, synchronized_motion,
                        stopping, error_stop}),
                error_stop},
    };
}();

} // namespace detail

/// Returns the mode after the command. Refused: this mode does not accept it. Real-time.
constexpr std::expected<AxisMode, Refused> after(AxisMode mode, AxisCommand command) noexcept
    TAPPET_REALTIME {
    for (const detail::AxisRow& row : detail::axis_rows)
        if (row.command == command && mode <= AxisMode::error_stop &&
            (row.from >> static_cast<unsigned>(mode) & 1U) != 0)
            return row.to;
    return std::unexpected(Refused{Refusal::wrong_state});
}

} // namespace tappet::motion

template <>
inline constexpr auto tappet::names_of<tappet::motion::AxisMode> =
    std::array<std::string_view, 8>{"Disabled",         "Standstill",         "Homing",   "DiscreteMotion",
                                    "ContinuousMotion", "SynchronizedMotion", "Stopping", "ErrorStop"};

namespace tappet::motion {

/// Returns the name in PLCopen's spelling.
constexpr std::string_view to_text(AxisMode mode) noexcept TAPPET_REALTIME {
    return mode <= AxisMode::error_stop ? names_of<AxisMode>[static_cast<std::size_t>(mode)] : "?";
}

} // namespace tappet::motion
