// The same answers without a framework, as one would write them in C: a thread for each device that waits,
// reads and writes.
#pragma once

#include <cstdint>

namespace tappet::figures::bench {

/// What may happen once the program runs. Why not is printed.
bool start_bare_can(const char* interface, std::uint32_t request, std::uint32_t answer, int priority);
bool start_bare_lines(const char* chip, unsigned in, unsigned out, int priority);

/// A raw socket that takes these two frames only; -1: refused, and why is printed.
int open_can(const char* interface, std::uint32_t one, std::uint32_t other);

} // namespace tappet::figures::bench
