// The TLS context of the gateway: version 1.3 only, with a given key or one that the gateway makes itself.
#pragma once

#include <expected>
#include <memory>
#include <string>

namespace boost::asio::ssl {
class context;
}

namespace tappet::network {

struct CertificateFiles {
    std::string certificate{}; ///< PEM, with its chain
    std::string key{};         ///< PEM
};

/// Returns the files of the state folder; makes a key and a self-signed certificate there when none exist.
/// The key has mode 0600. `address`: one that the certificate names beside the host's name.
[[nodiscard]] std::expected<CertificateFiles, std::string> own_certificate(const std::string& state,
                                                                           const std::string& address);

/// `fingerprint` receives the SHA-256 of the certificate, as people compare it.
[[nodiscard]] std::expected<std::shared_ptr<boost::asio::ssl::context>, std::string>
tls_context(const CertificateFiles& files, std::string& fingerprint);

} // namespace tappet::network
