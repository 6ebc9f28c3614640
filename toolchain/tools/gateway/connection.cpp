// HTTP by Beast: one request after the other, each within its time and size.
#include "toolchain/tools/gateway/wire.hpp"

#include "toolchain/tools/gateway/connection.hpp"
#include "toolchain/tools/gateway/web_socket.hpp"

#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

#include <array>

namespace tappet::network {

namespace {

namespace http = boost::beast::http;
using boost::system::error_code;

/// The part of a connection before it becomes a WebSocket. Every step has the same time limit.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
public:
    HttpConnection(net::ip::tcp::socket socket, net::ssl::context* tls, Hub& hub, Site& site,
                   std::string address, std::shared_ptr<void> place)
        : wire_{std::make_unique<Wire>(std::move(socket), tls)},
          timer_{wire_->get_executor()},
          hub_{hub},
          site_{site},
          address_{std::move(address)},
          place_{std::move(place)} {}

    void start() {
        limit();
        wire_->async_handshake([self = shared_from_this()](error_code error) {
            if (!error) self->read();
        });
    }

private:
    void limit() {
        timer_.expires_after(bounds.handshake);
        timer_.async_wait([weak = weak_from_this()](error_code error) {
            const auto self = weak.lock();
            if (!error && self != nullptr && self->wire_ != nullptr) self->wire_->close();
        });
    }

    void read() {
        if (wire_ == nullptr) return;
        limit();
        parser_.emplace();
        parser_->header_limit(static_cast<std::uint32_t>(bounds.header_bytes));
        parser_->body_limit(bounds.body_bytes);
        http::async_read(*wire_, buffer_, *parser_,
                         [self = shared_from_this()](error_code error, std::size_t) { self->got(error); });
    }

    void got(error_code error) {
        if (error == http::error::header_limit) return refuse(431, "the header is longer than 8 KiB");
        if (error == http::error::body_limit) return refuse(413, "the body is longer than 64 KiB");
        if (error && error.category() == http::make_error_code(http::error::bad_method).category() &&
            error != http::error::end_of_stream && error != http::error::partial_message)
            return refuse(400, "this is no HTTP request");
        if (error) return;
        const HttpRequest request = fields();
        if (boost::beast::websocket::is_upgrade(parser_->get())) {
            auto admitted = site_.upgrade(request);
            if (auto* const refusal = std::get_if<HttpReply>(&admitted))
                return write(std::move(*refusal), false, false);
            timer_.cancel();
            return start_web_socket(std::move(wire_), parser_->release(), hub_,
                                    std::get<Admission>(std::move(admitted)), address_, std::move(place_));
        }
        limit();
        const bool goes_on = parser_->keep_alive();
        const bool head = parser_->get().method() == http::verb::head;
        site_.answer(request, [self = shared_from_this(), goes_on, head](HttpReply reply) {
            self->write(std::move(reply), goes_on, head);
        });
    }

    [[nodiscard]] HttpRequest fields() const {
        const auto& message = parser_->get();
        const auto text = [&](auto name) {
            std::string all;
            const auto [begin, end] = message.equal_range(name);
            for (auto each = begin; each != end; ++each)
                all += (all.empty() ? "" : ", ") + std::string{each->value()};
            return all;
        };
        return {std::string{message.method_string()},
                std::string{message.target()},
                text(http::field::host),
                text(http::field::origin),
                text(http::field::cookie),
                text(http::field::authorization),
                text(http::field::sec_websocket_protocol),
                text(http::field::accept),
                message.body(),
                address_};
    }

    void refuse(unsigned status, std::string_view why) {
        write({status, "text/plain; charset=utf-8", std::string{why} + "\n", {}}, false, false);
    }

    void write(HttpReply reply, bool goes_on, bool head) {
        if (wire_ == nullptr) return;
        limit();
        response_.emplace();
        response_->result(reply.status);
        response_->version(11);
        response_->set(http::field::content_type, reply.type);
        for (const auto& [name, value] : safe_headers()) response_->set(name, value);
        for (const auto& [name, value] : reply.headers) response_->set(name, value);
        response_->keep_alive(goes_on);
        response_->body() = head ? std::string{} : std::move(reply.body);
        response_->content_length(head ? reply.body.size() : response_->body().size());
        http::async_write(*wire_, *response_,
                          [self = shared_from_this(), goes_on](error_code error, std::size_t) {
                              self->response_.reset();
                              if (error) return;
                              if (goes_on) return self->read();
                              error_code ignored;
                              self->wire_->socket().shutdown(net::ip::tcp::socket::shutdown_send, ignored);
                              self->drain(bounds.queue_bytes);
                          });
    }

    /// Reads what the client still sends: closing earlier would reset the connection before it has the
    /// answer.
    void drain(std::size_t most) {
        wire_->socket().async_read_some(
            net::buffer(drained_), [self = shared_from_this(), most](error_code error, std::size_t count) {
                if (!error && count < most) self->drain(most - count);
            });
    }

    std::unique_ptr<Wire> wire_;
    net::steady_timer timer_;
    Hub& hub_;
    Site& site_;
    std::string address_;
    std::shared_ptr<void> place_;
    boost::beast::flat_buffer buffer_{bounds.header_bytes + bounds.body_bytes};
    std::optional<http::request_parser<http::string_body>> parser_{};
    std::optional<http::response<http::string_body>> response_{};
    std::array<char, 1024> drained_{};
};

} // namespace

void start_connection(net::ip::tcp::socket socket, net::ssl::context* tls, Hub& hub, Site& site,
                      std::string address, std::function<void()> over) {
    // The place among the connections is given back with the last copy.
    const std::shared_ptr<void> place{nullptr, [over = std::move(over)](void*) { over(); }};
    std::make_shared<HttpConnection>(std::move(socket), tls, hub, site, std::move(address), place)->start();
}

} // namespace tappet::network
