// The states of a component's life (thesis 3.1.3), as anybody may read them, and how a change is asked for.
#pragma once

#include "kernel/base/realtime.hpp"

#include <atomic>
#include <cstdint>
#include <string_view>

namespace tappet {

/// Written by the component's engine alone, or by whoever runs that engine's stop in its place; read by any
/// thread.
enum class ComponentState : std::uint8_t {
    inactive, ///< constructed, perhaps configured; its activity never ran
    stopped,  ///< its outputs hold the safe values; it does nothing
    starting, ///< it may not run yet: start() runs, or an input that it needs has no valid value
    running,  ///< it is stepped, and messages reach it
    stopping, ///< stop() leaves the safe values
    failed    ///< it could not be initialised, or its thread broke a contract: it is not started again
};

constexpr std::string_view to_text(ComponentState state) noexcept {
    switch (state) {
    case ComponentState::inactive: return "inactive";
    case ComponentState::stopped: return "stopped";
    case ComponentState::starting: return "starting";
    case ComponentState::running: return "running";
    case ComponentState::stopping: return "stopping";
    case ComponentState::failed: return "failed";
    }
    return "?";
}

using AtomicComponentState = std::atomic<ComponentState>;
static_assert(AtomicComponentState::is_always_lock_free);

/// Whether messages and steps reach it. Real-time, any thread.
inline bool is_running(const AtomicComponentState& state) noexcept TAPPET_REALTIME {
    return state.load(std::memory_order_acquire) == ComponentState::running;
}

} // namespace tappet
