// Items of a DBC statement, as the reader expects them. A fault makes the file unreadable, unless it is
// certain which row it concerns: then that row is marked, and the reader goes on with the next statement.
#pragma once

#include "drivers/can/dbc/network.hpp"

namespace tappet::can::dbc {

class Items {
protected:
    explicit Items(Network& network) noexcept : net_{network}, in_{network.text} {}

    [[nodiscard]] bool ok() const noexcept { return !failed_; }

    /// Begins a statement, which is about no row yet.
    void begin(std::size_t at) noexcept {
        failed_ = false;
        weight_ = Weight::fault;
        part_ = Part::all;
        is_by_identifier_ = marks_ = false;
        statement_at_ = at;
        message_ = signal_ = no_such;
    }
    void about(const MessageRow& message) noexcept {
        message_ = static_cast<std::size_t>(&message - net_.messages.data());
        signal_ = no_such;
    }
    void about(const SignalRow& signal) noexcept {
        message_ = signal.message;
        signal_ = static_cast<std::size_t>(&signal - net_.signals.data());
    }
    [[nodiscard]] MessageRow& the_message() const noexcept { return net_.messages[message_]; }
    [[nodiscard]] SignalRow& the_signal() const noexcept { return net_.signals[signal_]; }

    // ---- troubles

    static void mark(std::size_t& first, std::size_t trouble) noexcept {
        if (first == no_such) first = trouble;
    }
    [[nodiscard]] std::size_t last_trouble() const noexcept { return net_.troubles.size() - 1; }
    /// Calls visit(message) for each message with the identifier that the statement names.
    template <class Visit> void for_each_twin(const Visit& visit) {
        MessageRow& own = the_message();
        if (!is_by_identifier_ || !own.shares_identifier) return visit(own);
        for (MessageRow& each : net_.messages)
            if (!each.is_independent && each.identifier == own.identifier) visit(each);
    }
    /// Calls visit(signal) for each signal that the statement names: one for each twin that has it.
    template <class Visit> void for_each_namesake(const Visit& visit) {
        const std::string_view name = the_signal().shape.name;
        if (!is_by_identifier_) return visit(the_signal());
        for_each_twin([&](MessageRow& message) {
            if (SignalRow* const found = net_.find(message, name); found != nullptr) visit(*found);
        });
    }
    template <class... Pieces> void tell(Weight weight, std::size_t at, const Pieces&... pieces) {
        const auto told = [&](std::size_t message, std::size_t signal) {
            net_.troubles.push_back({at, weight, message, signal, Sentence{pieces...}});
            return last_trouble();
        };
        if (weight == Weight::limits) return mark(the_signal().limits_trouble, told(message_, signal_));
        if (weight == Weight::note) return static_cast<void>(told(message_, signal_));
        if (signal_ == no_such)
            return for_each_twin([&](MessageRow& each) {
                mark(each.troubles[static_cast<std::size_t>(part_)],
                     told(static_cast<std::size_t>(&each - net_.messages.data()), no_such));
            });
        for_each_namesake([&](SignalRow& each) {
            mark(part_ == Part::selection ? each.selection_trouble : each.trouble,
                 told(each.message, static_cast<std::size_t>(&each - net_.signals.data())));
        });
    }
    template <class... Pieces> void note(std::size_t at, const Pieces&... pieces) {
        tell(Weight::note, at, pieces...);
    }
    /// Spoils the row, if the statement is about one; its statement goes on.
    template <class... Pieces> void spoil(std::size_t at, const Pieces&... pieces) {
        if (!ok()) return;
        if (message_ == no_such) return give_up(at, pieces...);
        tell(weight_, at, pieces...);
    }
    /// Ends the statement, and spoils the rows that it is about, or the file.
    template <class... Pieces> void fail(std::size_t at, const Pieces&... pieces) {
        if (ok() && !marks_) return give_up(at, pieces...);
        spoil(at, pieces...);
        failed_ = true;
    }
    /// Makes the whole file unreadable.
    template <class... Pieces> void give_up(std::size_t at, const Pieces&... pieces) {
        net_.fail(at, pieces...);
        failed_ = true;
    }
    void fail_expected(std::string_view what) {
        if (in_.at_end())
            give_up(in_.at(), "the file ends, expected ", what, "; is it whole?");
        else if (in_.next() == '"')
            fail(in_.at(), "a text is unclosed or out of place, expected ", what);
        else
            fail(in_.at(), "found \"", in_.found(), "\", expected ", what);
    }

    // ---- expected items

    void expect(char c, std::string_view what) {
        if (ok() && !in_.take(c)) fail_expected(what);
    }
    std::string_view label(std::string_view what) {
        const std::string_view name = ok() ? in_.name() : std::string_view{};
        if (name.empty() && ok()) fail_expected(what);
        return name;
    }
    /// Returns a number, or 0 after a fault.
    std::uint32_t whole(std::uint64_t most, std::string_view what) {
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
    double real(std::string_view what) {
        const std::size_t at = in_.at();
        double value = 0;
        if (!ok()) return value;
        if (!in_.real(value))
            fail_expected(what);
        else if (!is_number(value))
            spoil(at, what, " is beyond a double");
        return value;
    }
    /// Returns one of a signal's limits, before `end`; infinite: none.
    double limit(std::string_view what, char end) {
        constexpr double none = std::numeric_limits<double>::infinity();
        const std::size_t at = in_.at();
        double value = none;
        if (!ok()) return none;
        if (!in_.real(value)) {
            if (!in_.no_number(end)) fail_expected(what);
            if (ok()) tell(Weight::limits, at, what, " is no number");
        } else if (!is_number(value)) {
            tell(Weight::limits, at, what, " is beyond a double");
        }
        return value;
    }
    std::string_view text(std::string_view what) {
        std::string_view text;
        if (ok() && !in_.text(text)) fail_expected(what);
        return text;
    }

    Network& net_;
    Scanner in_;
    std::size_t statement_at_ = 0;
    std::size_t message_ = no_such, signal_ = no_such;
    Weight weight_ = Weight::fault; ///< of the statement's faults
    Part part_ = Part::all;         ///< the part of the row that they concern
    bool is_by_identifier_ = false; ///< the statement is about all messages with the identifier
    bool marks_ = false;            ///< a fault of the statement spoils its rows, not the file
    bool failed_ = false;
};

} // namespace tappet::can::dbc
