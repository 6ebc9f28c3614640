// Requests from outside to end.
#pragma once

namespace tappet::os {

/// Sets the handler for INT, TERM, HUP, QUIT, TSTP and every other signal whose default would end or freeze
/// the process. It runs in signal context, and may call only what a signal handler may. PIPE, TTIN, TTOU and
/// XFSZ end nothing: the call that is affected fails. Null: the system's defaults again. Threads of
/// kernel/os/thread.hpp do not receive these signals, other threads do. Not real-time.
void on_termination(void (*handler)(int) noexcept) noexcept;

} // namespace tappet::os
