// Accepts connections by asio, and counts them by address.
#include "toolchain/tools/gateway/server.hpp"

#include "toolchain/tools/gateway/connection.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

namespace tappet::network {

namespace net = boost::asio;
using Tcp = net::ip::tcp;
using boost::system::error_code;

struct Server::Inside : std::enable_shared_from_this<Inside> {
    Inside(net::io_context& io, Hub& shared, net::ssl::context* context)
        : hub{shared}, tls{context}, site{shared, context != nullptr}, acceptor{io}, pause{io} {}

    void accept() {
        acceptor.async_accept([self = shared_from_this()](error_code error, Tcp::socket socket) {
            if (error == net::error::operation_aborted) return;
            if (error) return self->rest();
            self->take(std::move(socket));
            self->accept();
        });
    }

    /// There are no descriptors left, or no memory: looks again later.
    void rest() {
        pause.expires_after(std::chrono::milliseconds{100});
        pause.async_wait([self = shared_from_this()](error_code error) {
            if (!error) self->accept();
        });
    }

    void take(Tcp::socket socket) {
        error_code error;
        const Tcp::endpoint from = socket.remote_endpoint(error);
        if (error) return;
        const std::string address = from.address().to_string();
        std::size_t& of_address = counts[lock_address(address)];
        if (hub.counters().connections >= bounds.connections || of_address >= bounds.connections_of_address) {
            ++hub.counters().turned_away;
            if (of_address == 0) counts.erase(lock_address(address));
            return; // closed by its destructor, before it costs anything
        }
        ++of_address;
        ++hub.counters().connections;
        ++hub.counters().accepted;
        socket.set_option(Tcp::no_delay{true}, error);
        socket.set_option(net::socket_base::send_buffer_size{bounds.kernel_queue_bytes}, error);
        start_connection(std::move(socket), tls, hub, site, address, [self = shared_from_this(), address] {
            --self->hub.counters().connections;
            const auto count = self->counts.find(lock_address(address));
            if (--count->second == 0) self->counts.erase(count);
        });
    }

    Hub& hub;
    net::ssl::context* tls;
    Site site;
    Tcp::acceptor acceptor;
    net::steady_timer pause;
    std::map<std::string, std::size_t> counts{}; ///< connections by address
};

Server::Server(net::io_context& io, Hub& hub, net::ssl::context* tls)
    : inside_{std::make_shared<Inside>(io, hub, tls)} {}

Server::~Server() {
    error_code ignored;
    inside_->acceptor.close(ignored);
}

std::string Server::listen(const std::string& address, std::uint16_t port) {
    error_code error;
    const auto at = net::ip::make_address(address, error);
    if (error) return "'" + address + "' is no address; write for example --listen 0.0.0.0:8443";
    Tcp::acceptor& acceptor = inside_->acceptor;
    const Tcp::endpoint place{at, port};
    const auto go_on = [&](const char* what) {
        return std::string{what} + " " + address + ":" + std::to_string(port) + ": " + error.message();
    };
    if (acceptor.open(place.protocol(), error)) return go_on("cannot open a socket for");
    acceptor.set_option(Tcp::acceptor::reuse_address{true}, error);
    if (acceptor.bind(place, error)) return go_on("cannot listen at");
    if (acceptor.listen(128, error)) return go_on("cannot listen at");
    inside_->accept();
    return {};
}

std::uint16_t Server::port() const {
    error_code error;
    return inside_->acceptor.local_endpoint(error).port();
}

} // namespace tappet::network
