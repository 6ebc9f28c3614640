// Boost.Beast over OpenSSL. One thread: each step runs the context until it is done or too late.
#include "toolchain/tools/browser/far/wire.hpp"

#include <utility> // Boost 1.74 needs std::exchange before its own headers

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/host_name_verification.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <boost/beast/websocket.hpp>
#include <boost/beast/websocket/ssl.hpp>

#include <array>
#include <ostream>

namespace tappet::browser {

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using boost::system::error_code;
using Plain = beast::tcp_stream;
using Secret = beast::ssl_stream<beast::tcp_stream>;

constexpr std::chrono::seconds step{10};
constexpr std::size_t most_bytes = std::size_t{4} << 20; ///< of a frame

Failure lost(const Address& address, const std::string& why) {
    return {Fault::no_machine, "the connection to " + address.text + " " + why};
}

/// Starts an operation and runs the context until it is done, or too late.
template <class Start> error_code await(asio::io_context& context, const Start& start) {
    const auto result = std::make_shared<std::optional<error_code>>(); // too late, it may still be set
    start([result](error_code error, auto&&...) { *result = error; });
    context.restart();
    const auto until = std::chrono::steady_clock::now() + step;
    while (!*result && context.run_one_until(until) > 0) {
    }
    return result->value_or(error_code{beast::error::timeout});
}

Result<void> connect(asio::io_context& context, beast::tcp_stream& stream, const Address& address) {
    asio::ip::tcp::resolver resolver{context};
    error_code error;
    const auto found = resolver.resolve(address.host, address.port, error);
    if (error)
        return failure(Fault::no_machine, "there is no host '" + address.host + "': " + error.message() +
                                              "; check the name, or write the box's number");
    error = await(context, [&](auto done) { stream.async_connect(found, std::move(done)); });
    if (!error) return {};
    return failure(Fault::no_machine, "nobody answers at " + address.text + ": " + error.message() +
                                          "; is tappet-gateway running there, and is the port its own?");
}

std::string fingerprint_of(Secret& stream) {
    std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
    unsigned length = 0;
    X509* const certificate = SSL_get1_peer_certificate(stream.native_handle());
    if (certificate == nullptr) return {};
    const int done = X509_digest(certificate, EVP_sha256(), bytes.data(), &length);
    X509_free(certificate);
    if (done != 1) return {};
    constexpr std::string_view digits = "0123456789abcdef";
    std::string text = "sha256:";
    for (unsigned i = 0; i < length; ++i) {
        text += digits[bytes[i] >> 4];
        text += digits[bytes[i] & 15];
    }
    return text;
}

/// Sets what the handshake checks. Without an authority it accepts any certificate, which is then compared.
Result<void> prepare(asio::ssl::context& tls, const Trust& trust, const Address& address) {
    error_code error;
    SSL_CTX_set_min_proto_version(tls.native_handle(), TLS1_3_VERSION);
    if (trust.ca.empty()) {
        tls.set_verify_mode(asio::ssl::verify_none, error);
        return {};
    }
    tls.load_verify_file(trust.ca, error);
    if (error)
        return wrong("'" + trust.ca + "' holds no certificates: " + error.message() +
                     "; name a PEM file with --ca");
    tls.set_verify_mode(asio::ssl::verify_peer, error);
    tls.set_verify_callback(asio::ssl::host_name_verification{address.host}, error);
    return {};
}

template <class Stream> class Wire final : public FarWire {
public:
    Wire(std::unique_ptr<asio::io_context> context, std::shared_ptr<asio::ssl::context> tls, Stream stream,
         Address address)
        : context_{std::move(context)},
          tls_{std::move(tls)},
          socket_{std::move(stream)},
          address_{std::move(address)} {}
    ~Wire() override {
        error_code error;
        beast::get_lowest_layer(socket_).socket().close(error);
        context_->restart();
        context_->run_for(std::chrono::milliseconds{100}); // ends the read under way
    }

    Result<void> upgrade() {
        namespace websocket = beast::websocket;
        beast::get_lowest_layer(socket_).expires_never();
        socket_.set_option(websocket::stream_base::timeout{step, std::chrono::seconds{30}, true});
        socket_.set_option(websocket::stream_base::decorator([](websocket::request_type& request) {
            request.set(beast::http::field::sec_websocket_protocol, "tappet.v1");
        }));
        socket_.read_message_max(most_bytes);
        websocket::response_type answer;
        const error_code error = await(*context_, [&](auto done) {
            socket_.async_handshake(answer, address_.text, "/v1", std::move(done));
        });
        if (error)
            return failure(Fault::no_machine, "what answers at " + address_.text + " is no tappet-gateway: " +
                                                  error.message() + "; check the port");
        if (answer[beast::http::field::sec_websocket_protocol] != "tappet.v1")
            return failure(Fault::no_machine,
                           "the gateway at " + address_.text +
                               " speaks another protocol than tappet.v1; use the browser of its "
                               "version");
        read();
        return {};
    }

    [[nodiscard]] bool is_secret() const override { return std::is_same_v<Stream, Secret>; }

    Result<void> send(const std::string& text) override {
        socket_.text(true);
        const auto bytes = std::make_shared<const std::string>(text);
        const auto sent = std::make_shared<std::optional<error_code>>();
        socket_.async_write(asio::buffer(*bytes),
                            [bytes, sent](error_code error, std::size_t) { *sent = error; });
        const auto until = std::chrono::steady_clock::now() + step;
        while (!*sent && ended_.empty()) {
            if (std::chrono::steady_clock::now() > until) ended_ = "takes no more";
            context_->restart();
            context_->run_one_for(std::chrono::milliseconds{50});
        }
        if (*sent && !**sent) return {};
        if (ended_.empty()) ended_ = "is lost: " + (**sent).message();
        return std::unexpected(lost(address_, ended_));
    }

    Result<std::optional<std::string>> receive(std::chrono::milliseconds patience) override {
        const auto until = std::chrono::steady_clock::now() + patience;
        while (!has_come_ && ended_.empty() && std::chrono::steady_clock::now() < until) {
            context_->restart();
            context_->run_one_until(until);
        }
        if (has_come_) {
            std::string text = beast::buffers_to_string(buffer_.data());
            buffer_.consume(buffer_.size());
            has_come_ = false;
            read();
            return std::optional{std::move(text)};
        }
        if (!ended_.empty()) return std::unexpected(lost(address_, ended_));
        return std::optional<std::string>{};
    }

private:
    void read() {
        socket_.async_read(buffer_, [this](error_code error, std::size_t) {
            if (!error)
                has_come_ = true;
            else if (error == beast::websocket::error::closed)
                ended_ = "was closed by the gateway: " + std::string{socket_.reason().reason.c_str()};
            else
                ended_ = "is lost: " + error.message();
        });
    }

    std::unique_ptr<asio::io_context> context_;
    std::shared_ptr<asio::ssl::context> tls_;
    beast::websocket::stream<Stream> socket_;
    Address address_;
    beast::flat_buffer buffer_{};
    bool has_come_ = false;
    std::string ended_{};
};

template <class Stream>
Result<std::unique_ptr<FarWire>> upgraded(std::unique_ptr<asio::io_context> context,
                                          std::shared_ptr<asio::ssl::context> tls, Stream stream,
                                          const Address& address) {
    auto wire =
        std::make_unique<Wire<Stream>>(std::move(context), std::move(tls), std::move(stream), address);
    if (const auto done = wire->upgrade(); !done) return std::unexpected(done.error());
    return wire;
}

Result<std::unique_ptr<FarWire>> open_plain(const Address& address) {
    auto context = std::make_unique<asio::io_context>(1);
    Plain stream{*context};
    if (const auto done = connect(*context, stream, address); !done) return std::unexpected(done.error());
    return upgraded<Plain>(std::move(context), nullptr, std::move(stream), address);
}

/// Returns why the handshake failed.
Failure refused(const Address& address, const Trust& trust, Secret& stream, const error_code& error) {
    if (const long verified = SSL_get_verify_result(stream.native_handle());
        !trust.ca.empty() && verified != X509_V_OK)
        return {Fault::no_machine, "the certificate of " + address.text + " is not one that '" + trust.ca +
                                       "' vouches for: " + X509_verify_cert_error_string(verified) +
                                       "; check the address, and --ca"};
    return {Fault::no_machine, "no TLS 1.3 with " + address.text + ": " + error.message() +
                                   "; is it tappet-gateway that answers there?"};
}

} // namespace

