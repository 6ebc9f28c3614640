// Being asked to end from outside.
#pragma once

namespace tappet::os {

/// Called in signal context, on INT, TERM, HUP, QUIT, TSTP and every other signal whose default would end or
/// freeze the process: it may do what a signal handler may. PIPE, TTIN, TTOU and XFSZ end nothing: the call
/// that meets them fails. Null: the system's defaults again. Threads of kernel/os/thread.hpp take none of
/// these: the others do. Not real-time.
void on_termination(void (*handler)(int) noexcept) noexcept;

} // namespace tappet::os
