// The WebSocket of one client: frames in, frames out through a bounded queue.
#pragma once

#include "toolchain/tools/gateway/wire.hpp"

#include "toolchain/tools/gateway/site.hpp"

#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

namespace tappet::network {

/// Accepts the upgrade and serves the client until either end closes. `place`: released at the end.
void start_web_socket(std::unique_ptr<Wire> wire,
                      const boost::beast::http::request<boost::beast::http::string_body>& request, Hub& hub,
                      Admission admission, std::string address, std::shared_ptr<void> place);

} // namespace tappet::network
