// The connection to a gateway by TLS: its certificate is checked by an authority, or pinned at the first use.
#include "tests/toolchain/folder.hpp"
#include "toolchain/tools/browser/far/wire.hpp"

#include <utility> // Boost 1.74 needs std::exchange before its own headers

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <boost/beast/websocket.hpp>
#include <boost/beast/websocket/ssl.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>

#include <sstream>
#include <thread>

namespace tappet::browser {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using testing::HasSubstr;
using Socket = asio::ip::tcp::socket;

/// Writes a key and a certificate that it signs itself, for that host, as PEM.
void make_certificate(const std::string& file, const char* host) {
    EVP_PKEY* const key = EVP_EC_gen("P-256");
    X509* const certificate = X509_new();
    X509_set_version(certificate, 2);
    ASN1_INTEGER_set(X509_get_serialNumber(certificate), 1);
    X509_gmtime_adj(X509_getm_notBefore(certificate), 0);
    X509_gmtime_adj(X509_getm_notAfter(certificate), 3600);
    X509_set_pubkey(certificate, key);
    X509_NAME* const name = X509_get_subject_name(certificate);
    X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_ASC, reinterpret_cast<const unsigned char*>("box"), -1,
                               -1, 0);
    X509_set_issuer_name(certificate, name);
    X509V3_CTX context{};
    X509V3_set_ctx(&context, certificate, certificate, nullptr, nullptr, 0);
    for (const auto& [kind, value] :
         {std::pair{NID_subject_alt_name, std::string{host}}, {NID_basic_constraints, "critical,CA:TRUE"}}) {
        X509_EXTENSION* const extension = X509V3_EXT_conf_nid(nullptr, &context, kind, value.c_str());
        X509_add_ext(certificate, extension, -1);
        X509_EXTENSION_free(extension);
    }
    X509_sign(certificate, key, EVP_sha256());
    std::FILE* const out = std::fopen(file.c_str(), "w");
    PEM_write_PrivateKey(out, key, nullptr, nullptr, 0, nullptr, nullptr);
    PEM_write_X509(out, certificate);
    std::fclose(out);
    X509_free(certificate);
    EVP_PKEY_free(key);
}

/// Serves one client after the other: repeats each text, and closes at "bye".
class Server {
public:
    enum class Speaks { tls, tls_1_2, plain, nothing };
    Server(const std::string& pem, Speaks speaks, std::string protocol = "tappet.v1")
        : speaks_{speaks}, protocol_{std::move(protocol)} {
        if (speaks == Speaks::tls_1_2) SSL_CTX_set_max_proto_version(tls_.native_handle(), TLS1_2_VERSION);
        if (!pem.empty()) {
            tls_.use_certificate_chain_file(pem);
            tls_.use_private_key_file(pem, asio::ssl::context::pem);
        }
        thread_ = std::thread{[this] { run(); }};
    }
    ~Server() {
        ending_ = true;
        boost::system::error_code error;
        Socket wake{context_};
        wake.connect(acceptor_.local_endpoint(), error);
        thread_.join();
    }
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;
    [[nodiscard]] Address address(const std::string& host = "127.0.0.1") const {
        return *parse_address(host + ":" + std::to_string(acceptor_.local_endpoint().port()));
    }

private:
    void run() {
        while (!ending_) {
            boost::system::error_code error;
            Socket socket{context_};
            acceptor_.accept(socket, error);
            if (error || ending_) return;
            try {
                if (speaks_ == Speaks::nothing) continue;
                if (speaks_ == Speaks::plain) {
                    serve(beast::websocket::stream<Socket>{std::move(socket)});
                    continue;
                }
                beast::ssl_stream<Socket> secret{std::move(socket), tls_};
                secret.handshake(asio::ssl::stream_base::server);
                serve(beast::websocket::stream<beast::ssl_stream<Socket>>{std::move(secret)});
            } catch (const boost::system::system_error&) { // the client has gone
            }
        }
    }
    template <class Stream> void serve(Stream stream) {
        stream.set_option(
            beast::websocket::stream_base::decorator([this](beast::websocket::response_type& answer) {
                answer.set(beast::http::field::sec_websocket_protocol, protocol_);
            }));
        stream.accept();
        for (beast::flat_buffer buffer;; buffer.clear()) {
            stream.read(buffer);
            if (beast::buffers_to_string(buffer.data()) == "bye")
                return stream.close({beast::websocket::close_code::policy_error, "no more today"});
            stream.text(true);
            stream.write(buffer.data());
        }
    }

    asio::io_context context_{};
    asio::ip::tcp::acceptor acceptor_{context_, {asio::ip::address_v4::loopback(), 0}};
    asio::ssl::context tls_{asio::ssl::context::tls_server};
    Speaks speaks_;
    std::string protocol_;
    std::atomic<bool> ending_{false};
    std::thread thread_{};
};

