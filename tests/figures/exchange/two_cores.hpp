// The same exchanges between two processors: how soon a packet is seen, what the other side's polling costs,
// and the worst of both sides without a pause.
#pragma once

#include "tests/figures/measure/candidates.hpp"

namespace tappet::figures {

/// Adds figures, goals and notes for packets of 160 bytes.
void measure_two_cores(const Options& options, bool with_iceoryx, Result& result);

} // namespace tappet::figures
