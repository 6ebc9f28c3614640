// What figures-exchange measures: write and read, push and pop, by one thread, when its lines are warm; and
// between two processors.
#pragma once

#include "tests/figures/measure/candidates.hpp"

namespace tappet::figures {

std::vector<Group> one_core_groups(bool with_iceoryx);

/// How soon a packet of 160 bytes is seen, what the other side's polling costs, and the worst of both sides
/// without a pause: adds figures, goals and notes.
void measure_two_cores(const Options& options, bool with_iceoryx, Result& result);

} // namespace tappet::figures
