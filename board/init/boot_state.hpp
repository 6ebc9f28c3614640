// SPDX-License-Identifier: Apache-2.0
// What the box's loader, EFI Boot Guard, reads of each slot: the file BGENV.DAT of 132,104 bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <string>
#include <string_view>

namespace tappet::init {

/// The loader boots the highest revision that has not failed. It makes `installed` `testing` before it boots
/// it, and a slot that it finds in `testing` at the next boot has failed: it had one trial.
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

/// The file's bytes. Its loader's arguments are empty: the kernel's command line is a part of what it boots.
[[nodiscard]] std::string encode(const BootState& state);
/// The error: it is torn, or no such file.
[[nodiscard]] std::expected<BootState, std::string> decode(std::string_view bytes);

} // namespace tappet::init
