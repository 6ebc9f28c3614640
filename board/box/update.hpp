// SPDX-License-Identifier: Apache-2.0
// A new version as one signed file: its manifest, and the unified kernel image of a slot. It is written raw
// to a stick, so that a box never reads a file system made by a stranger.
#pragma once

#include <array>
#include <cstdint>
#include <expected>
#include <string>
#include <string_view>

namespace tappet::box {

struct Manifest {
    std::string machine{};
    std::string board{};
    std::string layout{};      ///< of its properties; another layout reads those that match
    std::uint32_t version = 0; ///< of the image
    std::uint32_t least = 0;   ///< lowest version that a box must have to accept it
};

struct Update {
    Manifest manifest{};
    std::string kernel{}; ///< a slot's tappet.efi
    std::string header{}; ///< as signed; empty for one that is being made
};

/// Ed25519: the box has the public key in its image, the manufacturer keeps the secret one.
using PublicKey = std::array<unsigned char, 32>;
using SecretKey = std::array<unsigned char, 64>;
struct KeyPair {
    PublicKey open{};
    SecretKey secret{};
};
[[nodiscard]] KeyPair new_keys();
/// Reads a key from 64 hexadecimal digits; the error: any other text.
[[nodiscard]] std::expected<PublicKey, std::string> key_of(std::string_view digits);
[[nodiscard]] std::string digits_of(const PublicKey& key);

inline constexpr std::size_t update_header_bytes = 4096;
inline constexpr std::uint64_t most_update_bytes = 48 * 1024 * 1024; ///< capacity of a slot

/// Returns the length that the update at the beginning of a disk claims, not verified; 0 when it is none.
/// Never more than most_update_bytes and a header.
[[nodiscard]] std::uint64_t claimed_bytes(std::string_view header);

/// Returns the header of one page, with two signatures: one over its own lines and one over everything. A
/// null key makes it unsigned; no box accepts that as an update. Each slot keeps its header next to the
/// kernel, to identify it.
[[nodiscard]] std::string header_of(const Update& update, const SecretKey* key);
inline constexpr std::string_view header_file = "MANIFEST";
/// Returns the contents of a header without verification; empty when it is not one.
[[nodiscard]] Manifest manifest_of(std::string_view header);

/// Returns whether the header is signed with the key, so that its contents can be trusted before the kernel
/// has arrived. It does not verify the kernel; decode() does.
[[nodiscard]] bool has_signed_header(std::string_view header, const PublicKey& key);

/// Returns whether the header's checksum matches this kernel; true when the header has none.
[[nodiscard]] bool is_of(std::string_view header, std::string_view kernel);

[[nodiscard]] std::string encode(const Update& update, const SecretKey& key);
/// Verifies and reads an update. The error: it was not signed with the key, or was changed in transit.
[[nodiscard]] std::expected<Update, std::string> decode(std::string_view bytes, const PublicKey& key);

/// Returns why a box that runs `own` refuses it; empty: it accepts it.
[[nodiscard]] std::string refusal_of(const Manifest& offered, const Manifest& own);

/// An order by the image's manufacturer to one box: use the other slot's version, delete the settings, or
/// measure whether it can meet the table's claims. `nonce` identifies the box's present power cycle, so that
/// a recorded order is useless later.
struct Order {
    std::string verb{};
    std::string machine{};
    std::string board{};
    std::string nonce{};
};
inline constexpr std::array<std::string_view, 3> order_verbs{"roll-back", "factory-reset", "measure"};
/// Returns the signature in hexadecimal digits.
[[nodiscard]] std::string sign(const Order& order, const SecretKey& key);
[[nodiscard]] bool is_signed(const Order& order, std::string_view signature, const PublicKey& key);

} // namespace tappet::box
