// Telling whoever started this program how far it is.
#pragma once

#include <string_view>

namespace tappet::os {

/// The protocol of sd_notify(3), to the socket that NOTIFY_SOCKET names: "READY=1". Without that variable, or
/// with nobody who listens, nothing happens. It never waits. Not real-time.
void notify_starter(std::string_view state) noexcept;

} // namespace tappet::os
