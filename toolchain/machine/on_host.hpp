// A machine's table, accepted for the host's board.
#pragma once

#include "kernel/machine/plan/places.hpp"

namespace TAPPET_NAMESPACE {

tappet::AcceptedMachine on_host();

} // namespace TAPPET_NAMESPACE
