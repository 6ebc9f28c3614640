// WebSockets by Beast, with a bounded queue.
#include "toolchain/tools/gateway/web_socket.hpp"

#include "toolchain/tools/gateway/encoding.hpp"
#include "toolchain/tools/gateway/peer.hpp"

#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>

#include <deque>

namespace tappet::network {

namespace {

namespace websocket = boost::beast::websocket;
namespace http = boost::beast::http;
using boost::system::error_code;

/// Beast's stream over a Wire that stays where it is.
class WireRef {
public:
    using executor_type = Wire::executor_type;
    explicit WireRef(std::unique_ptr<Wire> wire) : wire_{std::move(wire)} {}
    executor_type get_executor() { return wire_->get_executor(); }
    template <class Buffers, class Handler> void async_read_some(const Buffers& buffers, Handler&& handler) {
        wire_->async_read_some(buffers, std::forward<Handler>(handler));
    }
    template <class Buffers, class Handler> void async_write_some(const Buffers& buffers, Handler&& handler) {
        wire_->async_write_some(buffers, std::forward<Handler>(handler));
    }
    [[nodiscard]] Wire& wire() { return *wire_; }

private:
    std::unique_ptr<Wire> wire_;
};

void beast_close_socket(WireRef& wire) { wire.wire().close(); }
template <class Handler> void async_teardown(boost::beast::role_type role, WireRef& wire, Handler&& handler) {
    async_teardown(role, wire.wire(), std::forward<Handler>(handler));
}

/// How long a WebSocket that ends may still write; then its socket is closed.
constexpr std::chrono::seconds farewell{2};

class WebSocket : public Outlet, public std::enable_shared_from_this<WebSocket> {
public:
    WebSocket(std::unique_ptr<Wire> wire, std::shared_ptr<void> place)
        : stream_{std::move(wire)}, limit_{stream_.get_executor()}, place_{std::move(place)} {}

    void start(const http::request<http::string_body>& request, Hub& hub, Admission admission,
               std::string address) {
        websocket::stream_base::timeout limits{};
        limits.handshake_timeout = bounds.handshake;
        limits.idle_timeout = bounds.silence;
        limits.keep_alive_pings = true;
        stream_.set_option(limits);
        stream_.set_option(websocket::stream_base::decorator{[](websocket::response_type& response) {
            response.set(http::field::sec_websocket_protocol, std::string{subprotocol});
        }});
        stream_.read_message_max(bounds.message_bytes);
        stream_.auto_fragment(false);
        stream_.async_accept(request, [self = shared_from_this(), &hub, admission = std::move(admission),
                                       address = std::move(address)](error_code error) mutable {
            if (error) return;
            self->peer_ = std::make_shared<Peer>(hub, *self, std::move(address), std::move(admission.who),
                                                 std::move(admission.token), Clock::now());
            self->read();
        });
    }

    bool offer(std::string frame) override {
        if (ending_ || queued_ + frame.size() > bounds.queue_bytes) return false;
        put({std::move(frame), true});
        return true;
    }

    bool has_room() const override { return !ending_ && queued_ < bounds.queue_bytes / 2; }

    void send(std::string text) override {
        if (ending_) return;
        // A long reply may exceed the bound, but nothing may follow it before it is read.
        if (queued_ > bounds.queue_bytes) return end("it reads too slowly: its queue is full");
        put({std::move(text), false});
    }

    void end(std::string_view reason) override {
        if (std::exchange(ending_, true)) return;
        reason_ = cut(reason, 120);
        // A client that reads nothing holds neither a write nor the farewell up.
        close_after(farewell);
        // Later: the caller may be the peer itself.
        net::post(stream_.get_executor(), [self = shared_from_this()] {
            if (self->queue_.size() > 1) self->queue_.resize(1); // the one under way
            if (!self->writing_) self->close();
        });
    }

private:
    struct Queued {
        std::string bytes{};
        bool is_binary = false;
    };

    void close_after(std::chrono::seconds most) {
        limit_.expires_after(most);
        limit_.async_wait([weak = weak_from_this()](error_code error) {
            const auto self = weak.lock();
            if (!error && self != nullptr) self->stream_.next_layer().wire().close();
        });
    }

    void read() {
        stream_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
            if (error) return self->leave();
            const auto bytes = self->buffer_.data();
            const std::string_view text{static_cast<const char*>(bytes.data()), bytes.size()};
            if (self->stream_.got_text())
                self->peer_->receive(text, Clock::now());
            else
                self->end("messages are JSON text");
            self->buffer_.consume(self->buffer_.size());
            self->read();
        });
    }

    void put(Queued each) {
        queued_ += each.bytes.size();
        queue_.push_back(std::move(each));
        if (!writing_) write();
    }

    void write() {
        if (queue_.empty()) return ending_ ? close() : void();
        writing_ = true;
        stream_.binary(queue_.front().is_binary);
        stream_.async_write(net::buffer(queue_.front().bytes),
                            [self = shared_from_this()](error_code error, std::size_t) {
                                self->writing_ = false;
                                if (error) return self->leave();
                                self->queued_ -= self->queue_.front().bytes.size();
                                self->queue_.pop_front();
                                self->write();
                            });
    }

    void close() {
        if (std::exchange(closing_, true)) return;
        if (peer_ != nullptr) peer_->close();
        stream_.async_close(
            {websocket::close_code::policy_error, reason_},
            [self = shared_from_this()](error_code) { self->stream_.next_layer().wire().close(); });
    }

    /// The connection is over: nothing is read or written any more.
    void leave() {
        ending_ = true;
        if (peer_ != nullptr) peer_->close();
        if (!closing_) stream_.next_layer().wire().close();
    }

    websocket::stream<WireRef, false> stream_;
    net::steady_timer limit_;
    std::shared_ptr<void> place_;
    std::shared_ptr<Peer> peer_{};
    boost::beast::flat_buffer buffer_{bounds.message_bytes + 1024};
    std::deque<Queued> queue_{};
    std::size_t queued_ = 0;
    bool writing_ = false;
    bool ending_ = false;
    bool closing_ = false;
    std::string reason_{};
};

} // namespace

void start_web_socket(std::unique_ptr<Wire> wire, const http::request<http::string_body>& request, Hub& hub,
                      Admission admission, std::string address, std::shared_ptr<void> place) {
    std::make_shared<WebSocket>(std::move(wire), std::move(place))
        ->start(request, hub, std::move(admission), std::move(address));
}

} // namespace tappet::network
