// Texts of a DBC file as UTF-8: what was Windows' code page 1252, escapes, and units as they are spelled
// here.
#pragma once

#include "kernel/base/utf8.hpp"

#include <array>
#include <cstdint>
#include <string_view>

namespace tappet::can::dbc {

/// Code points of the bytes 80 to 9f; the five that mean nothing stay as they are.
inline constexpr std::array<std::uint16_t, 32> cp1252_high = {
    0x20AC, 0x81,   0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160,
    0x2039, 0x0152, 0x8D,   0x017D, 0x8F,   0x90,   0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
    0x2013, 0x2014, 0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0x9D,   0x017E, 0x0178};

/// Calls put(piece) for the text's pieces. A text that is UTF-8 already, as some tools write it, stays so.
template <class Put> constexpr void put_as_utf8(std::string_view raw, const Put& put) {
    bool is_utf8 = true;
    for (std::string_view left = raw; !left.empty() && is_utf8;) {
        const std::size_t length = utf8_length(left);
        is_utf8 = length != 0;
        left.remove_prefix(length);
    }
    for (std::size_t i = 0; i < raw.size(); ++i) {
        if (raw[i] == '\\' && i + 1 < raw.size() && raw[i + 1] == '"') continue;
        const auto byte = static_cast<std::uint8_t>(raw[i]);
        if (is_utf8 || byte < 0x80) {
            const std::size_t bytes = is_utf8 ? utf8_length(raw.substr(i)) : 1;
            put(raw.substr(i, bytes));
            i += bytes - 1;
            continue;
        }
        char character[4] = {};
        const std::size_t bytes = put_utf8(byte < 0xa0 ? cp1252_high[byte - 0x80u] : byte, character);
        put(std::string_view{character, bytes});
    }
}

/// Likewise of a unit. "°C" is degC here, "Nm" is N m, "1/min" is rpm; a unit that is none stays as it is.
template <class Put> constexpr void put_unit(std::string_view raw, const Put& put) {
    constexpr std::string_view spelled[][2] = {{"Nm", "N m"},    {"kNm", "kN m"},   {"mNm", "mN m"},
                                               {"1/min", "rpm"}, {"U/min", "rpm"},  {"min-1", "rpm"},
                                               {"sec", "s"},     {"degree", "deg"}, {"degrees", "deg"}};
    for (const auto& each : spelled)
        if (raw == each[0]) return put(each[1]);
    bool waiting = false; // a degree sign, for its C
    put_as_utf8(raw, [&](std::string_view piece) {
        if (waiting) {
            waiting = false;
            if (piece == "C") return put("degC");
            put("deg");
        }
        if (piece == "\u00B0")
            waiting = true;
        else if (piece == "\u00B5" || piece == "\u03BC")
            put("u");
        else if (piece == "\u00B2")
            put("2");
        else if (piece == "\u00B3")
            put("3");
        else
            put(piece);
    });
    if (waiting) put("deg");
}

} // namespace tappet::can::dbc
