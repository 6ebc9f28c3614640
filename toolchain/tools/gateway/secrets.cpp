// Calls OpenSSL.
#include "toolchain/tools/gateway/secrets.hpp"

#include <cstdio>
#include <cstdlib>

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/rand.h>
#include <openssl/sha.h>

namespace tappet::network {

namespace {

unsigned char* bytes_of(std::string& text) { return reinterpret_cast<unsigned char*>(text.data()); }
const unsigned char* bytes_of(std::string_view text) {
    return reinterpret_cast<const unsigned char*>(text.data());
}

constexpr std::uint64_t most_memory = 64u << 20;

} // namespace

bool is_affordable(const Cost& cost) {
    const bool is_power = cost.n > 1 && (cost.n & (cost.n - 1)) == 0;
    return is_power && cost.r >= 1 && cost.r <= 64 && cost.p >= 1 && cost.p <= 64 &&
           std::uint64_t{128} * cost.n * cost.r <= most_memory;
}

std::string random_bytes(std::size_t count) {
    std::string bytes(count, '\0');
    if (RAND_bytes(bytes_of(bytes), static_cast<int>(count)) == 1) return bytes;
    std::fputs("tappet-gateway: the system gives no random numbers; nothing can be secret without them\n",
               stderr);
    std::abort();
}

std::string sha256(std::string_view bytes) {
    std::string digest(SHA256_DIGEST_LENGTH, '\0');
    SHA256(bytes_of(bytes), bytes.size(), bytes_of(digest));
    return digest;
}

bool are_equal(std::string_view one, std::string_view other) {
    return one.size() == other.size() && CRYPTO_memcmp(one.data(), other.data(), one.size()) == 0;
}

std::string scrypt(std::string_view password, std::string_view salt, const Cost& cost) {
    std::string key(32, '\0');
    const bool done = EVP_PBE_scrypt(password.data(), password.size(), bytes_of(salt), salt.size(), cost.n,
                                     cost.r, cost.p, 2 * most_memory, bytes_of(key), key.size()) == 1;
    return done ? key : std::string{};
}

} // namespace tappet::network
