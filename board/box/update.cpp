// SPDX-License-Identifier: Apache-2.0
// A header of one page: a magic word, lines, of which the last one is a signature over those before it, and a
// signature over everything but itself, with the kernel.
#include "board/box/update.hpp"

#include "board/box/facts.hpp"

#include <sodium.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace tappet::box {

namespace {

constexpr std::string_view mark = "tappet-update 1\n";
constexpr std::string_view proof = "proof ";
constexpr std::size_t signed_bytes = update_header_bytes - crypto_sign_BYTES;

const unsigned char* bytes_of(std::string_view text) {
    return reinterpret_cast<const unsigned char*>(text.data());
}

void take_in(crypto_sign_state& state, std::string_view header, std::string_view kernel) {
    crypto_sign_init(&state);
    crypto_sign_update(&state, bytes_of(header), signed_bytes);
    crypto_sign_update(&state, bytes_of(kernel), kernel.size());
}

std::uint64_t number(const Facts& facts, std::string_view word) {
    return std::strtoull(facts.one(word).c_str(), nullptr, 10);
}

std::string sign_text(std::string_view text, const SecretKey& key) {
    std::array<unsigned char, crypto_sign_BYTES> signature{};
    crypto_sign_detached(signature.data(), nullptr, bytes_of(text), text.size(), key.data());
    std::array<char, 2 * crypto_sign_BYTES + 1> digits{};
    sodium_bin2hex(digits.data(), digits.size(), signature.data(), signature.size());
    return digits.data();
}

bool is_signed_text(std::string_view text, std::string_view digits, const PublicKey& key) {
    std::array<unsigned char, crypto_sign_BYTES> bytes{};
    std::size_t length = 0;
    return sodium_hex2bin(bytes.data(), bytes.size(), digits.data(), digits.size(), nullptr, &length,
                          nullptr) == 0 &&
           length == bytes.size() && digits.size() == 2 * bytes.size() &&
           crypto_sign_verify_detached(bytes.data(), bytes_of(text), text.size(), key.data()) == 0;
}

/// Returns the BLAKE2b checksum.
std::string sum_of(std::string_view kernel) {
    std::array<unsigned char, crypto_generichash_BYTES> sum{};
    crypto_generichash(sum.data(), sum.size(), bytes_of(kernel), kernel.size(), nullptr, 0);
    std::array<char, 2 * crypto_generichash_BYTES + 1> digits{};
    sodium_bin2hex(digits.data(), digits.size(), sum.data(), sum.size());
    return digits.data();
}

Facts lines_of(std::string_view header) {
    header = header.substr(mark.size(), signed_bytes - mark.size());
    return Facts{header.substr(0, header.find('\0'))};
}

} // namespace

KeyPair new_keys() {
    KeyPair keys;
    if (sodium_init() < 0) std::abort(); // the kernel has no random numbers
    crypto_sign_keypair(keys.open.data(), keys.secret.data());
    return keys;
}

std::expected<PublicKey, std::string> key_of(std::string_view digits) {
    PublicKey key{};
    std::size_t length = 0;
    if (sodium_hex2bin(key.data(), key.size(), digits.data(), digits.size(), nullptr, &length, nullptr) !=
            0 ||
        length != key.size() || digits.size() != 2 * key.size())
        return std::unexpected("\"" + std::string{digits} + "\" is not a key of 64 hexadecimal digits");
    return key;
}

std::string digits_of(const PublicKey& key) {
    std::array<char, 2 * std::tuple_size_v<PublicKey> + 1> digits{};
    sodium_bin2hex(digits.data(), digits.size(), key.data(), key.size());
    return digits.data();
}

std::uint64_t claimed_bytes(std::string_view header) {
    if (header.size() < update_header_bytes || !header.starts_with(mark)) return 0;
    return std::min(number(lines_of(header), "kernel"), most_update_bytes) + update_header_bytes;
}

