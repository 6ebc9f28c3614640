// Names in EDS files are of the code page 1252; newer ones of UTF-8. Messages are of UTF-8.
#pragma once

#include "kernel/base/text.hpp"
#include "kernel/base/utf8.hpp"

#include <array>

namespace tappet::canopen {

/// What is valid UTF-8 stays; any other byte is a character of the code page.
constexpr void add_readable(Sentence& to, std::string_view text) noexcept {
    constexpr std::array<std::uint16_t, 32> from_80{
        0x20AC, 0xFFFD, 0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160,
        0x2039, 0x0152, 0xFFFD, 0x017D, 0xFFFD, 0xFFFD, 0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
        0x2013, 0x2014, 0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0xFFFD, 0x017E, 0x0178};
    while (!text.empty()) {
        if (const std::size_t length = utf8_length(text); length != 0) {
            to.add(text.substr(0, length));
            text.remove_prefix(length);
            continue;
        }
        const auto byte = static_cast<std::uint8_t>(text.front());
        char bytes[4] = {};
        const std::uint32_t code = byte < 0xA0 ? from_80[byte - 0x80u] : byte;
        to.add(std::string_view{bytes, put_utf8(code, bytes)});
        text.remove_prefix(1);
    }
}

} // namespace tappet::canopen
