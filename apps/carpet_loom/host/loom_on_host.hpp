// The carpet loom's machine, accepted for the host's board.
#pragma once

#include "kernel/machine/firmware.hpp"
#include "kernel/machine/property_store.hpp"

namespace tappet::carpet {

AcceptedMachine loom_on_host();
/// Where its properties are kept: nowhere, so that a run depends on its seed alone.
PropertyStore properties_on_host();

} // namespace tappet::carpet