std::string header_of(const Update& update, const SecretKey* key) {
    const Manifest& of = update.manifest;
    std::string header{mark};
    header += "machine " + of.machine + "\nboard " + of.board + "\nlayout " + of.layout + "\nimage " +
              std::to_string(of.version) + "\nleast " + std::to_string(of.least) + "\nkernel " +
              std::to_string(update.kernel.size()) + "\nsum " + sum_of(update.kernel) + "\n";
    if (key != nullptr) header += std::string{proof} + sign_text(header, *key) + "\n";
    header.resize(signed_bytes, '\0');
    std::array<unsigned char, crypto_sign_BYTES> signature{};
    if (key != nullptr) {
        crypto_sign_state state;
        take_in(state, header, update.kernel);
        crypto_sign_final_create(&state, signature.data(), nullptr, key->data());
    }
    return header.append(reinterpret_cast<const char*>(signature.data()), signature.size());
}

Manifest manifest_of(std::string_view header) {
    if (claimed_bytes(header) == 0) return {};
    const Facts facts = lines_of(header);
    return {facts.one("machine"), facts.one("board"), facts.one("layout"),
            static_cast<std::uint32_t>(number(facts, "image")),
            static_cast<std::uint32_t>(number(facts, "least"))};
}

bool has_signed_header(std::string_view header, const PublicKey& key) {
    if (claimed_bytes(header) == 0) return false;
    const std::string_view lines = header.substr(0, signed_bytes);
    const std::size_t at = lines.find(std::string{"\n"} + std::string{proof});
    if (at == std::string_view::npos) return false;
    const std::string_view digits = lines.substr(at + 1 + proof.size(), 2 * crypto_sign_BYTES);
    const std::string_view rest = lines.substr(at + 1 + proof.size() + digits.size());
    return rest.starts_with('\n') && rest.find_first_not_of('\0', 1) == std::string_view::npos &&
           is_signed_text(lines.substr(0, at + 1), digits, key);
}

bool is_of(std::string_view header, std::string_view kernel) {
    if (claimed_bytes(header) == 0) return true;
    const std::string sum = lines_of(header).one("sum");
    return sum.empty() || sum == sum_of(kernel);
}

std::string encode(const Update& update, const SecretKey& key) {
    return header_of(update, &key) + update.kernel;
}

std::expected<Update, std::string> decode(std::string_view bytes, const PublicKey& key) {
    const std::uint64_t claimed = claimed_bytes(bytes);
    if (claimed == 0) return std::unexpected("it is not an update");
    if (claimed != bytes.size()) return std::unexpected("it is incomplete");
    const std::string_view kernel = bytes.substr(update_header_bytes);
    crypto_sign_state state;
    take_in(state, bytes, kernel);
    std::array<unsigned char, crypto_sign_BYTES> signature{};
    std::memcpy(signature.data(), bytes.data() + signed_bytes, signature.size());
    if (crypto_sign_final_verify(&state, signature.data(), key.data()) != 0)
        return std::unexpected(
            "its signature does not match this box's key: it is somebody else's, or damaged");
    return Update{manifest_of(bytes), std::string{kernel}, std::string{bytes.substr(0, update_header_bytes)}};
}

std::string refusal_of(const Manifest& offered, const Manifest& own) {
    if (offered.machine != own.machine || offered.board != own.board)
        return "it is for " + offered.machine + " on board " + offered.board + ", and this is " +
               own.machine + " on board " + own.board;
    if (offered.version <= own.version)
        return "it is version " + std::to_string(offered.version) + ", and this box has " +
               std::to_string(own.version);
    if (own.version < offered.least)
        return "it wants version " + std::to_string(offered.least) + " before it, and this box has " +
               std::to_string(own.version);
    return {};
}

namespace {

std::string text_of(const Order& order) {
    return "tappet-order 1\n" + order.verb + "\n" + order.machine + "\n" + order.board + "\n" + order.nonce +
           "\n";
}

} // namespace

std::string sign(const Order& order, const SecretKey& key) { return sign_text(text_of(order), key); }

bool is_signed(const Order& order, std::string_view signature, const PublicKey& key) {
    return !order.nonce.empty() && is_signed_text(text_of(order), signature, key);
}

} // namespace tappet::box
