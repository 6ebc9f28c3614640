// Notification of the starter of this program, about its progress.
#pragma once

#include <string_view>

namespace tappet::os {

/// Sends `state` to the socket that NOTIFY_SOCKET names, by the protocol of sd_notify(3): "READY=1". Without
/// that variable, or with nobody who listens, nothing happens. It never waits. Not real-time.
void notify_starter(std::string_view state) noexcept;

} // namespace tappet::os
