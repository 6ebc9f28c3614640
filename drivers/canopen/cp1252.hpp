// Names in EDS files are in code page 1252, newer ones in UTF-8. Messages are in UTF-8.
#pragma once

#include "kernel/base/code_page.hpp"
#include "kernel/base/text.hpp"
#include "kernel/base/utf8.hpp"

namespace tappet::canopen {

/// Adds a text: valid UTF-8 unchanged, any other byte as a character of the code page.
constexpr void add_readable(Sentence& to, std::string_view text) noexcept {
    while (!text.empty()) {
        if (const std::size_t length = utf8_length(text); length != 0) {
            to.add(text.substr(0, length));
            text.remove_prefix(length);
            continue;
        }
        const auto byte = static_cast<std::uint8_t>(text.front());
        char bytes[4] = {};
        constexpr std::uint32_t replacement = 0xFFFD;
        const std::uint32_t code = code_point_of_1252(byte);
        to.add(std::string_view{bytes, put_utf8(code != 0 ? code : replacement, bytes)});
        text.remove_prefix(1);
    }
}

} // namespace tappet::canopen
