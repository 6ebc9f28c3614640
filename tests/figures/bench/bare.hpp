// The same answers without a framework, as one would write them in C: each device has a thread that waits,
// reads and writes.
#pragma once

#include <cstdint>

namespace tappet::figures::bench {

/// Starts the bare programs. Returns false after printing why it could not.
bool start_bare_can(const char* interface, std::uint32_t request, std::uint32_t answer, int priority);
bool start_bare_lines(const char* chip, unsigned in, unsigned out, int priority);

/// Opens a raw socket that receives these two frames only; -1: refused, with the reason printed.
int open_can(const char* interface, std::uint32_t one, std::uint32_t other);

} // namespace tappet::figures::bench
