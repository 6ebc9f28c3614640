// The smallest machine that can fail: one component that does, one that does not, in one real-time activity;
// and a browser's service, so that a black box holds their values.
#pragma once

#include "kernel/machine/table/machine.hpp"
#include "kernel/services/browsing/browser_service.hpp"
#include "tests/bench/probe/probe.hpp"

namespace tappet::probe {

inline constexpr auto table =
    machine("bench-probe",
            components(component<Bystander>("bystander"), component<Culprit>("culprit"),
                       component<BrowserService>("browser")),
            activities(activity("work", every(1ms), runs("bystander", "culprit"), budget(100us)),
                       activity("browser", every(20ms), runs("browser"), not_real_time, stack(224 * 1024))),
            connections(), reactions(), behaviours());

} // namespace tappet::probe
