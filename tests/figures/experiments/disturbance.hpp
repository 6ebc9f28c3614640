// Random load that is not real-time and no part of the machine: what else a computer does meanwhile.
#pragma once

#include <cstdint>
#include <stop_token>

namespace tappet::experiments {

/// Until it is stopped: calculates, goes through memory beyond the caches, calls the system and sleeps, each
/// for a random time.
void disturb(const std::stop_token& ends, std::uint64_t seed);

} // namespace tappet::experiments
