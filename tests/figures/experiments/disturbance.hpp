// Random load that is not real-time and no part of the machine, as from other programs of a computer.
#pragma once

#include <cstdint>
#include <stop_token>

namespace tappet::experiments {

/// Until it is stopped, calculates, walks through memory beyond the caches, calls the system and sleeps, each
/// for a random time.
void disturb(const std::stop_token& ends, std::uint64_t seed);

} // namespace tappet::experiments
