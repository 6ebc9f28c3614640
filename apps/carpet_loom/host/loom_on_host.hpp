// The carpet loom's machine, accepted for the host's board.
#pragma once

#include "kernel/machine/firmware.hpp"

namespace tappet::carpet {

AcceptedMachine loom_on_host();

} // namespace tappet::carpet
