// Instructions of each candidate, counted by callgrind: the program starts itself once more under it.
#pragma once

#include "tests/figures/measure/candidates.hpp"

#include <map>
#include <string>
#include <vector>

namespace tappet::figures {

/// Whether this process is the one under callgrind.
bool counting();
/// When this process is the one under callgrind: runs each candidate, has it counted, and ends the process.
void leave_if_counting(const std::vector<const Group*>& groups);

/// Of one operation, by "group/candidate". Empty when valgrind is not there.
std::map<std::string, double> count_instructions(const char* program, const std::string& only);

} // namespace tappet::figures
