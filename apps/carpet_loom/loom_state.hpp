// The loom's status: its state, the cause of its last stop, and what it waits for, each with its names.
#pragma once

#include "kernel/base/type_tag.hpp"

#include <array>
#include <cstdint>
#include <string_view>

namespace tappet::carpet {

/// Names as in the state machine of loom_cycle.hpp.
enum class LoomState : std::int64_t {
    off,
    locked,
    preparing,
    ready,
    run_up,
    weave,
    stopping,
    stopped,
    emergency,
    fault,
    safe
};
enum class StopCause : std::int64_t { none, weft, warp, operator_stop, emergency, fault };
/// The first missing condition for a start.
enum class WaitsFor : std::int64_t {
    nothing,
    emergency_stop,
    can_nodes,
    encoder,
    main_drive,
    let_off_drive,
    oil_pressure,
    warp_tension,
    drop_wire,
    acknowledgement,
    bus,
    lines,
    machine_part,
    shaft_to_stand
};

} // namespace tappet::carpet

template <>
inline constexpr auto tappet::names_of<tappet::carpet::LoomState> =
    std::array<std::string_view, 11>{"off",      "locked",  "preparing", "ready", "run-up", "weave",
                                     "stopping", "stopped", "emergency", "fault", "safe"};
template <>
inline constexpr auto tappet::names_of<tappet::carpet::StopCause> =
    std::array<std::string_view, 6>{"none", "weft", "warp", "operator", "emergency", "fault"};
template <>
inline constexpr auto tappet::names_of<tappet::carpet::WaitsFor> =
    std::array<std::string_view, 14>{"nothing",      "emergency-stop",  "can-nodes",    "encoder",
                                     "main-drive",   "let-off-drive",   "oil-pressure", "warp-tension",
                                     "drop-wire",    "acknowledgement", "bus",          "lines",
                                     "machine-part", "shaft-to-stand"};

namespace tappet::carpet {

template <class E> constexpr std::string_view name_of(E value) noexcept {
    const auto index = static_cast<std::size_t>(value);
    return index < names_of<E>.size() ? names_of<E>[index] : "?";
}

} // namespace tappet::carpet
