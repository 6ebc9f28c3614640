// The control kernel as rows of the table (thesis 3.1): the roles of components, which of them run in turns,
// and the loops that they close.
//     control(
//         level("axis",
//             sensor("drive"), generator("holding"), generator("jogging"), controller("position",
//             tracks("sent")), effector("limiter")),
//         process("homing"),
//         exclusive("mode", fallback("stand", "holding"), chain("jog", "jogging")),
//         loop("position", gain("position.kp"), transport(2ms)))
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/row_option.hpp"
#include "kernel/base/time.hpp"

#include <cstdint>
#include <string_view>

namespace tappet {

/// The stereotypes of thesis 3.1.2.
enum class ControlRole : std::uint8_t { sensor, estimator, generator, controller, effector, process };

struct RoleRow {
    ControlRole role = ControlRole::process;
    std::string_view component{};
    std::string_view tracked{}; ///< of a Controller: the input that receives the value really sent
};

/// Delivers measured values of the hardware, in units of the application: the inputs of the control action.
constexpr RoleRow sensor(std::string_view component) noexcept { return {ControlRole::sensor, component, {}}; }
/// Computes the model from inputs, and from outputs of the step before.
constexpr RoleRow estimator(std::string_view component) noexcept {
    return {ControlRole::estimator, component, {}};
}
/// Computes set points from inputs, model, and the command of the level above.
constexpr RoleRow generator(std::string_view component) noexcept {
    return {ControlRole::generator, component, {}};
}
struct Tracks {
    std::string_view input{};
};
/// The input with the value that the Effector really sent in the step before: the Controller starts from it
/// without a bump, and its integral does not wind up behind the Effector's limits.
constexpr Tracks tracks(std::string_view input) noexcept { return {input}; }
/// Computes outputs from set points, inputs and model: those of its level's Effector, or the command of the
/// level below.
constexpr RoleRow controller(std::string_view component, Tracks tracked = {}) noexcept {
    return {ControlRole::controller, component, tracked.input};
}
/// Sends outputs to the hardware, within its limits.
constexpr RoleRow effector(std::string_view component) noexcept {
    return {ControlRole::effector, component, {}};
}
/// Reads all of the data flow and writes none of it: kinematics, homing, states of the whole machine. It
/// calls, is called, and may run in any activity.
constexpr RoleRow process(std::string_view component) noexcept {
    return {ControlRole::process, component, {}};
}

struct LevelRow {
    static constexpr std::size_t max_roles = 24;
    std::string_view name{};
    Bounded<RoleRow, max_roles> roles{};
    bool too_many = false;
};

/// One level of a cascade: components of one activity, executed once each period. Levels are listed from the
/// outermost to the innermost; outputs of a Controller are commands of the level below.
template <class... Roles>
constexpr LevelRow level(std::string_view name, const Roles&... roles) {
    LevelRow row{.name = name};
    ((row.too_many |= !row.roles.push(roles)), ...);
    return row;
}

struct ChainRow {
    static constexpr std::size_t max_members = 12;
    std::string_view name{};
    Bounded<std::string_view, max_members> members{};
    bool too_many = false;
    bool is_fallback = false;
};

/// Components of a level that run together, instead of those of the other chains.
template <class... Names>
constexpr ChainRow chain(std::string_view name, const Names&... members) {
    ChainRow row{.name = name};
    ((row.too_many |= !row.members.push(std::string_view{members})), ...);
    return row;
}
/// The chain that runs first, and again when a member of another chain has stopped, or reads a stale value
/// from another activity. When that happens to the fallback itself, the machine stops.
template <class... Names>
constexpr ChainRow fallback(std::string_view name, const Names&... members) {
    ChainRow row = chain(name, members...);
    row.is_fallback = true;
    return row;
}

struct ExclusiveRow {
    static constexpr std::size_t max_chains = 8;
    std::string_view by{}; ///< the component<ChainSwitch> that switches
    Bounded<ChainRow, max_chains> chains{};
    bool too_many = false;
};

/// Exactly one of the chains runs; `by` is a component<ChainSwitch>, the first in the level's activity.
template <class... Chains>
constexpr ExclusiveRow exclusive(std::string_view by, const Chains&... chains) {
    ExclusiveRow row{.by = by};
    ((row.too_many |= !row.chains.push(chains)), ...);
    return row;
}

struct LoopRow {
    std::string_view name{};
    std::string_view gain{};     ///< "controller.property"
    std::string_view integral{}; ///< "controller.property"
    double factor = 1.0;         ///< from the Controller's output to the rate of the measured value
    Duration transport{};
    bool may_overshoot = false;
};

/// The property with the proportional gain, in 1/s times the plant's unit: a rate for each unit of error.
constexpr RowOption<LoopRow, std::string_view> gain(std::string_view property) noexcept {
    return {&LoopRow::gain, property};
}
/// The property with the integral gain, per second.
constexpr RowOption<LoopRow, std::string_view> integral(std::string_view property) noexcept {
    return {&LoopRow::integral, property};
}
/// For a spring between axis and sensor: measured value per unit of distance (force in N per metre).
constexpr RowOption<LoopRow, double> stiffness(double value) noexcept { return {&LoopRow::factor, value}; }
/// Time from the Effector through hardware and bus back to the Sensor, beyond one period.
constexpr RowOption<LoopRow, Duration> transport(Duration time) noexcept {
    return {&LoopRow::transport, time};
}
/// Accepts that the loop overshoots.
inline constexpr RowOption may_overshoot{&LoopRow::may_overshoot, true};

/// A loop around an axis that integrates its rate: the compiler checks that gain, period and delay allow it
/// to be stable.
template <class... Options>
constexpr LoopRow loop(std::string_view name, const Options&... options) {
    LoopRow row{.name = name};
    (detail::apply(row, options), ...);
    return row;
}

} // namespace tappet
