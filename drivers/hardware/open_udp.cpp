// A port of this box at which datagrams come in, or one of another box that is asked.
#include "drivers/hardware/open.hpp"
#include "kernel/machine/check/board.hpp"

namespace tappet {

std::expected<void, Sentence> open_device(udp::Socket& socket, const BoundTo& to) {
    const std::string_view at = to.address();
    const std::string_view address = at.substr(0, at.find(':'));
    const auto port = static_cast<std::uint16_t>(checks::port_of(at));
    const auto* longest = static_cast<const udp::Longest*>(to.row.type->device_map);
    return longest != nullptr && longest->asks ? socket.ask(address, port) : socket.open(address, port);
}

} // namespace tappet
