// A relay over the machine's own socket, served by the network's thread.
#pragma once

#include "toolchain/tools/gateway/relay.hpp"

namespace boost::asio {
class io_context;
}

namespace tappet::network {

/// Connects without waiting: a machine whose queue is full is refused at once.
[[nodiscard]] std::unique_ptr<Relay> connect_relay(boost::asio::io_context& io, const std::string& socket,
                                                   OnPacket receive, std::string& fault);

} // namespace tappet::network
