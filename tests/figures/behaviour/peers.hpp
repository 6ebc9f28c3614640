// The loom's cycle in Boost's two libraries for state machines.
#pragma once

#include "tests/figures/behaviour/loom_counts.hpp"

namespace tappet::figures {

/// The counts of their actions.
extern LoomCounts msm_counts, statechart_counts;

/// Two machines of each, so that each order of events begins in the initial state.
inline constexpr int peer_machines = 2;
/// Call once, before the first event.
void msm_start();
void statechart_start();
/// Dispatches an event by its number, as read from a queue, to the machine of that number.
template <int machine>
void msm_dispatch(std::size_t event);
template <int machine>
void statechart_dispatch(std::size_t event);

} // namespace tappet::figures
