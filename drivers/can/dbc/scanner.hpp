// Reads the characters of a DBC file forward: words, numbers, and quoted texts.
#pragma once

#include "kernel/base/digits.hpp"

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tappet::can::dbc {

constexpr bool is_word_character(char c) noexcept {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || is_digit(c);
}
constexpr bool is_blank(char c) noexcept { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

/// Calls visit(name) for each name of a list as in the file: "a, b c".
template <class Visit> constexpr void for_each_name(std::string_view list, const Visit& visit) {
    std::size_t from = 0;
    for (std::size_t i = 0; i <= list.size(); ++i) {
        if (i < list.size() && is_word_character(list[i])) continue;
        if (i > from) visit(list.substr(from, i - from));
        from = i + 1;
    }
}
constexpr bool names(std::string_view list, std::string_view name) noexcept {
    bool found = false;
    for_each_name(list, [&](std::string_view each) { found |= each == name; });
    return found;
}

/// Each call moves to the next item; a call that does not match leaves the position unchanged.
class Scanner {
public:
    constexpr Scanner() = default;
    explicit constexpr Scanner(std::string_view text) noexcept : text_{text} { skip_blanks(); }

    [[nodiscard]] constexpr std::size_t at() const noexcept { return at_; }
    [[nodiscard]] constexpr bool at_end() const noexcept { return at_ == text_.size(); }
    [[nodiscard]] constexpr char next() const noexcept { return at_end() ? '\0' : text_[at_]; }
    /// Returns whether only blanks are before the position in its line.
    [[nodiscard]] constexpr bool begins_line() const noexcept {
        std::size_t i = at_;
        while (i != 0 && (text_[i - 1] == ' ' || text_[i - 1] == '\t')) --i;
        return i == 0 || text_[i - 1] == '\n' || text_[i - 1] == '\r';
    }
    constexpr bool take(char c) noexcept {
        if (next() != c || at_end()) return false;
        ++at_;
        skip_blanks();
        return true;
    }
    /// Takes a name or a keyword; returns an empty one when there is none.
    constexpr std::string_view word() noexcept {
        const std::size_t from = at_;
        if (is_digit(next())) return {};
        const char* const characters = text_.data();
        const std::size_t size = text_.size();
        std::size_t i = from;
        while (i != size && is_word_character(characters[i])) ++i;
        at_ = i;
        return ended(from);
    }
    /// Returns what word() would return, without moving.
    [[nodiscard]] constexpr std::string_view peek() const noexcept { return Scanner{*this}.word(); }
    /// Takes a whole number; returns false when there is none, or one of more than 64 bits.
    constexpr bool whole(std::uint64_t& into) noexcept {
        std::uint64_t value = 0;
        std::size_t i = at_;
        for (; i != text_.size() && is_digit(text_[i]); ++i)
            if (__builtin_mul_overflow(value, 10u, &value) ||
                __builtin_add_overflow(value, static_cast<unsigned>(text_[i] - '0'), &value))
                return false;
        if (i == at_ || (i != text_.size() && is_word_character(text_[i]))) return false;
        at_ = i;
        skip_blanks();
        into = value;
        return true;
    }
    constexpr bool integer(std::int64_t& into) noexcept {
        const Scanner before = *this;
        const bool negative = next() == '-';
        if (negative || next() == '+') ++at_;
        std::uint64_t size = 0;
        if (!whole(size) || size > most_size + (negative ? 1 : 0)) {
            *this = before;
            return false;
        }
        into = static_cast<std::int64_t>(negative ? ~size + 1 : size);
        return true;
    }
    /// Takes a real: "-40", "0.1", "1E-05". Returns false without one, or when a double cannot hold it.
    constexpr bool real(double& into) noexcept {
        std::size_t i = at_;
        const auto here = [&] { return i == text_.size() ? '\0' : text_[i]; };
        const bool negative = here() == '-';
        if (negative || here() == '+') ++i;
        std::uint64_t digits = 0;
        int exponent = 0;
        std::size_t count = 0;
        const auto take_digits = [&](bool after_point) {
            for (; is_digit(here()); ++i, ++count) {
                const auto digit = static_cast<std::uint64_t>(here() - '0');
                if (digits > (most_size - digit) / 10) {
                    if (!after_point && exponent < far) ++exponent; // digits beyond the precision
                } else {
                    digits = digits * 10 + digit;
                    if (after_point && exponent > -far) --exponent;
                }
            }
        };
        take_digits(false);
        if (here() == '.') {
            ++i;
            take_digits(true);
        }
        if (count == 0) return false;
        if (here() == 'e' || here() == 'E') {
            ++i;
            const bool down = here() == '-';
            if (down || here() == '+') ++i;
            if (!is_digit(here())) return false;
            int power = 0;
            for (; is_digit(here()); ++i)
                if (power < far) power = power * 10 + (here() - '0');
            exponent += down ? -power : power;
        }
        if (is_word_character(here()) || here() == '.') return false;
        int magnitude = exponent; // the value is less than 10^magnitude
        for (std::uint64_t left = digits; left != 0; left /= 10) ++magnitude;
        if (digits != 0 && magnitude > 308) return false;
        const double size = magnitude < -300 ? 0 : real_of(digits, exponent);
        into = negative ? -size : size;
        at_ = i;
        skip_blanks();
        return true;
    }
    /// Takes the text between quotes, with escapes unchanged. Returns false when there is none, or when it
    /// does not end in its line, or, with `of_many_lines`, in the file.
    constexpr bool text(std::string_view& into, bool of_many_lines = false) noexcept {
        if (next() != '"') return false;
        std::size_t i = at_ + 1;
        for (; i != text_.size() && text_[i] != '"'; ++i) {
            if (text_[i] == '\n' && !of_many_lines) return false;
            if (text_[i] == '\\' && i + 1 != text_.size() && text_[i + 1] == '"') ++i;
        }
        if (i == text_.size()) return false;
        into = text_.substr(at_ + 1, i - at_ - 1);
        at_ = i + 1;
        skip_blanks();
        return true;
    }
    /// Moves behind the next semicolon outside of texts. Returns false when a text or the statement does not
    /// end; the position is then at that text, or at the end.
    constexpr bool skip_statement() noexcept {
        std::string_view ignored;
        while (!at_end()) {
            if (take(';')) return true;
            if (next() == '"') {
                if (!text(ignored, true)) return false;
            } else {
                ++at_;
                skip_blanks();
            }
        }
        return false;
    }
    /// Returns the beginning of the next item, for messages.
    [[nodiscard]] constexpr std::string_view found() const noexcept {
        constexpr std::size_t most = 24;
        std::size_t end = at_;
        while (end != text_.size() && end - at_ < most && !is_blank(text_[end])) ++end;
        return text_.substr(at_, end - at_);
    }
    /// Returns the text from an earlier position to the present one, without blanks at the end.
    [[nodiscard]] constexpr std::string_view since(std::size_t from) const noexcept {
        std::size_t end = at_;
        while (end > from && is_blank(text_[end - 1])) --end;
        return text_.substr(from, end - from);
    }

private:
    static constexpr std::uint64_t most_size = 0x7fff'ffff'ffff'ffff;
    static constexpr int far = 9999;

    constexpr void skip_blanks() noexcept {
        const char* const characters = text_.data(); // calls cost time in a constant expression
        const std::size_t size = text_.size();
        std::size_t i = at_;
        for (; i != size; ++i)
            if (const char c = characters[i]; c != ' ' && c != '\n' && c != '\t' && c != '\r') break;
        at_ = i;
    }
    constexpr std::string_view ended(std::size_t from) noexcept {
        const std::string_view word = text_.substr(from, at_ - from);
        skip_blanks();
        return word;
    }

    std::string_view text_{};
    std::size_t at_ = 0;
};

} // namespace tappet::can::dbc
