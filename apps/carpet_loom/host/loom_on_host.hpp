// The carpet loom's machine, accepted for the host's board.
#pragma once

#include "kernel/machine/firmware.hpp"
#include "kernel/machine/instance/property_store.hpp"

namespace tappet::carpet {

AcceptedMachine loom_on_host();
/// Where its properties are kept: nowhere unless named, so that a run depends on its seed alone. Before the
/// run starts; the characters outlive it.
void keep_properties_in(std::string_view directory);
PropertyStore properties_on_host();

} // namespace tappet::carpet
