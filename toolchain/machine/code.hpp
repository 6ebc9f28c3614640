// A machine's table with the code of its components, for any board.
#pragma once

#include "kernel/machine/table/machine.hpp"

namespace TAPPET_NAMESPACE {

tappet::MachineView view();

} // namespace TAPPET_NAMESPACE
