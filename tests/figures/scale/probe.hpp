// What every generated machine is linked with: a main that starts it, runs its engines and writes a result.
#pragma once

#include "kernel/machine/instance/instance.hpp"

namespace tappet::figures {

/// The generated machine.
AcceptedMachine accepted();

/// Rows of a probe's result by which the program of figures knows them.
inline constexpr const char* probe_engines = "engines";
inline constexpr const char* probe_steps = "the same steps, called in a bare loop";

} // namespace tappet::figures
