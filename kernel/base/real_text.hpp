// Numbers as decimals and back, exactly: the shortest digits that read back as the same number. It uses
// double-conversion, because the standard library's own tables would be the largest part of a firmware.
#pragma once

#include <cstddef>
#include <string_view>

namespace tappet {

/// Length of the longest written number.
inline constexpr std::size_t max_real_text = 32;

/// Writes the shortest decimal that reads back as the same number, as "0.001" or "1e-07", whichever is
/// shorter; "inf", "-inf", "nan", "-nan". `into` has room for max_real_text characters. Returns their number.
/// No heap.
std::size_t write_shortest(char* into, double value) noexcept;
std::size_t write_shortest(char* into, float value) noexcept;
/// Writes a number as printf's %g, with at most 17 `digits`.
std::size_t write_rounded(char* into, double value, int digits) noexcept;

enum class RealTextFault : unsigned char { none, not_a_number, out_of_range };

/// Reads a whole text: "-12", "0.5", ".5", "2e-3"; no spaces, no plus sign; "inf" and "nan" are not numbers.
/// Correctly rounded. A number too large, or too small to differ from zero, is out of range. On a fault
/// `into` is unchanged. No heap.
RealTextFault read_real_text(std::string_view text, double& into) noexcept;
RealTextFault read_real_text(std::string_view text, float& into) noexcept;

} // namespace tappet
