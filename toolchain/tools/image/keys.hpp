// SPDX-License-Identifier: Apache-2.0
// The keys of who makes a machine's images: one pair signs updates, three are UEFI's (platform key, key
// exchange key, and db, which signs what boots).
#pragma once

#include "board/box/update.hpp"

#include <filesystem>
#include <vector>

namespace tappet::image {

/// All of them anew into a folder, unless some are there. `public`, `*.crt` and `*.cer` may be shown to
/// everybody; `secret` and `*.key` sign, and stay with their maker.
void write_keys(const std::filesystem::path& folder);

/// In 64 hexadecimal digits; a fault: there is none.
[[nodiscard]] std::string public_key(const std::filesystem::path& folder);
/// Whether what signs lies there too.
[[nodiscard]] bool can_sign(const std::filesystem::path& folder);
[[nodiscard]] box::SecretKey secret_key(const std::filesystem::path& folder);

/// A program of UEFI, signed in its place by db. The same in makes the same out.
void sign_program(const std::filesystem::path& program, const std::filesystem::path& folder);

/// What the box's setup is given once, in the order in which it takes them: db.cer, KEK.cer, PK.cer.
[[nodiscard]] std::vector<std::filesystem::path> certificates(const std::filesystem::path& folder);

} // namespace tappet::image
