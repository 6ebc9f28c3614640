// The tokens of the script language: cuts text into tokens, one at a time, in constant expressions and on the
// target alike.
#pragma once

#include "kernel/base/digits.hpp"
#include "kernel/base/time.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tappet::script_detail {

enum class Sign : std::uint8_t {
    end,
    name,
    integer,
    real,
    duration,
    text,
    broken, ///< no token: a character that means nothing, a text or comment without its end, a number too
            ///< large
    // punctuation
    open_brace,
    close_brace,
    open_round,
    close_round,
    open_square,
    close_square,
    comma,
    semicolon,
    dot,
    assign,
    question,
    colon,
    // operators, in the order of binary_levels
    logical_or,
    logical_and,
    equal,
    unequal,
    less,
    at_most,
    greater,
    at_least,
    plus,
    minus,
    times,
    divide,
    remainder,
    invert,
    // keywords
    k_StateMachine,
    k_SubStateMachine,
    k_RootStateMachine,
    k_program,
    k_function,
    k_param,
    k_var,
    k_const,
    k_state,
    k_initial,
    k_final,
    k_entry,
    k_run,
    k_exit,
    k_handle,
    k_transitions,
    k_transition,
    k_precondition,
    k_if,
    k_then,
    k_else,
    k_while,
    k_for,
    k_do,
    k_set,
    k_select,
    k_return,
    k_yield,
    k_wait,
    k_break,
    k_continue,
    k_try,
    k_catch,
    k_timeout,
    k_after,
    k_because,
    k_in,
    k_region,
    k_true,
    k_false,
};

constexpr std::uint32_t hash_of(std::string_view name) noexcept {
    std::uint32_t key = 2166136261u; // FNV-1a
    for (const char character : name) key = (key ^ static_cast<unsigned char>(character)) * 16777619u;
    return key;
}

struct Keyword {
    std::string_view spelled;
    Sign sign;
    std::uint32_t hash = hash_of(spelled);
};

inline constexpr auto keywords = [] {
    std::array<Keyword, 45> all{{{"StateMachine", Sign::k_StateMachine},
                                 {"SubStateMachine", Sign::k_SubStateMachine},
                                 {"RootStateMachine", Sign::k_RootStateMachine},
                                 {"program", Sign::k_program},
                                 {"function", Sign::k_function},
                                 {"param", Sign::k_param},
                                 {"var", Sign::k_var},
                                 {"const", Sign::k_const},
                                 {"state", Sign::k_state},
                                 {"initial", Sign::k_initial},
                                 {"final", Sign::k_final},
                                 {"entry", Sign::k_entry},
                                 {"run", Sign::k_run},
                                 {"exit", Sign::k_exit},
                                 {"handle", Sign::k_handle},
                                 {"transitions", Sign::k_transitions},
                                 {"transition", Sign::k_transition},
                                 {"precondition", Sign::k_precondition},
                                 {"preconditions", Sign::k_precondition},
                                 {"if", Sign::k_if},
                                 {"then", Sign::k_then},
                                 {"else", Sign::k_else},
                                 {"while", Sign::k_while},
                                 {"for", Sign::k_for},
                                 {"do", Sign::k_do},
                                 {"set", Sign::k_set},
                                 {"select", Sign::k_select},
                                 {"return", Sign::k_return},
                                 {"yield", Sign::k_yield},
                                 {"wait", Sign::k_wait},
                                 {"break", Sign::k_break},
                                 {"continue", Sign::k_continue},
                                 {"try", Sign::k_try},
                                 {"catch", Sign::k_catch},
                                 {"timeout", Sign::k_timeout},
                                 {"after", Sign::k_after},
                                 {"because", Sign::k_because},
                                 {"in", Sign::k_in},
                                 {"region", Sign::k_region},
                                 {"true", Sign::k_true},
                                 {"false", Sign::k_false},
                                 {"and", Sign::logical_and},
                                 {"or", Sign::logical_or},
                                 {"not", Sign::invert},
                                 {"mod", Sign::remainder}}};
    std::sort(all.begin(), all.end(), [](const Keyword& a, const Keyword& b) { return a.hash < b.hash; });
    return all;
}();

/// Returns Sign::name when the word is not a keyword.
constexpr Sign sign_of_word(std::string_view word, std::uint32_t hash) noexcept {
    std::size_t low = 0, high = keywords.size();
    while (low < high) {
        const std::size_t middle = (low + high) / 2;
        if (keywords[middle].hash < hash)
            low = middle + 1;
        else
            high = middle;
    }
    return low < keywords.size() && keywords[low].hash == hash && keywords[low].spelled == word
               ? keywords[low].sign
               : Sign::name;
}

struct Token {
    Sign sign = Sign::end;
    std::uint16_t line = 1;
    std::uint16_t column = 1;
    std::uint32_t hash = 0;   ///< of a word
    std::string_view text{};  ///< as written; of a text, the characters between its quotes with their escapes
    std::int64_t integer = 0; ///< of an integer; of a duration its nanoseconds
    double real = 0;          ///< of a real, and of an integer
    std::string_view fault{}; ///< of a broken one

