// The common main of every generated machine: it starts the machine, runs its engines and writes a result.
#pragma once

#include "kernel/machine/instance/instance.hpp"

namespace tappet::figures {

/// The generated machine.
AcceptedMachine accepted();

/// Names of the rows of a probe's result, for the program of figures.
inline constexpr const char* probe_engines = "engines";
inline constexpr const char* probe_steps = "the same steps, called in a bare loop";

} // namespace tappet::figures
