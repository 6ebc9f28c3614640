// SPDX-License-Identifier: Apache-2.0
// Measures on the box itself whether it can hold the claims of its machine's table.
#pragma once

#include "kernel/base/time.hpp"
#include "kernel/machine/firmware.hpp"

namespace tappet {

/// For the given time, threads on each processor that runs real-time activities wake once a millisecond at
/// the board's highest priority, while others copy memory (like cyclictest under load). The kernel's tracer
/// hwlat, if present, measures gaps caused by hardware. An activity may begin as late as its deadline minus
/// its worst response: one line per activity reports both and whether the claim holds. Not while the machine
/// runs. Exit code: 0 the claims hold, 1 one does not, 2 nothing could be measured.
int measure_box(const AcceptedMachine& machine, Duration time);

} // namespace tappet
