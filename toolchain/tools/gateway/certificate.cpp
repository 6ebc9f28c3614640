// Keys and certificates by OpenSSL.
#include "toolchain/tools/gateway/certificate.hpp"

#include "toolchain/tools/gateway/encoding.hpp"
#include "toolchain/tools/gateway/secrets.hpp"

#include <utility>

#include <boost/asio/ssl/context.hpp>

#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>

#include <fcntl.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tappet::network {

namespace {

template <class T, void (*free)(T*)> struct Free {
    void operator()(T* what) const { free(what); }
};
using Key = std::unique_ptr<EVP_PKEY, Free<EVP_PKEY, EVP_PKEY_free>>;
using Certificate = std::unique_ptr<X509, Free<X509, X509_free>>;
using Extension = std::unique_ptr<X509_EXTENSION, Free<X509_EXTENSION, X509_EXTENSION_free>>;
using Memory = std::unique_ptr<BIO, Free<BIO, BIO_free_all>>;

constexpr long ten_years_s = 10L * 365 * 24 * 3600;

bool extend(X509& certificate, int which, const std::string& value) {
    X509V3_CTX context{};
    X509V3_set_ctx(&context, &certificate, &certificate, nullptr, nullptr, 0);
    const Extension extension{X509V3_EXT_conf_nid(nullptr, &context, which, value.c_str())};
    return extension != nullptr && X509_add_ext(&certificate, extension.get(), -1) == 1;
}

Certificate signed_by_itself(EVP_PKEY& key, const std::string& host, const std::string& address) {
    Certificate certificate{X509_new()};
    X509& x = *certificate;
    const std::string number = random_bytes(8);
    std::uint64_t serial = 0;
    std::memcpy(&serial, number.data(), sizeof serial);
    X509_NAME* const name = X509_get_subject_name(&x);
    const bool any = address == "0.0.0.0" || address == "::";
    const bool done =
        X509_set_version(&x, 2) == 1 &&
        ASN1_INTEGER_set_uint64(X509_get_serialNumber(&x), serial >> 1) == 1 &&
        X509_gmtime_adj(X509_getm_notBefore(&x), -3600) != nullptr &&
        X509_gmtime_adj(X509_getm_notAfter(&x), ten_years_s) != nullptr &&
        X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_UTF8,
                                   reinterpret_cast<const unsigned char*>(host.c_str()), -1, -1, 0) == 1 &&
        X509_set_issuer_name(&x, name) == 1 && X509_set_pubkey(&x, &key) == 1 &&
        extend(x, NID_basic_constraints, "critical,CA:FALSE") && extend(x, NID_ext_key_usage, "serverAuth") &&
        extend(x, NID_subject_alt_name,
               "DNS:" + host + ",DNS:localhost,IP:127.0.0.1,IP:::1" + (any ? "" : ",IP:" + address)) &&
        X509_sign(&x, &key, EVP_sha256()) > 0;
    return done ? std::move(certificate) : nullptr;
}

std::string text_of(BIO& memory) {
    char* text = nullptr;
    const long length = BIO_get_mem_data(&memory, &text);
    return {text, static_cast<std::size_t>(std::max(length, 0L))};
}

/// Writes a new file; returns the error.
std::string write_new(const std::string& path, const std::string& text) {
    const std::string beside = path + ".new";
    ::unlink(beside.c_str());
    const int file = ::open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    const bool written = file >= 0 &&
                         ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
                         ::fsync(file) == 0;
    const int error = errno;
    if (file >= 0) ::close(file);
    if (written && ::rename(beside.c_str(), path.c_str()) == 0) return {};
    return "'" + path + "' cannot be written: " + std::strerror(error) + "; name another folder with --state";
}

} // namespace

std::expected<CertificateFiles, std::string> own_certificate(const std::string& state,
                                                             const std::string& address) {
    CertificateFiles files{state + "/certificate.pem", state + "/key.pem"};
    struct stat there{};
    if (::stat(files.certificate.c_str(), &there) == 0 && ::stat(files.key.c_str(), &there) == 0) {
        if ((there.st_mode & 0077) == 0) return files;
        return std::unexpected("others may read '" + files.key +
                               "'; chmod 600 it, or delete it: then the gateway makes another");
    }
    if (::mkdir(state.c_str(), 0700) != 0 && errno != EEXIST)
        return std::unexpected("the folder '" + state + "' cannot be made: " + std::strerror(errno) +
                               "; name another with --state");
    std::array<char, 65> host{};
    static_cast<void>(::gethostname(host.data(), host.size() - 1));
    const std::string name = host[0] == 0 ? "tappet" : host.data();
    const Key key{EVP_EC_gen("P-256")};
    const Certificate certificate = key == nullptr ? nullptr : signed_by_itself(*key, name, address);
    const Memory key_text{BIO_new(BIO_s_mem())};
    const Memory certificate_text{BIO_new(BIO_s_mem())};
    if (certificate == nullptr ||
        PEM_write_bio_PrivateKey(key_text.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr) != 1 ||
        PEM_write_bio_X509(certificate_text.get(), certificate.get()) != 1)
        return std::unexpected("no certificate could be made for host '" + name +
                               "'; give one with --certificate and --key");
    for (const auto& [path, text] :
         {std::pair{files.key, text_of(*key_text)}, {files.certificate, text_of(*certificate_text)}})
        if (std::string fault = write_new(path, text); !fault.empty())
            return std::unexpected(std::move(fault));
    return files;
}

std::expected<std::shared_ptr<boost::asio::ssl::context>, std::string>
tls_context(const CertificateFiles& files, std::string& fingerprint) {
    namespace ssl = boost::asio::ssl;
    auto context = std::make_shared<ssl::context>(ssl::context::tls_server);
    SSL_CTX* const native = context->native_handle();
    SSL_CTX_set_min_proto_version(native, TLS1_3_VERSION);
    // A buffer only while it is used; no tickets, so that keys live no longer than their connection.
    SSL_CTX_set_mode(native, SSL_MODE_RELEASE_BUFFERS);
    SSL_CTX_set_num_tickets(native, 0);
    SSL_CTX_set_session_cache_mode(native, SSL_SESS_CACHE_OFF);
    boost::system::error_code error;
    if (context->use_certificate_chain_file(files.certificate, error))
        return std::unexpected("the certificate '" + files.certificate + "' cannot be read: " +
                               error.message() + "; give a PEM file with --certificate");
    if (context->use_private_key_file(files.key, ssl::context::pem, error) ||
        SSL_CTX_check_private_key(native) != 1)
        return std::unexpected("'" + files.key + "' is not the key of '" + files.certificate +
                               "'; give both with --certificate and --key");
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned length = 0;
    if (X509_digest(SSL_CTX_get0_certificate(native), EVP_sha256(), digest.data(), &length) == 1)
        fingerprint = to_hex({reinterpret_cast<const char*>(digest.data()), length});
    return context;
}

} // namespace tappet::network
