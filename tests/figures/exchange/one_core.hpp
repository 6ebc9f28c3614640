// Write and read, push and pop, by one thread: what an exchange costs when its lines are warm.
#pragma once

#include "tests/figures/measure/candidates.hpp"

namespace tappet::figures {

std::vector<Group> one_core_groups(bool with_iceoryx);
std::vector<RatioGoal> one_core_goals();

} // namespace tappet::figures
