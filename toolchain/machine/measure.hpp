// SPDX-License-Identifier: Apache-2.0
// Whether a box can hold what its machine's table claims, measured on the box itself.
#pragma once

#include "kernel/base/time.hpp"
#include "kernel/machine/firmware.hpp"

namespace tappet {

/// For so long the processors that run real-time activities are asked to wake once a millisecond at the
/// board's highest priority, while others copy memory (as cyclictest does beside a load), and the kernel's
/// tracer looks for gaps that the hardware takes for itself (hwlat), where there is one. An activity may
/// begin as late as its deadline leaves it beside its worst response: a line for each tells both and whether
/// it holds. Not while the machine runs. The exit code: 0, they hold; 1, one does not; 2, nothing could be
/// measured.
int measure_box(const AcceptedMachine& machine, Duration time);

} // namespace tappet
