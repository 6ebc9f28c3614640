// Windows' code page 1252, in which files of field buses are written, as Unicode.
#pragma once

#include <array>
#include <cstdint>

namespace tappet {

/// Returns the code point of a byte; 0: the code page has none for it.
constexpr std::uint32_t code_point_of_1252(std::uint8_t byte) noexcept {
    constexpr std::array<std::uint16_t, 32> from_80{
        0x20AC, 0,      0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160,
        0x2039, 0x0152, 0,      0x017D, 0,      0,      0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
        0x2013, 0x2014, 0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0,      0x017E, 0x0178};
    return byte >= 0x80 && byte < 0xA0 ? from_80[byte - 0x80u] : byte;
}

} // namespace tappet
