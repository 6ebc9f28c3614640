// Texts of a DBC file as UTF-8: converted from Windows code page 1252, with escapes, and units in this
// project's spelling.
#pragma once

#include "kernel/base/code_page.hpp"
#include "kernel/base/utf8.hpp"

#include <cstdint>
#include <string_view>

namespace tappet::can::dbc {

/// Returns the code point of a byte; an undefined byte stays unchanged.
constexpr std::uint32_t code_point_of(std::uint8_t byte) noexcept {
    const std::uint32_t code = code_point_of_1252(byte);
    return code != 0 ? code : byte;
}

/// Calls put(piece) for the text's pieces. A text that is already UTF-8, as some tools write it, stays
/// unchanged.
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
        const std::size_t bytes = put_utf8(code_point_of(byte), character);
        put(std::string_view{character, bytes});
    }
}

/// Does the same for a unit. "°C" becomes degC, "Nm" N m, "1/min" rpm; an unknown unit stays unchanged.
template <class Put> constexpr void put_unit(std::string_view raw, const Put& put) {
    constexpr std::string_view spelled[][2] = {{"Nm", "N m"},    {"kNm", "kN m"},   {"mNm", "mN m"},
                                               {"1/min", "rpm"}, {"U/min", "rpm"},  {"min-1", "rpm"},
                                               {"sec", "s"},     {"degree", "deg"}, {"degrees", "deg"}};
    for (const auto& each : spelled)
        if (raw == each[0]) return put(each[1]);
    bool waiting = false; // a degree sign that may have a C after it
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
