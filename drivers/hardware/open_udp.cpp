// A port of this box at which datagrams come in.
#include "drivers/hardware/open.hpp"
#include "kernel/machine/check/board.hpp"

namespace tappet {

std::expected<void, Sentence> open_device(udp::Socket& socket, const BoundTo& to) {
    const std::string_view address = to.address();
    return socket.open(address.substr(0, address.find(':')),
                       static_cast<std::uint16_t>(checks::port_of(address)));
}

} // namespace tappet
