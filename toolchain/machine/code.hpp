// A machine's table with the code of its components, whichever board it is accepted for.
#pragma once

#include "kernel/machine/table/machine.hpp"

namespace TAPPET_NAMESPACE {

tappet::MachineView view();

} // namespace TAPPET_NAMESPACE
