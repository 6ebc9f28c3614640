// Being asked to end from outside.
#pragma once

namespace tappet::os {

/// Called on INT and TERM, in signal context: it may do what a signal handler may. Null: the system's default
/// again. Not real-time.
void on_termination(void (*handler)(int) noexcept) noexcept;

} // namespace tappet::os
