// What the compiler derived from a table, for people to read: priorities, order, mailboxes, memory.
#pragma once

#include "kernel/machine/plan/places.hpp"

namespace tappet {

/// Line by line, without its end. For the host: it formats, and may be called at any time of an accepted
/// machine.
void describe_plan(const AcceptedMachine& machine, void* to, void (*line)(void* to, std::string_view));

} // namespace tappet
