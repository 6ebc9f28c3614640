// A UDP port by its address: of this box, or of another box that is asked.
#pragma once

#include "kernel/component/device_kind.hpp"

namespace tappet::udp {

inline constexpr DeviceKind device_kind{
    .name = "udp",
    .takes_address = true,
    .cure = "write the box's address and the port as 192.168.7.1:5005, or 0.0.0.0:5005"};

} // namespace tappet::udp
