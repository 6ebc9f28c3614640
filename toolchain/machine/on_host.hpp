// The parts of a machine's programs on the host, as named by tappet_machine() of CMake: each is compiled
// once, in on_host.cpp and plant.cpp.
#pragma once

#include "kernel/machine/plan/places.hpp"
#include "toolchain/machine/host_hooks.hpp"

#include <memory>

namespace TAPPET_NAMESPACE {

/// Returns its table, accepted for the host's board.
tappet::AcceptedMachine on_host();
/// Makes its PLANT: the simulation at the other end of its wires.
std::unique_ptr<tappet::Plant> make_plant(std::uint64_t seed);
/// Returns its HOST_HOOKS; empty without any.
tappet::HostHooks hooks_on_host();

} // namespace TAPPET_NAMESPACE
