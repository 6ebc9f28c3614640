// One connection: TLS, HTTP requests, and perhaps a WebSocket. Beast is compiled in its source alone.
#pragma once

#include "toolchain/tools/gateway/site.hpp"

#include <boost/asio/ip/tcp.hpp>

namespace boost::asio::ssl {
class context;
}

namespace tappet::network {

/// Serves the socket until either end closes it; then calls `over`. Hub and site outlive it.
void start_connection(boost::asio::ip::tcp::socket socket, boost::asio::ssl::context* tls, Hub& hub,
                      Site& site, std::string address, std::function<void()> over);

} // namespace tappet::network
