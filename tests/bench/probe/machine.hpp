// The smallest machine that can go wrong: one component that does, one that does not, in one real-time
// activity.
#pragma once

#include "kernel/machine/table/machine.hpp"
#include "tests/bench/probe/probe.hpp"

namespace tappet::probe {

inline constexpr auto table =
    machine("bench-probe", components(component<Bystander>("bystander"), component<Culprit>("culprit")),
            activities(activity("work", every(1ms), runs("bystander", "culprit"), budget(100us))),
            connections(), reactions(), behaviours());

} // namespace tappet::probe
