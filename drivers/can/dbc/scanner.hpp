// Reads the characters of a DBC file forward: words, numbers, and quoted texts.
#pragma once

#include "kernel/base/digits.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>

namespace tappet::can::dbc {

constexpr bool is_word_character(char c) noexcept {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || is_digit(c);
}
constexpr bool is_blank(char c) noexcept { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

/// Returns the text without the byte-order mark of UTF-8.
constexpr std::string_view without_mark(std::string_view text) noexcept {
    constexpr std::string_view mark = "\xEF\xBB\xBF";
    return text.starts_with(mark) ? text.substr(mark.size()) : text;
}

/// Calls visit(name) for each name of a list as in the file: "a, b c", and comments.
template <class Visit> constexpr void for_each_name(std::string_view list, const Visit& visit) {
    std::size_t from = 0;
    for (std::size_t i = 0; i <= list.size(); ++i) {
        if (i < list.size() && is_word_character(list[i])) continue;
        if (i > from) visit(list.substr(from, i - from));
        if (i + 1 < list.size() && list[i] == '/' && list[i + 1] == '/')
            while (i + 1 < list.size() && list[i + 1] != '\n') ++i;
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
    explicit constexpr Scanner(std::string_view text) noexcept
        : text_{text}, at_{text.size() - without_mark(text).size()} {
        skip_blanks();
    }

    [[nodiscard]] constexpr std::size_t at() const noexcept { return at_; }
    [[nodiscard]] constexpr bool at_end() const noexcept { return at_ == text_.size(); }
    [[nodiscard]] constexpr char next() const noexcept { return at_end() ? '\0' : text_[at_]; }
    /// Returns whether only blanks are before the position in its line.
    [[nodiscard]] constexpr bool begins_line() const noexcept {
        std::size_t i = at_;
        while (i != 0 && (text_[i - 1] == ' ' || text_[i - 1] == '\t')) --i;
        return i == 0 || text_[i - 1] == '\n' || text_[i - 1] == '\r';
    }
    /// Returns whether only blanks are between `at` and the beginning of its line, or a ';', or whether that
    /// part begins with the word `in`.
    [[nodiscard]] constexpr bool begins_statement(std::size_t at, std::string_view in = {}) const noexcept {
        std::size_t from = at;
        while (from != 0 && text_[from - 1] != '\n' && text_[from - 1] != '\r' && text_[from - 1] != ';')
            --from;
        if (from == 0) from = text_.size() - without_mark(text_).size();
        while (from < at && is_blank(text_[from])) ++from;
        const std::string_view part = text_.substr(from, at - from);
        return part.empty() ||
               (!in.empty() && part.size() > in.size() && part.starts_with(in) && is_blank(part[in.size()]));
    }
    constexpr bool take(char c) noexcept {
        if (at_ == text_.size() || text_[at_] != c) return false;
        ++at_;
        skip_blanks();
        return true;
    }
    /// Takes a keyword; returns an empty one when there is none.
    constexpr std::string_view word() noexcept { return is_digit(next()) ? std::string_view{} : name(); }
    /// Takes a name, which may begin with a digit; returns an empty one when there is none.
    constexpr std::string_view name() noexcept {
        const std::size_t from = at_;
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
        if (i == at_ || (i != text_.size() && (is_word_character(text_[i]) || text_[i] == '.'))) return false;
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
    /// Takes a real: "-40", "0.1", "1E-05"; it is infinite when a double cannot hold it. Returns false
    /// without one.
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
        const double size = digits == 0 || magnitude < -300 ? 0
                            : magnitude > 308               ? huge(digits, exponent, magnitude)
                                                            : real_of(digits, exponent);
        into = negative ? -size : size;
        at_ = i;
        skip_blanks();
        return true;
    }
    /// Takes the text between quotes, with escapes unchanged. Returns false when there is none, or when it
    /// does not end in its line, or, with `of_many_lines`, in the file.
    constexpr bool text(std::string_view& into, bool of_many_lines = false) noexcept {
        if (next() != '"') return false;
        const char* const characters = text_.data();
        const std::size_t size = text_.size();
        std::size_t i = at_ + 1;
        for (; i != size; ++i) {
            const char c = characters[i];
            if (c == '"') break;
            if (c == '\n' && !of_many_lines) return false;
            if (c == '\\' && i + 1 != size && characters[i + 1] == '"') ++i;
        }
        if (i == size) return false;
        into = text_.substr(at_ + 1, i - at_ - 1);
        at_ = i + 1;
        skip_blanks();
        return true;
    }
    /// Takes "inf" or "nan" in any spelling of C's printf, before `end`.
    constexpr bool no_number(char end) noexcept {
        const Scanner before = *this;
        if (next() == '-' || next() == '+') ++at_;
        const std::string_view written = word();
        for (const std::string_view each : {"inf", "infinity", "nan"}) {
            std::size_t same = 0;
            while (same < each.size() && same < written.size() && (written[same] | 0x20) == each[same])
                ++same;
            if (same == each.size() && same == written.size() && next() == end) return true;
        }
        *this = before;
        return false;
    }
    /// Moves to the next line.
    constexpr void skip_line() noexcept {
        while (!at_end() && text_[at_] != '\n') ++at_;
        skip_blanks();
    }
    enum class End : std::uint8_t {
        semicolon, ///< the position is behind it
        none,      ///< the next line begins a statement
        inside,    ///< the statement contains another one
        unclosed,  ///< a text without its second quote, at `text_at`
        cut,       ///< the file ends in the statement, or in a text, at `text_at`
    };
    /// Moves behind a statement that is passed over. begins(word): the word begins a statement.
    template <class Begins> constexpr End skip_statement(const Begins& begins,
                                                         std::size_t& text_at) noexcept {
        text_at = text_.size();
        while (!at_end()) {
            if (take(';')) return End::semicolon;
            if (next() != '"') {
                const std::string_view word = peek();
                if (word.ends_with('_') && begins(word)) {
                    if (begins_line()) return End::none;
                    // These also say what the statement is about.
                    constexpr std::string_view objects = "BO_ SG_ BU_ EV_ BU_BO_REL_ BU_SG_REL_ BU_EV_REL_";
                    if (!names(objects, word)) return End::inside;
                }
                ++at_;
                while (!at_end() && is_word_character(text_[at_])) ++at_;
                skip_blanks();
                continue;
            }
            text_at = at_;
            Scanner line{*this};
            std::string_view ignored;
            const bool is_closed = text(ignored, true);
            if (is_closed && (next() == ';' || !ignored.contains('\n'))) continue;
            // A text of many lines may have swallowed statements, up to the first quote of another text.
            for (line.skip_line(); !line.at_end() && (line.at_ < at_ || !is_closed); line.skip_line())
                if (begins(line.peek())) return End::unclosed;
            if (!is_closed) return End::cut;
        }
        text_at = text_.size();
        return End::cut;
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

    /// A number near the end of double's range, or beyond it.
    static constexpr double huge(std::uint64_t digits, int exponent, int magnitude) noexcept {
        constexpr double infinite = std::numeric_limits<double>::infinity();
        const double tenth = magnitude > 309 ? infinite : real_of(digits, exponent - 10); // of 10^10
        // Tools write the last double with 15 digits, which are a little more.
        if (tenth > 1.797693134862321e298) return infinite;
        return tenth > 1.797693134862315e298 ? std::numeric_limits<double>::max() : tenth * 1e10;
    }
    /// Skips blanks and comments: // to the end of the line.
    constexpr void skip_blanks() noexcept {
        const char* const characters = text_.data(); // calls cost time in a constant expression
        const std::size_t size = text_.size();
        std::size_t i = at_;
        for (; i != size; ++i) {
            const char c = characters[i];
            if (c == ' ' || c == '\n' || c == '\t' || c == '\r') continue;
            if (c != '/' || i + 1 == size || characters[i + 1] != '/') break;
            while (i + 1 != size && characters[i + 1] != '\n') ++i;
        }
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
