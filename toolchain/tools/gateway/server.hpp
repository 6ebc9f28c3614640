// The listening socket: accepts connections within the bounds.
#pragma once

#include "toolchain/tools/gateway/hub.hpp"

#include <memory>
#include <string>

namespace boost::asio {
class io_context;
namespace ssl {
class context;
}
} // namespace boost::asio

namespace tappet::network {

class Server {
public:
    /// `tls`: null for none.
    Server(boost::asio::io_context& io, Hub& hub, boost::asio::ssl::context* tls);
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    /// Listens at an address such as "127.0.0.1" and a port; 0: any. Returns the error; empty: none.
    [[nodiscard]] std::string listen(const std::string& address, std::uint16_t port);
    [[nodiscard]] std::uint16_t port() const;

private:
    struct Inside;
    std::shared_ptr<Inside> inside_;
};

} // namespace tappet::network
