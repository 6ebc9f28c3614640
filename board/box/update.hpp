// SPDX-License-Identifier: Apache-2.0
// A new version as one file, signed: what it is for, and the unified kernel image of a slot. It is written
// raw onto a stick, so that a box reads no file system that a stranger made.
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
    std::string layout{};      ///< of the properties that it keeps; another one reads them as far as they fit
    std::uint32_t version = 0; ///< of the image
    std::uint32_t least = 0;   ///< version that a box must have to take it
};

struct Update {
    Manifest manifest{};
    std::string kernel{}; ///< a slot's tappet.efi
    std::string header{}; ///< as it was signed; of one that is made now: empty
};

/// Ed25519: the box has the public one in its image, the maker keeps the other.
using PublicKey = std::array<unsigned char, 32>;
using SecretKey = std::array<unsigned char, 64>;
struct KeyPair {
    PublicKey open{};
    SecretKey secret{};
};
[[nodiscard]] KeyPair new_keys();
/// 64 hexadecimal digits; nothing of any other text.
[[nodiscard]] std::expected<PublicKey, std::string> key_of(std::string_view digits);
[[nodiscard]] std::string digits_of(const PublicKey& key);

inline constexpr std::size_t update_header_bytes = 4096;
inline constexpr std::uint64_t most_update_bytes = 48 * 1024 * 1024; ///< a slot holds no more

/// Whether what stands at the beginning of a disk is an update, and then how long it says that it is: it is
/// not judged yet. Of whatever it says never more
/// than most_update_bytes and a header.
[[nodiscard]] std::uint64_t claimed_bytes(std::string_view header);

/// The header of one page, with two signatures: one over its own lines and one over all. Null: unsigned,
/// which no box takes as an update. Each slot holds its own beside the kernel, to tell what it is.
[[nodiscard]] std::string header_of(const Update& update, const SecretKey* key);
inline constexpr std::string_view header_file = "MANIFEST";
/// What a header says, judged by nobody; empty of what is none.
[[nodiscard]] Manifest manifest_of(std::string_view header);

/// Whether who made the header has the key: what stands in it may be believed before the kernel has come. It
/// says nothing of the kernel; decode() does.
[[nodiscard]] bool has_signed_header(std::string_view header, const PublicKey& key);

/// Whether the header's sum is this kernel's; true of a header without one.
[[nodiscard]] bool is_of(std::string_view header, std::string_view kernel);

[[nodiscard]] std::string encode(const Update& update, const SecretKey& key);
/// The error: who made it does not have the key, or it was changed on its way.
[[nodiscard]] std::expected<Update, std::string> decode(std::string_view bytes, const PublicKey& key);

/// Empty: a box that runs `own` takes it. Else why not.
[[nodiscard]] std::string refusal_of(const Manifest& offered, const Manifest& own);

/// What the image's maker may ask of one box beside an update: the version of the other slot, no settings any
/// more, or whether it can hold the table's claims. `nonce`: of the box since it was switched on, so that an
/// order that was overheard is worth nothing later.
struct Order {
    std::string verb{};
    std::string machine{};
    std::string board{};
    std::string nonce{};
};
inline constexpr std::array<std::string_view, 3> order_verbs{"roll-back", "factory-reset", "measure"};
/// In hexadecimal digits.
[[nodiscard]] std::string sign(const Order& order, const SecretKey& key);
[[nodiscard]] bool is_signed(const Order& order, std::string_view signature, const PublicKey& key);

} // namespace tappet::box
