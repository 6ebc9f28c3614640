// The names available to a script: its component and that one's peers (thesis 3.2: no other access path).
#pragma once

#include "kernel/component/component.hpp"

#include <span>
#include <string_view>

namespace tappet {

/// A component as a script sees it.
struct Reachable {
    std::string_view name{};
    const ComponentType* type = nullptr;
    /// It runs in the script's activity: its methods, properties and ports are safe to touch. With a
    /// component of another activity, a script may only send commands, tell operations and call any_thread
    /// methods.
    bool same_activity = false;
};

/// Most components of a machine that a typed line may name.
inline constexpr std::size_t max_line_components = 128;

/// Number 0 is the component itself. The spans must outlive the compilation.
struct Reach {
    std::span<const Reachable> components{};
    /// For a slot: "component.operation" and "component.event" of the peers that it may use. A compiled
    /// script may use all.
    bool limited = false;
    std::span<const std::string_view> operations{};
    std::span<const std::string_view> events{};
    std::uint32_t command_slots = 0xffff;
    std::uint32_t timers = 0xffff; ///< nodes and transitions that wait for time
    std::uint32_t depth = 8;       ///< of composite states and child machines
    /// Statements in one step; 0: a loop that may run without waiting is refused (thesis 5.1.3).
    std::uint32_t statements_per_step = 0;
};

} // namespace tappet
