// UTF-8 (RFC 3629), as far as needed to tell a text from other bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tappet {

/// Returns the bytes of the first character of a text that is not empty; 0: no valid character begins here.
constexpr std::size_t utf8_length(std::string_view text) noexcept {
    const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
    const std::uint8_t lead = byte(0);
    const std::size_t length = lead < 0x80                   ? 1
                               : lead >= 0xc2 && lead < 0xe0 ? 2
                               : (lead & 0xf0) == 0xe0       ? 3
                               : lead >= 0xf0 && lead < 0xf5 ? 4
                                                             : 0;
    if (length == 0 || text.size() < length) return 0;
    for (std::size_t i = 1; i < length; ++i)
        if ((byte(i) & 0xc0) != 0x80) return 0;
    const bool overlong = (lead == 0xe0 && byte(1) < 0xa0) || (lead == 0xf0 && byte(1) < 0x90);
    const bool surrogate = lead == 0xed && byte(1) >= 0xa0;
    const bool too_large = lead == 0xf4 && byte(1) >= 0x90;
    return overlong || surrogate || too_large ? 0 : length;
}

/// Writes a character, a code point below 0x110000 that is not a surrogate. Returns its bytes, at most 4.
constexpr std::size_t put_utf8(std::uint32_t code, char* into) noexcept {
    if (code < 0x80) {
        into[0] = static_cast<char>(code);
        return 1;
    }
    const std::size_t length = code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
    constexpr std::uint32_t leads[] = {0, 0, 0xc0, 0xe0, 0xf0};
    for (std::size_t i = length; i-- > 1; code >>= 6) into[i] = static_cast<char>(0x80 | (code & 0x3f));
    into[0] = static_cast<char>(leads[length] | code);
    return length;
}

} // namespace tappet
