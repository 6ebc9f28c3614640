// Items of a DBC statement, as the reader expects them. A fault concerns the row that the statement is about,
// and ends the statement or not; the reader goes on with the next one.
#pragma once

#include "drivers/can/dbc/network.hpp"

namespace tappet::can::dbc {

class Items {
protected:
    explicit constexpr Items(Network& network) noexcept : net_{network}, in_{network.text} {}

    [[nodiscard]] constexpr bool ok() const noexcept { return !failed_; }

    /// Begins a statement, which is about no row yet.
    constexpr void begin(std::size_t at) noexcept {
        failed_ = false;
        weight_ = Weight::fault;
        statement_at_ = at;
        message_ = signal_ = no_such;
    }
    constexpr void about(const MessageRow& message) noexcept {
        message_ = static_cast<std::size_t>(&message - net_.messages.data());
        signal_ = no_such;
    }
    constexpr void about(const SignalRow& signal) noexcept {
        message_ = signal.message;
        signal_ = static_cast<std::size_t>(&signal - net_.signals.data());
    }
    [[nodiscard]] constexpr MessageRow& the_message() const noexcept { return net_.messages[message_]; }
    [[nodiscard]] constexpr SignalRow& the_signal() const noexcept { return net_.signals[signal_]; }

    // ---- troubles

    static constexpr void mark(std::size_t& first, std::size_t at) noexcept {
        if (first == no_such) first = at;
    }
    template <class... Pieces> constexpr void tell(Weight weight, std::size_t at, const Pieces&... pieces) {
        if (weight == Weight::limits)
            mark(the_signal().limits_trouble, at);
        else if (weight == Weight::fault && signal_ != no_such)
            mark(the_signal().trouble, at);
        else if (weight == Weight::fault && message_ != no_such)
            mark(the_message().trouble, at);
        else
            weight = Weight::note;
        if (net_.troubles != nullptr)
            net_.troubles->add(Trouble{at, weight, message_, signal_, {}}, pieces...);
    }
    template <class... Pieces> constexpr void note(std::size_t at, const Pieces&... pieces) {
        tell(Weight::note, at, pieces...);
    }
    /// Spoils the row; its statement goes on.
    template <class... Pieces> constexpr void spoil(std::size_t at, const Pieces&... pieces) {
        if (ok()) tell(weight_, at, pieces...);
    }
    /// Spoils the row, and ends the statement.
    template <class... Pieces> constexpr void fail(std::size_t at, const Pieces&... pieces) {
        spoil(at, pieces...);
        failed_ = true;
    }
    /// Makes the whole file unreadable.
    template <class... Pieces> constexpr void give_up(std::size_t at, const Pieces&... pieces) {
        net_.fail(at, pieces...);
        failed_ = true;
    }
    constexpr void fail_expected(std::string_view what) {
        if (in_.at_end())
            give_up(in_.at(), "the file ends, expected ", what, "; is it whole?");
        else if (in_.next() == '"')
            fail(in_.at(), "a text is unclosed or out of place, expected ", what);
        else
            fail(in_.at(), "found \"", in_.found(), "\", expected ", what);
    }

    // ---- expected items

    constexpr void expect(char c, std::string_view what) {
        if (ok() && !in_.take(c)) fail_expected(what);
    }
    constexpr std::string_view label(std::string_view what) {
        const std::string_view name = ok() ? in_.name() : std::string_view{};
        if (name.empty() && ok()) fail_expected(what);
        return name;
    }
    /// Returns a number, or 0 after a fault.
    constexpr std::uint32_t whole(std::uint64_t most, std::string_view what) {
        const std::size_t at = in_.at();
        std::uint64_t value = 0;
        if (!ok()) return 0;
        if (!in_.whole(value)) {
            fail_expected(what);
        } else if (value > most) {
            spoil(at, value, " is too large for ", what, ", which is ", most, " at most");
            value = 0;
        }
        return static_cast<std::uint32_t>(value);
    }
    constexpr double real(std::string_view what) {
        const std::size_t at = in_.at();
        double value = 0;
        if (!ok()) return value;
        if (!in_.real(value))
            fail_expected(what);
        else if (!is_number(value))
            spoil(at, what, " is beyond a double");
        return is_number(value) ? value : 1;
    }
    /// Returns one of a signal's limits, before `end`; infinite: none.
    constexpr double limit(std::string_view what, char end) {
        constexpr double none = std::numeric_limits<double>::infinity();
        const std::size_t at = in_.at();
        double value = none;
        if (!ok()) return none;
        if (!in_.real(value)) {
            tell(Weight::limits, at, "found \"", in_.found(), "\", expected ", what);
            in_.skip_to({&end, 1});
        } else if (!is_number(value)) {
            tell(Weight::limits, at, what, " is beyond a double");
        }
        return value;
    }
    constexpr std::string_view text(std::string_view what) {
        std::string_view text;
        if (ok() && !in_.text(text)) fail_expected(what);
        return text;
    }

    Network& net_;
    Scanner in_;
    std::size_t statement_at_ = 0;
    std::size_t message_ = no_such, signal_ = no_such;
    Weight weight_ = Weight::fault; ///< of the statement's faults
    bool failed_ = false;
};

} // namespace tappet::can::dbc
