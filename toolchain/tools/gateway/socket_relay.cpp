// A seqpacket socket in the io_context.
#include "toolchain/tools/gateway/socket_relay.hpp"

#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace tappet::network {

namespace {

namespace net = boost::asio;
using boost::system::error_code;

class SocketRelay : public Relay {
public:
    SocketRelay(net::io_context& io, int socket, OnPacket receive)
        : inside_{std::make_shared<Inside>(net::posix::stream_descriptor{io, socket}, std::move(receive))} {
        inside_->wait();
    }
    ~SocketRelay() override {
        inside_->receive = nullptr;
        error_code ignored;
        inside_->socket.close(ignored);
    }
    bool send(std::string_view packet) override {
        return ::send(inside_->socket.native_handle(), packet.data(), packet.size(),
                      MSG_NOSIGNAL | MSG_DONTWAIT) == static_cast<ssize_t>(packet.size());
    }

private:
    struct Inside : std::enable_shared_from_this<Inside> {
        Inside(net::posix::stream_descriptor descriptor, OnPacket on_packet)
            : socket{std::move(descriptor)}, receive{std::move(on_packet)} {}

        void wait() {
            socket.async_wait(net::posix::stream_descriptor::wait_read,
                              [self = shared_from_this()](error_code error) {
                                  if (!error && self->take()) self->wait();
                              });
        }

        /// Returns whether there may be more.
        bool take() {
            // One buffer for all relays: they are served by one thread. Passed descriptors are closed by the
            // kernel.
            static std::array<char, 64 * 1024> packet;
            const ssize_t count = ::recv(socket.native_handle(), packet.data(), packet.size(), MSG_DONTWAIT);
            if (count < 0 && (errno == EAGAIN || errno == EINTR)) return true;
            const OnPacket to = receive; // the receiver may destroy the relay
            if (to) to({packet.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0))});
            return count > 0 && receive != nullptr;
        }

        net::posix::stream_descriptor socket;
        OnPacket receive;
    };
    std::shared_ptr<Inside> inside_;
};

} // namespace

std::unique_ptr<Relay> connect_relay(net::io_context& io, const std::string& path, OnPacket receive,
                                     std::string& fault) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.size() >= sizeof address.sun_path) {
        fault = "the path of its socket is too long";
        return nullptr;
    }
    std::ranges::copy(path, address.sun_path);
    const int socket = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (socket < 0 || ::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
        fault = errno == EAGAIN ? "it accepts no connection now; try again" : std::strerror(errno);
        if (socket >= 0) ::close(socket);
        return nullptr;
    }
    return std::make_unique<SocketRelay>(io, socket, std::move(receive));
}

} // namespace tappet::network
