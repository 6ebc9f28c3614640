// Prints the compiler's plan of a table for people: priorities, order, mailboxes, memory.
#pragma once

#include "kernel/machine/plan/places.hpp"

namespace tappet {

/// Passes the plan line by line, without line ends. For the host: it formats text, and may be called at any
/// time for an accepted machine.
void describe_plan(const AcceptedMachine& machine, void* to, void (*line)(void* to, std::string_view));

} // namespace tappet
