// Any text as a literal of C++.
#pragma once

#include <string>
#include <string_view>

namespace tappet::tables {

/// Returns the literal with its quotes. Bytes that are no ASCII are escapes, so that compilers read none.
inline std::string cpp_literal(std::string_view text) {
    std::string literal = "\"";
    for (const char each : text) {
        const auto byte = static_cast<unsigned char>(each);
        if (byte >= ' ' && byte < 0x7F && each != '"' && each != '\\' && each != '?') {
            literal += each;
            continue;
        }
        literal += '\\';
        for (const int shift : {6, 3, 0}) literal += static_cast<char>('0' + (byte >> shift & 7));
    }
    return literal + '"';
}

} // namespace tappet::tables
