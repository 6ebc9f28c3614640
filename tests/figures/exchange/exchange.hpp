// The groups of figures-exchange: write and read, push and pop, by one thread with warm cache lines, and
// between two processors.
#pragma once

#include "tests/figures/measure/candidates.hpp"

namespace tappet::figures {

std::vector<Group> one_core_groups(bool with_iceoryx);

/// Measures the delay of a packet of 160 bytes, the cost of the other side's polling, and the worst case of
/// both sides without a pause: adds figures, goals and notes.
void measure_two_cores(const Options& options, bool with_iceoryx, Result& result);

} // namespace tappet::figures
