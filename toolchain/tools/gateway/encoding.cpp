// Converts texts of the network in both directions.
#include "toolchain/tools/gateway/encoding.hpp"

#include "kernel/base/utf8.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace tappet::network {

namespace {

constexpr std::string_view plain_digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::string_view address_digits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";

int hex_digit(char character) {
    if (character >= '0' && character <= '9') return character - '0';
    if (character >= 'a' && character <= 'f') return character - 'a' + 10;
    if (character >= 'A' && character <= 'F') return character - 'A' + 10;
    return -1;
}

std::optional<std::string> from_percent(std::string_view text) {
    std::string all;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            all += text[i] == '+' ? ' ' : text[i];
            continue;
        }
        const int high = i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
        const int low = i + 2 < text.size() ? hex_digit(text[i + 2]) : -1;
        if (high < 0 || low < 0) return std::nullopt;
        all += static_cast<char>(high * 16 + low);
        i += 2;
    }
    return all;
}

} // namespace

std::string to_base64(std::string_view bytes, bool for_addresses) {
    const std::string_view digits = for_addresses ? address_digits : plain_digits;
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t three = 0;
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        for (std::size_t k = 0; k < 3; ++k)
            three = three << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k <= count; ++k) text += digits[three >> (18 - 6 * k) & 63];
        if (!for_addresses) text.append(3 - count, '=');
    }
    return text;
}

std::optional<std::string> from_base64(std::string_view text) {
    if (text.size() % 4 != 0) return std::nullopt;
    std::size_t padding = 0;
    while (padding < 2 && padding < text.size() && text[text.size() - 1 - padding] == '=') ++padding;
    std::string bytes;
    std::uint32_t held = 0;
    unsigned bits = 0;
    for (const char character : text.substr(0, text.size() - padding)) {
        const std::size_t digit = plain_digits.find(character);
        if (digit == std::string_view::npos) return std::nullopt;
        held = held << 6 | static_cast<std::uint32_t>(digit);
        bits += 6;
        if (bits < 8) continue;
        bits -= 8;
        bytes += static_cast<char>(held >> bits & 255);
    }
    const bool whole = (held & ((1u << bits) - 1)) == 0;
    return whole ? std::optional{bytes} : std::nullopt;
}

std::string to_hex(std::string_view bytes) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::string text;
    for (const char byte : bytes) {
        text += digits[static_cast<unsigned char>(byte) >> 4];
        text += digits[static_cast<unsigned char>(byte) & 15];
    }
    return text;
}

std::optional<std::vector<std::pair<std::string, std::string>>> from_form(std::string_view text) {
    std::vector<std::pair<std::string, std::string>> fields;
    while (!text.empty()) {
        const std::string_view field = text.substr(0, text.find('&'));
        text.remove_prefix(std::min(text.size(), field.size() + 1));
        const std::size_t equals = std::min(field.find('='), field.size());
        auto name = from_percent(field.substr(0, equals));
        auto value = from_percent(field.substr(std::min(equals + 1, field.size())));
        if (!name || !value || fields.size() == 16) return std::nullopt;
        fields.emplace_back(std::move(*name), std::move(*value));
    }
    return fields;
}

std::optional<std::string> cookie_of(std::string_view header, std::string_view name) {
    std::optional<std::string> found;
    while (!header.empty()) {
        std::string_view each = header.substr(0, header.find(';'));
        header.remove_prefix(std::min(header.size(), each.size() + 1));
        while (each.starts_with(' ')) each.remove_prefix(1);
        if (!each.starts_with(name) || each.substr(name.size(), 1) != "=") continue;
        if (found) return std::nullopt;
        found = each.substr(name.size() + 1);
    }
    return found;
}

std::string in_html(std::string_view text) {
    std::string all;
    for (const char character : text) switch (character) {
        case '<': all += "&lt;"; break;
        case '>': all += "&gt;"; break;
        case '&': all += "&amp;"; break;
        case '"': all += "&quot;"; break;
        case '\'': all += "&#39;"; break;
        default: all += character;
        }
    return all;
}

std::string as_utf8(std::string_view text) {
    std::string all;
    while (!text.empty()) {
        const std::size_t length = tappet::utf8_length(text);
        all += length == 0 ? std::string_view{"?"} : text.substr(0, length);
        text.remove_prefix(std::max<std::size_t>(length, 1));
    }
    return all;
}

std::string_view cut(std::string_view text, std::size_t most) {
    if (text.size() <= most) return text;
    while (most > 0 && (static_cast<unsigned char>(text[most]) & 0xC0) == 0x80) --most;
    return text.substr(0, most);
}

} // namespace tappet::network
