// The loom's cycle in Boost's two libraries for state machines.
#pragma once

#include "apps/figures/behaviour/loom_counts.hpp"

namespace tappet::figures {

/// What their actions count.
extern LoomCounts msm_counts, statechart_counts;

/// Once, before the first event.
void msm_start();
void statechart_start();
/// An event by its number, as it comes out of a queue.
void msm_dispatch(std::size_t event);
void statechart_dispatch(std::size_t event);

} // namespace tappet::figures
