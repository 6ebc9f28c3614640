// What a machine's programs on the host are made of, as tappet_machine() of CMake named it: each is compiled
// once, in on_host.cpp and plant.cpp.
#pragma once

#include "kernel/machine/plan/places.hpp"
#include "toolchain/machine/host_hooks.hpp"

#include <memory>

namespace TAPPET_NAMESPACE {

/// Its table, accepted for the host's board.
tappet::AcceptedMachine on_host();
/// Its PLANT: what stands at the other end of its wires.
std::unique_ptr<tappet::Plant> make_plant(std::uint64_t seed);
/// Its HOST_HOOKS; without any, none.
tappet::HostHooks hooks_on_host();

} // namespace TAPPET_NAMESPACE
