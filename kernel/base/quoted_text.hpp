// The characters between the quotes of a text value, with escapes decoded.
#pragma once

#include "kernel/base/utf8.hpp"

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <system_error>

namespace tappet {

/// Reads from after an opening quote up to the closing one, one character at a time. Escapes are those of
/// JSON, and \\xHH for a byte.
class QuotedText {
public:
    explicit QuotedText(std::string_view text) noexcept : text_{text} {}

    enum class Next : std::uint8_t { characters, end, broken };
    /// Reads the next character, of at most 4 bytes.
    Next take(char (&into)[4], std::size_t& bytes) noexcept {
        bytes = 1;
        if (at_ == text_.size()) return Next::broken;
        const char character = text_[at_++];
        if (character == '"') return Next::end;
        into[0] = character;
        if (character != '\\') return Next::characters;
        if (at_ == text_.size()) return Next::broken;
        switch (const char escape = text_[at_++]) {
        case 'n': into[0] = '\n'; return Next::characters;
        case 't': into[0] = '\t'; return Next::characters;
        case 'r': into[0] = '\r'; return Next::characters;
        case 'b': into[0] = '\b'; return Next::characters;
        case 'f': into[0] = '\f'; return Next::characters;
        case '"':
        case '\\':
        case '/': into[0] = escape; return Next::characters;
        case 'x': {
            std::uint32_t code = 0;
            if (!hexadecimal(2, code)) return Next::broken;
            into[0] = static_cast<char>(code);
            return Next::characters;
        }
        case 'u': return take_code_point(into, bytes);
        default: return Next::broken;
        }
    }
    /// Returns the number of characters read so far, including the closing quote.
    [[nodiscard]] std::size_t taken() const noexcept { return at_; }

private:
    bool hexadecimal(std::size_t digits, std::uint32_t& code) noexcept {
        if (text_.size() - at_ < digits) return false;
        const char* begin = text_.data() + at_;
        const auto done = std::from_chars(begin, begin + digits, code, 16);
        at_ += digits;
        return done.ec == std::errc{} && done.ptr == begin + digits;
    }
    Next take_code_point(char (&into)[4], std::size_t& bytes) noexcept {
        std::uint32_t code = 0;
        if (!hexadecimal(4, code)) return Next::broken;
        if (code >= 0xd800 && code < 0xe000) { // a pair of surrogates, high and low
            std::uint32_t low = 0;
            if (code >= 0xdc00 || text_.substr(at_, 2) != "\\u") return Next::broken;
            at_ += 2;
            if (!hexadecimal(4, low) || low < 0xdc00 || low >= 0xe000) return Next::broken;
            code = 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00);
        }
        bytes = put_utf8(code, into);
        return Next::characters;
    }

    std::string_view text_;
    std::size_t at_ = 0;
};

} // namespace tappet
