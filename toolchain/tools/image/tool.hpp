// SPDX-License-Identifier: Apache-2.0
// Faults, and the external programs that do a part of the work.
#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::image {

/// The text names what, where and the cure.
struct Fault : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The fixed clock of those programs, in seconds: 1980-01-02, because a FAT has no earlier date.
inline constexpr const char* standing_clock = "315619200";

/// Runs a program of this machine under a fixed clock, so that its output does not depend on the time.
/// Returns its standard output; a fault includes its last words.
enum class Trouble : std::uint8_t { is_a_fault, is_told }; ///< told: the caller reads it in the output
std::string run_tool(const std::vector<std::string>& words, Trouble trouble = Trouble::is_a_fault);

std::string read_file(const std::filesystem::path& path);
void write_file(const std::filesystem::path& path, std::string_view bytes);

} // namespace tappet::image
