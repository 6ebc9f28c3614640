// The text of a script while it is compiled: one token at a time, and the first fault.
#pragma once

#include "kernel/base/nearest.hpp"
#include "kernel/script/room.hpp"
#include "kernel/script/token.hpp"

#include <initializer_list>

namespace tappet {

/// Limit for nested expressions, statements and functions, counted together.
inline constexpr std::uint32_t script_max_depth = 32;
/// Most tokens read to compile a text of so many characters; more would mean functions that multiply.
constexpr std::uint64_t script_work(std::size_t characters) noexcept {
    return 16 * std::uint64_t{characters} + 4096;
}

namespace script_detail {

/// Quotes at most this much of the text in a message.
constexpr std::string_view quoted(std::string_view text) noexcept { return text.substr(0, 60); }

class Reader {
public:
    /// The first fault goes to `outcome`; its message begins with `file`.
    constexpr Reader(std::string_view text, std::string_view file, ScriptOutcome& outcome)
        : outcome_{outcome}, file_{file}, lexer_{text}, work_{script_work(text.size())} {}

    [[nodiscard]] constexpr std::string_view file() const noexcept { return file_; }

    // ---- faults: the first one counts and ends the reading of tokens

    [[nodiscard]] constexpr bool ok() const noexcept { return !failed_; }
    constexpr void fail(const Token& at, std::initializer_list<std::string_view> pieces) {
        if (failed_) return;
        failed_ = true;
        outcome_.line = at.line;
        outcome_.column = at.column;
        Sentence& s = outcome_.fault;
        s.add(file_).add(":").add(std::int64_t{at.line}).add(":").add(std::int64_t{at.column}).add(": ");
        for (const std::string_view piece : pieces) s.add(piece);
        token_.sign = Sign::end;
    }
    /// Reports the current token.
    constexpr void fail(std::initializer_list<std::string_view> pieces) { fail(token_, pieces); }
    /// Reports "found this, expected that".
    constexpr void fail_expected(std::string_view wanted) {
        if (token_.sign == Sign::broken) return fail({"found ", token_.fault, "; expected ", wanted});
        if (token_.sign == Sign::end) return fail({"found the end of the text, expected ", wanted});
        fail({"found \"", quoted(token_.text), "\", expected ", wanted});
    }
    constexpr void fail_unknown(const Token& at, std::string_view what, const Nearest& nearest,
                                std::string_view where) {
        if (nearest.best().empty())
            return fail(at, {"found ", what, " \"", quoted(at.text), "\", which is not known", where});
        fail(at, {"found ", what, " \"", quoted(at.text), "\", which is not known", where,
                  "; did you mean \"", nearest.best(), "\"?"});
    }
    /// Suggests the nearest of the rows' names.
    template <class Rows>
    constexpr void fail_unknown(const Token& at, std::string_view what, const Rows& rows,
                                std::string_view where) {
        if (failed_) return;
        Nearest nearest{at.text};
        for (const auto& each : rows) nearest.consider(each.name);
        fail_unknown(at, what, nearest, where);
    }
    constexpr void fail_room(std::string_view what) {
        if (failed_) return;
        fail({"the script needs more ", what, " than there is room for; make it smaller or the room larger"});
        outcome_.out_of_room = true;
    }
    /// Reports a limit that a larger room does not raise.
    constexpr void fail_limit(std::string_view what) {
        fail({"the script needs more ", what, " than the language allows; make it smaller"});
    }
    /// Converts a number for a message; valid until the second call after it.
    constexpr std::string_view digits(std::uint64_t number) {
        std::array<char, 20>& into = digits_[digits_used_++ % digits_.size()];
        std::size_t at = into.size();
        do into[--at] = static_cast<char>('0' + number % 10);
        while ((number /= 10) != 0);
        return {into.data() + at, into.size() - at};
    }

    // ---- tokens

    [[nodiscard]] constexpr const Token& token() const noexcept { return token_; }
    constexpr void advance() {
        if (failed_) {
            token_.sign = Sign::end;
            return;
        }
        if (work_ == 0)
            return fail({"the functions of this script expand to more text than the compiler reads; call "
                         "fewer functions in functions"});
        --work_;
        lexer_.next(token_);
    }
    [[nodiscard]] constexpr bool is(Sign sign) const noexcept { return token_.sign == sign; }
    constexpr bool take(Sign sign) {
        if (token_.sign != sign) return false;
        advance();
        return true;
    }
    constexpr void skip(Sign optional) {
        if (is(optional)) advance();
    }
    constexpr bool need(Sign sign, std::string_view wanted) {
        if (take(sign)) return true;
        fail_expected(wanted);
        return false;
    }
    /// Reads the comma after a list's item, unless the list ends.
    constexpr void need_comma() {
        if (!is(Sign::close_round)) need(Sign::comma, "\",\" or \")\"");
    }
    /// Reads a name that the script defines; keywords are refused.
    constexpr Token need_name(std::string_view wanted) { return need_if(is(Sign::name), wanted); }
    /// Reads a name after a dot or in an interface, where keywords are names too.
    constexpr Token need_word(std::string_view wanted) { return need_if(token_.is_word(), wanted); }
    /// Returns whether a block has more before its closing bracket.
    [[nodiscard]] constexpr bool has_more(Sign closing) const noexcept {
        return ok() && !is(closing) && !is(Sign::end);
    }

    struct Place {
        Lexer lexer{};
        Token token{};
    };
    [[nodiscard]] constexpr Place here() const noexcept { return {lexer_, token_}; }
    constexpr void go_to(const Place& place) {
        if (failed_) return;
        lexer_ = place.lexer;
        token_ = place.token;
    }

    // ---- depth of nesting

    /// Call leave() after it, unless it fails.
    constexpr bool enter() {
        if (depth_ == script_max_depth)
            fail({"this is nested deeper than scripts may be; take parts of it out into variables or "
                  "functions"});
        if (!ok()) return false;
        ++depth_;
        return true;
    }
    constexpr void leave() { --depth_; }
    [[nodiscard]] constexpr std::uint32_t depth() const noexcept { return depth_; }

private:
    constexpr Token need_if(bool is_wanted, std::string_view wanted) {
        const Token name = token_;
        is_wanted ? advance() : fail_expected(wanted);
        return name;
    }

    ScriptOutcome& outcome_;
    std::string_view file_;
    Lexer lexer_;
    Token token_{};
    std::uint64_t work_;
    std::uint32_t depth_ = 0;
    std::array<std::array<char, 20>, 2> digits_{};
    std::size_t digits_used_ = 0;
    bool failed_ = false;
};

} // namespace script_detail

} // namespace tappet
