// Writes JSON text into a buffer of fixed size.
#pragma once

#include "kernel/base/real_text.hpp"
#include "kernel/base/utf8.hpp"

#include <algorithm>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

namespace tappet {

/// Appends fields to an object or values to an array. When something does not fit, size() is 0: a text is
/// never truncated.
class JsonText {
public:
    explicit JsonText(std::span<char> buffer) noexcept : buffer_{buffer} {}

    JsonText& open(char bracket) noexcept {
        separate();
        put({&bracket, 1});
        first_ = true;
        return *this;
    }
    JsonText& close(char bracket) noexcept {
        put({&bracket, 1});
        first_ = false;
        return *this;
    }
    /// Writes "key": before a value, an object or an array.
    JsonText& key(std::string_view name) noexcept {
        value(name);
        put(": ");
        first_ = true; // no comma before the value
        return *this;
    }
    JsonText& value(std::string_view text) noexcept {
        separate();
        put("\"");
        while (!text.empty()) {
            const char character = text.front();
            const std::size_t length = utf8_length(text);
            if (character == '"' || character == '\\') put("\\");
            const bool control = static_cast<unsigned char>(character) < 0x20;
            put(control       ? " "
                : length == 0 ? "?"
                              : text.substr(0, length)); // JSON must be UTF-8, whatever the source
            text.remove_prefix(std::max<std::size_t>(length, 1));
        }
        put("\"");
        return *this;
    }
    JsonText& value(const char* text) noexcept { return value(std::string_view{text}); }
    template <class T>
        requires std::integral<T> || std::floating_point<T>
    JsonText& value(T number) noexcept {
        separate();
        if constexpr (std::same_as<T, bool>) {
            put(number ? "true" : "false");
        } else {
            char digits[max_real_text];
            put({digits, format(digits, number)});
        }
        return *this;
    }
    template <class T>
    JsonText& field(std::string_view name, const T& content) noexcept {
        return key(name).value(content);
    }
    /// Appends a whole JSON value that is already text, with a comma before it if needed.
    JsonText& fragment(std::string_view text) noexcept {
        separate();
        put(text);
        return *this;
    }
    JsonText& raw(std::string_view text) noexcept {
        put(text);
        return *this;
    }

    /// Returns the characters written; 0 when they did not all fit.
    [[nodiscard]] std::size_t size() const noexcept { return full_ ? 0 : used_; }
    [[nodiscard]] std::string_view view() const noexcept { return {buffer_.data(), size()}; }

private:
    template <std::size_t N>
    static std::size_t format(char (&digits)[N], double number) noexcept {
        return write_rounded(digits, number, 6);
    }
    template <std::size_t N, std::integral T>
    static std::size_t format(char (&digits)[N], T number) noexcept {
        return static_cast<std::size_t>(std::to_chars(digits, digits + N, number).ptr - digits);
    }
    void separate() noexcept {
        if (!first_) put(", ");
        first_ = false;
    }
    void put(std::string_view text) noexcept {
        if (full_ || used_ + text.size() > buffer_.size()) {
            full_ = true;
            return;
        }
        std::memcpy(buffer_.data() + used_, text.data(), text.size());
        used_ += text.size();
    }

    std::span<char> buffer_;
    std::size_t used_ = 0;
    bool first_ = true;
    bool full_ = false;
};

} // namespace tappet
