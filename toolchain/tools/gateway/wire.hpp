// A connection of the network, with TLS or without, as one type: what stands on it is compiled once.
#pragma once

#include <utility> // Boost 1.74 needs std::exchange before its own headers

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/beast/core/role.hpp>

#include <optional>

namespace tappet::network {

namespace net = boost::asio;

/// A stream as Beast needs it.
class Wire {
public:
    using executor_type = net::ip::tcp::socket::executor_type;

    /// `tls`: null for none.
    Wire(net::ip::tcp::socket socket, net::ssl::context* tls) : socket_{std::move(socket)} {
        if (tls != nullptr) tls_.emplace(socket_, *tls);
    }
    Wire(const Wire&) = delete;
    Wire& operator=(const Wire&) = delete;

    executor_type get_executor() { return socket_.get_executor(); }
    [[nodiscard]] net::ip::tcp::socket& socket() { return socket_; }

    /// Ends at once without TLS.
    template <class Handler> void async_handshake(Handler handler) {
        if (tls_)
            tls_->async_handshake(net::ssl::stream_base::server, std::move(handler));
        else
            net::post(get_executor(),
                      [handler = std::move(handler)]() mutable { handler(boost::system::error_code{}); });
    }
    template <class Buffers, class Handler> void async_read_some(const Buffers& buffers, Handler&& handler) {
        if (tls_)
            tls_->async_read_some(buffers, std::forward<Handler>(handler));
        else
            socket_.async_read_some(buffers, std::forward<Handler>(handler));
    }
    template <class Buffers, class Handler> void async_write_some(const Buffers& buffers, Handler&& handler) {
        if (tls_)
            tls_->async_write_some(buffers, std::forward<Handler>(handler));
        else
            socket_.async_write_some(buffers, std::forward<Handler>(handler));
    }
    void close() {
        boost::system::error_code ignored;
        socket_.close(ignored);
    }

private:
    net::ip::tcp::socket socket_;
    std::optional<net::ssl::stream<net::ip::tcp::socket&>> tls_{};
};

// Beast finds these by their argument. The WebSocket has exchanged its own farewell by then.
inline void beast_close_socket(Wire& wire) { wire.close(); }
template <class Handler> void async_teardown(boost::beast::role_type, Wire& wire, Handler&& handler) {
    boost::system::error_code error;
    wire.socket().shutdown(net::ip::tcp::socket::shutdown_both, error);
    net::post(wire.get_executor(),
              [handler = std::forward<Handler>(handler)]() mutable { handler(boost::system::error_code{}); });
}

} // namespace tappet::network
