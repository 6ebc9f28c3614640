// The groups of figures-dispatch, by subject.
#pragma once

#include "tests/figures/measure/candidates.hpp"

namespace tappet::figures {

void add_events(std::vector<Group>& groups);
void add_commands(std::vector<Group>& groups);
void add_cycles(std::vector<Group>& groups);
void add_calls(std::vector<Group>& groups);
void add_steps(std::vector<Group>& groups);

} // namespace tappet::figures
