// SPDX-License-Identifier: Apache-2.0
// The file BGENV.DAT of a slot, 132,104 bytes, read by the box's loader, EFI Boot Guard.
#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <string>
#include <string_view>

namespace tappet::init {

/// The loader boots the highest revision that has not failed. Before it boots an `installed` one it sets
/// `testing`. A slot found in `testing` at the next boot has failed: it has only one trial.
enum class SlotState : std::uint8_t { good = 0, installed = 1, testing = 2, failed = 3 };

constexpr std::string_view name_of(SlotState state) noexcept {
    constexpr std::string_view names[] = {"good", "installed for a trial", "on trial", "failed"};
    return names[static_cast<std::size_t>(state) % 4];
}

struct BootState {
    std::string kernel{}; ///< "C:SLOTA:tappet.efi": the label of its partition, and its file
    std::uint32_t revision = 0;
    std::uint16_t watchdog_s = 0; ///< armed by the loader before the kernel; 0: none
    SlotState state = SlotState::good;
};

inline constexpr std::string_view boot_state_file = "BGENV.DAT";

/// Returns the file's contents. The loader's arguments are empty: the kernel's command line is part of the
/// kernel image.
[[nodiscard]] std::string encode(const BootState& state);
/// Reads the file. The error: it is torn, or another file.
[[nodiscard]] std::expected<BootState, std::string> decode(std::string_view bytes);

} // namespace tappet::init