Result<std::unique_ptr<FarWire>> FarWire::open(const Address& address, const Trust& trust,
                                               std::ostream& notes) {
    auto context = std::make_unique<asio::io_context>(1);
    auto tls = std::make_shared<asio::ssl::context>(asio::ssl::context::tls_client);
    if (const auto done = prepare(*tls, trust, address); !done) return std::unexpected(done.error());
    Secret stream{*context, *tls};
    if (const auto done = connect(*context, beast::get_lowest_layer(stream), address); !done)
        return std::unexpected(done.error());
    // OpenSSL's macro SSL_set_tlsext_host_name, without its cast.
    SSL_ctrl(stream.native_handle(), SSL_CTRL_SET_TLSEXT_HOSTNAME, TLSEXT_NAMETYPE_host_name,
             const_cast<char*>(address.host.c_str()));
    const error_code error = await(*context, [&](auto done) {
        stream.async_handshake(asio::ssl::stream_base::client, std::move(done));
    });
    // It may be a gateway of --loopback, but not one that had a certificate before.
    if (error && address.is_loopback() && trust.ca.empty() && !KnownBoxes{trust.known}.knows(address))
        return open_plain(address);
    if (error) return std::unexpected(refused(address, trust, stream, error));
    if (trust.ca.empty()) {
        const auto known = KnownBoxes{trust.known}.check(address, fingerprint_of(stream));
        if (!known) return std::unexpected(known.error());
        if (!known->empty()) notes << "tappet-browse: " << *known << std::endl;
    }
    return upgraded<Secret>(std::move(context), std::move(tls), std::move(stream), address);
}

} // namespace tappet::browser