struct FarWires : testing::Test {
    test::Folder folder{};
    std::ostringstream notes{};
    std::string pem = (folder / "box.pem").string(), other = (folder / "other.pem").string();
    Trust pinned{{}, (folder / "known").string()};

    FarWires() {
        make_certificate(pem, "IP:127.0.0.1");
        make_certificate(other, "DNS:mill-8");
    }
    Result<std::unique_ptr<FarWire>> open(const Address& address, const Trust& trust) {
        return FarWire::open(address, trust, notes);
    }
    static std::string answer_to(FarWire& wire, const std::string& text) {
        EXPECT_TRUE(wire.send(text));
        for (int i = 0; i < 100; ++i) {
            auto got = wire.receive(std::chrono::milliseconds{50});
            if (!got) return got.error().sentence;
            if (*got) return **got;
        }
        return "nothing came";
    }
    std::string refusal(const Address& address, const Trust& trust) {
        const auto opened = open(address, trust);
        return opened ? "it is open" : opened.error().sentence;
    }
};

TEST_F(FarWires, carry_texts_both_ways_and_tell_the_end) {
    const Server server{pem, Server::Speaks::tls};
    const auto wire = open(server.address(), pinned);
    ASSERT_TRUE(wire) << wire.error().sentence;
    EXPECT_TRUE((*wire)->is_secret());
    EXPECT_EQ(answer_to(**wire, "one"), "one");
    EXPECT_EQ(answer_to(**wire, std::string(300'000, 'x')), std::string(300'000, 'x'));
    EXPECT_THAT(answer_to(**wire, "bye"), HasSubstr("was closed by the gateway: no more today"));
}

TEST_F(FarWires, pin_the_certificate_at_the_first_use) {
    std::string address;
    {
        const Server server{pem, Server::Speaks::tls};
        address = server.address().text;
        ASSERT_TRUE(open(server.address(), pinned));
        EXPECT_THAT(notes.str(), HasSubstr(address + " is new here; its certificate sha256:"));
        notes.str("");
        ASSERT_TRUE(open(server.address(), pinned));
        EXPECT_EQ(notes.str(), "");
    }
    const Server server{other, Server::Speaks::tls};
    Address same = server.address();
    same.text = address; // at the same address as before
    EXPECT_THAT(refusal(same, pinned), HasSubstr("the certificate of " + address + " has changed"));
}

TEST_F(FarWires, check_the_authority_and_the_name_when_one_is_given) {
    const Server server{pem, Server::Speaks::tls};
    {
        const auto wire = open(server.address(), {pem, {}});
        ASSERT_TRUE(wire) << wire.error().sentence;
        EXPECT_EQ(notes.str(), "") << "nothing is pinned";
    }
    EXPECT_THAT(refusal(server.address(), {other, {}}),
                HasSubstr("is not one that '" + other + "' vouches for"));
    EXPECT_THAT(refusal(server.address("localhost"), {pem, {}}), HasSubstr("vouches for"))
        << "it names another host";
    EXPECT_THAT(refusal(server.address(), {(folder / "none").string(), {}}),
                HasSubstr("holds no certificates"));
}

TEST_F(FarWires, refuse_an_older_tls) {
    const Server server{pem, Server::Speaks::tls_1_2};
    EXPECT_THAT(refusal(server.address(), {pem, {}}), HasSubstr("no TLS 1.3 with"));
}

TEST_F(FarWires, accept_no_tls_at_the_loopback_interface_only_without_an_authority) {
    const Server server{"", Server::Speaks::plain};
    {
        const auto wire = open(server.address(), pinned);
        ASSERT_TRUE(wire) << wire.error().sentence;
        EXPECT_FALSE((*wire)->is_secret());
        EXPECT_EQ(answer_to(**wire, "one"), "one");
    }
    EXPECT_THAT(refusal(server.address(), {pem, {}}), HasSubstr("no TLS 1.3 with"));
    Address elsewhere = server.address();
    elsewhere.host = "0.0.0.0"; // the same interface, by an address that is not its own
    EXPECT_THAT(refusal(elsewhere, pinned), HasSubstr("no TLS 1.3 with"));
    ASSERT_TRUE(KnownBoxes{pinned.known}.check(server.address(), "sha256:aa"));
    EXPECT_THAT(refusal(server.address(), pinned), HasSubstr("no TLS 1.3 with")) << "it had a certificate";
}

TEST_F(FarWires, say_what_is_at_the_address) {
    const Server other_protocol{pem, Server::Speaks::tls, "chat"};
    EXPECT_NE(refusal(other_protocol.address(), pinned), "it is open");
    const Server silent{"", Server::Speaks::nothing};
    EXPECT_NE(refusal(silent.address(), pinned), "it is open");
    EXPECT_THAT(refusal(*parse_address("127.0.0.1:1"), pinned), HasSubstr("nobody answers at 127.0.0.1:1"));
    EXPECT_THAT(refusal(*parse_address("no-such-box.invalid:1"), pinned), HasSubstr("there is no host"));
}

} // namespace
} // namespace tappet::browser
