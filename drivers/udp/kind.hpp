// A UDP port of this box, or of another one that is asked: reached by an address.
#pragma once

#include "kernel/component/device_kind.hpp"

namespace tappet::udp {

inline constexpr DeviceKind device_kind{
    .name = "udp",
    .takes_address = true,
    .cure = "write the box's address and the port as 192.168.7.1:5005, or 0.0.0.0:5005"};

} // namespace tappet::udp
