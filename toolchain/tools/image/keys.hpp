// SPDX-License-Identifier: Apache-2.0
// The image maker's keys: one pair signs updates, three are UEFI's (platform key, key exchange key, and db,
// which signs bootable programs).
#pragma once

#include "board/box/update.hpp"

#include <filesystem>
#include <vector>

namespace tappet::image {

/// Creates all keys in a folder, unless some exist. `public`, `*.crt` and `*.cer` may be published; `secret`
/// and `*.key` sign, and must stay with their owner.
void write_keys(const std::filesystem::path& folder);

/// Returns the key as 64 hexadecimal digits; throws a fault when there is none.
[[nodiscard]] std::string public_key(const std::filesystem::path& folder);
/// Returns whether the secret keys are there too.
[[nodiscard]] bool can_sign(const std::filesystem::path& folder);
[[nodiscard]] box::SecretKey secret_key(const std::filesystem::path& folder);

/// Signs a UEFI program in place with db. The same input gives the same output.
void sign_program(const std::filesystem::path& program, const std::filesystem::path& folder);

/// The certificates for the box's setup, in the order in which it accepts them: db.cer, KEK.cer, PK.cer.
[[nodiscard]] std::vector<std::filesystem::path> certificates(const std::filesystem::path& folder);

} // namespace tappet::image
