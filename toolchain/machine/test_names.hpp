// Names in tests: a name that the machine lacks fails the test with the name that was meant.
#pragma once

#include "kernel/machine/instance/instance.hpp"

#include <string_view>

namespace tappet {

/// Returns why no component has that name; empty: one has. Not real-time.
[[nodiscard]] Sentence check_component(const MachineInstance& machine, std::string_view component);
/// Returns why the state machine that drives the component at present has no such state, at any level; empty:
/// it has, or the component's slot holds no state machine yet. Not real-time.
[[nodiscard]] Sentence check_state(const MachineInstance& machine, std::string_view component,
                                   std::string_view state);

/// Returns why the machine drives no such device of that kind, "can" or "modbus"; empty: it does. Not
/// real-time.
[[nodiscard]] Sentence check_device(const MachineInstance& machine, std::string_view device,
                                    std::string_view kind);

/// Returns whether the state is active: the innermost one, or one that encloses it. Not real-time.
[[nodiscard]] bool is_in_state(const MachineInstance& machine, std::string_view component,
                               std::string_view state);

} // namespace tappet