    [[nodiscard]] constexpr bool is_word() const noexcept { return hash != 0; }
};

constexpr bool is_letter(char c) noexcept {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

struct UnitOfTime {
    std::string_view name;
    std::int64_t ns;
};
inline constexpr UnitOfTime units_of_time[] = {{"s", 1'000'000'000},    {"ms", 1'000'000},
                                               {"us", 1'000},           {"ns", 1},
                                               {"min", 60'000'000'000}, {"h", 3'600'000'000'000}};

/// Reads forward; to read a part again, copy the lexer there.
class Lexer {
public:
    constexpr Lexer() = default;
    explicit constexpr Lexer(std::string_view text) noexcept
        : at_{text.data()}, end_{at_ + text.size()}, row_{at_} {}

    /// Reads the next token; after end or broken, the same token again.
    constexpr void next(Token& token) noexcept {
        token.hash = 0;
        if (!skip_blanks()) return make_broken(token, "a comment without its end; write */ after it");
        token.line = line_;
        token.column = column();
        if (at_ == end_) return make(token, Sign::end, 0);
        const char c = *at_;
        if (is_letter(c)) return read_word(token);
        if (is_digit(c) || (c == '.' && end_ - at_ > 1 && is_digit(at_[1]))) return read_number(token);
        if (c == '"') return read_text(token);
        read_sign(token, c);
    }

private:
    constexpr std::uint16_t column() const noexcept {
        return static_cast<std::uint16_t>(std::min<std::ptrdiff_t>(at_ - row_ + 1, 0xffff));
    }
    constexpr void make(Token& token, Sign sign, std::size_t characters) noexcept {
        token.sign = sign;
        token.text = {at_, characters};
        at_ += characters;
    }
    constexpr void make_broken(Token& token, std::string_view fault) noexcept {
        token.line = line_;
        token.column = column();
        token.sign = Sign::broken;
        token.text = {at_, at_ == end_ ? std::size_t{0} : std::size_t{1}};
        token.fault = fault;
    }
    constexpr void new_line() noexcept {
        if (line_ < 0xffff) ++line_;
        row_ = at_ + 1;
    }
    constexpr bool skip_blanks() noexcept {
        while (at_ != end_) {
            const char c = *at_;
            if (c == '\n') {
                new_line();
                ++at_;
            } else if (c == ' ' || c == '\t' || c == '\r') {
                ++at_;
            } else if (c == '#' || (c == '/' && end_ - at_ > 1 && at_[1] == '/')) {
                while (at_ != end_ && *at_ != '\n') ++at_;
            } else if (c == '/' && end_ - at_ > 1 && at_[1] == '*') {
                const char* const from = at_;
                at_ += 2;
                while (end_ - at_ > 1 && !(at_[0] == '*' && at_[1] == '/')) {
                    if (*at_ == '\n') new_line();
                    ++at_;
                }
                if (end_ - at_ < 2) {
                    at_ = from;
                    return false;
                }
                at_ += 2;
            } else {
                return true;
            }
        }
        return true;
    }
    constexpr void read_word(Token& token) noexcept {
        const char* const from = at_;
        std::uint32_t key = 2166136261u;
        const char* p = at_;
        while (p != end_ && (is_letter(*p) || is_digit(*p)))
            key = (key ^ static_cast<unsigned char>(*p++)) * 16777619u;
        token.hash = key != 0 ? key : 1;
        token.text = {from, static_cast<std::size_t>(p - from)};
        token.sign = sign_of_word(token.text, token.hash);
        at_ = p;
    }
    constexpr void read_number(Token& token) noexcept {
        constexpr std::uint64_t most = 0x7fff'ffff'ffff'ffff;
        const char* const from = at_;
        const char* p = at_;
        std::uint64_t digits = 0;
        int exponent = 0;
        bool is_real = false, too_large = false;
        const auto take = [&](int places) {
            for (; p != end_ && is_digit(*p); ++p) {
                const auto digit = static_cast<std::uint64_t>(*p - '0');
                if (digits > (most - digit) / 10) {
                    too_large = true; // as an integer; a real ignores digits that it cannot hold
                    if (places == 0 && exponent < 9999) ++exponent;
                } else {
                    digits = digits * 10 + digit;
                    exponent -= places;
                }
            }
        };
        take(0);
        if (p != end_ && *p == '.' && !(end_ - p > 1 && is_letter(p[1]))) {
            is_real = true;
            ++p;
            take(1);
        }
        if (p != end_ && (*p == 'e' || *p == 'E')) {
            const char* q = p + 1;
            const bool negative = q != end_ && *q == '-';
            if (q != end_ && (*q == '-' || *q == '+')) ++q;
            if (q != end_ && is_digit(*q)) {
                int power = 0;
                for (; q != end_ && is_digit(*q); ++q)
                    if (power < 9999) power = power * 10 + (*q - '0');
                exponent += negative ? -power : power;
                is_real = true;
                p = q;
            }
        }
        if (const std::int64_t unit = read_unit(p); unit != 0)
            return make_duration(token, from, p, digits, exponent, unit);
        if (p != end_ && is_letter(*p)) {
            at_ = p;
            return make_broken(token, "a letter inside a number; units of time are ns, us, ms, s, min and h");
        }
        token.text = {from, static_cast<std::size_t>(p - from)};
        token.sign = is_real ? Sign::real : Sign::integer;
        if (!is_real && too_large)
            return make_broken(token, "an integer of more than 63 bits; write a real number such as 1e20");
        if (is_real && exponent > 308 + 19) return make_broken(token, "a number too large for a double");
        token.integer = static_cast<std::int64_t>(digits);
        token.real = exponent < -400 ? 0 : real_of(digits, exponent);
        if (is_real && token.real > 1.7976931348623157e308)
            return make_broken(token, "a number too large for a double");
        at_ = p;
    }
    /// Reads the unit of time after blanks at `p`, moves `p` behind it; returns its nanoseconds, 0: none.
    constexpr std::int64_t read_unit(const char*& p) const noexcept {
        const char* q = p;
        while (q != end_ && (*q == ' ' || *q == '\t')) ++q;
        const char* const from = q;
        while (q != end_ && (is_letter(*q) || is_digit(*q))) ++q;
        const std::string_view word{from, static_cast<std::size_t>(q - from)};
        for (const UnitOfTime& each : units_of_time)
            if (word == each.name) {
                p = q;
                return each.ns;
            }
        return 0;
    }
    constexpr void make_duration(Token& token, const char* from, const char* to, std::uint64_t digits,
                                 int exponent, std::int64_t unit) noexcept {
        std::uint64_t ns = 0;
        bool fits = digits == 0 || !__builtin_mul_overflow(digits, static_cast<std::uint64_t>(unit), &ns);
        for (; fits && exponent > 0 && ns != 0; --exponent)
            fits = !__builtin_mul_overflow(ns, std::uint64_t{10}, &ns);
        for (; fits && exponent < 0; ++exponent) ns /= 10; // fractions of a nanosecond are dropped
        if (!fits || ns > 0x7fff'ffff'ffff'ffff)
            return make_broken(token, "a time too long for nanoseconds in 63 bits");
        token.text = {from, static_cast<std::size_t>(to - from)};
        token.sign = Sign::duration;
        token.integer = static_cast<std::int64_t>(ns);
        at_ = to;
    }
    constexpr void read_text(Token& token) noexcept {
        const char* p = at_ + 1;
        while (p != end_ && *p != '"' && *p != '\n') p += *p == '\\' && end_ - p > 1 && p[1] != '\n' ? 2 : 1;
        if (p == end_ || *p == '\n')
            return make_broken(token, "a text without its end; close the quotes in the same line");
        token.text = {at_ + 1, static_cast<std::size_t>(p - at_ - 1)};
        token.sign = Sign::text;
        at_ = p + 1;
    }
    constexpr void read_sign(Token& token, char c) noexcept {
        const char after = end_ - at_ > 1 ? at_[1] : '\0';
        const auto pair = [&](char second, Sign both, Sign one) {
            after == second ? make(token, both, 2) : make(token, one, 1);
        };
        switch (c) {
        case '{': return make(token, Sign::open_brace, 1);
        case '}': return make(token, Sign::close_brace, 1);
        case '(': return make(token, Sign::open_round, 1);
        case ')': return make(token, Sign::close_round, 1);
        case '[': return make(token, Sign::open_square, 1);
        case ']': return make(token, Sign::close_square, 1);
        case ',': return make(token, Sign::comma, 1);
        case ';': return make(token, Sign::semicolon, 1);
        case '.': return make(token, Sign::dot, 1);
        case '?': return make(token, Sign::question, 1);
        case ':': return make(token, Sign::colon, 1);
        case '+': return make(token, Sign::plus, 1);
        case '-': return make(token, Sign::minus, 1);
        case '*': return make(token, Sign::times, 1);
        case '/': return make(token, Sign::divide, 1);
        case '%': return make(token, Sign::remainder, 1);
        case '=': return pair('=', Sign::equal, Sign::assign);
        case '!': return pair('=', Sign::unequal, Sign::invert);
        case '<': return pair('=', Sign::at_most, Sign::less);
        case '>': return pair('=', Sign::at_least, Sign::greater);
        case '&':
            if (after == '&') return make(token, Sign::logical_and, 2);
            break;
        case '|':
            if (after == '|') return make(token, Sign::logical_or, 2);
            break;
        default: break;
        }
        make_broken(token, "a character that means nothing here");
    }

    const char* at_ = nullptr;
    const char* end_ = nullptr;
    const char* row_ = nullptr; // beginning of the line
    std::uint16_t line_ = 1;
};

} // namespace tappet::script_detail
