// Reads a DBC file, in a constant expression or on the host, with the same code and the same fault messages.
// A fault marks the row that it concerns, and reading goes on: only a map that takes the row is refused.
#pragma once

#include "drivers/can/dbc/choice.hpp"
#include "drivers/can/dbc/message_reader.hpp"
#include "kernel/base/decimal.hpp"

namespace tappet::can::dbc {

class Reader : MessageReader {
public:
    explicit constexpr Reader(Network& network) noexcept : MessageReader{network} {}

    /// Fills the network; its fault says why nothing of the file can be used.
    constexpr void read() {
        if (net_.text.size() != without_mark(net_.text).size())
            note(0, "the file begins with a byte-order mark");
        while (net_.fault.empty() && !in_.at_end()) statement();
        begin(0);
        for (MessageRow& message : net_.all())
            if (net_.fault.empty() && !message.is_independent) finish(message);
    }

private:
    constexpr void end_of_statement() {
        if (!ok() || in_.take(';')) return;
        if (!in_.at_end() && !begins_statement(in_)) return fail_expected("\";\", the end of the statement");
        note(statement_at_, "the statement has no \";\"; it ends before the next one");
    }
    constexpr void skip_statement() {
        std::size_t text_at = 0;
        switch (in_.skip_statement(begins_statement, text_at)) {
        case Scanner::End::semicolon: break;
        case Scanner::End::none:
            if (!failed_) note(statement_at_, "the statement has no \";\"; it ends before the next one");
            break;
        case Scanner::End::unclosed: note(text_at, "a text is unclosed; it ends with its line"); break;
        case Scanner::End::cut: give_up(text_at, "a text is unclosed at the end of the file; is it whole?");
        }
    }

    // ---- look-up of the row that a statement is about: false after a fault, and in Vector's container

    constexpr bool known_message() {
        const std::size_t at = in_.at();
        const std::uint32_t id = whole(0xffff'ffff, "a message's identifier");
        if (!ok()) return false;
        const std::size_t found = message_of(id);
        if (found == no_such) {
            if (id != independent_id) note(at, "no message has the identifier ", std::uint64_t{id});
        } else if (!net_.messages[found].is_independent) {
            message_ = found;
            return true;
        }
        failed_ = true;
        return false;
    }
    constexpr bool known_signal() {
        const std::size_t at = in_.at();
        const std::string_view name = label("a signal's name");
        if (!ok()) return false;
        for (std::size_t m = message_; m != no_such; m = message_of(raw_id(the_message()), m + 1))
            if (const SignalRow* const found = net_.find(net_.messages[m], name); found != nullptr) {
                about(*found);
                return true;
            }
        Nearest nearest{name};
        for (const SignalRow& each : net_.of(the_message())) nearest.consider(each.shape.name);
        note(at, "message \"", the_message().name, "\" has no signal \"", name, "\"", or_meant(nearest, ""));
        failed_ = true;
        return false;
    }
    // ---- statements

    /// Returns whether to skip the statement, because it has no effect on the wire.
    static constexpr bool is_passed_over(std::string_view keyword) noexcept {
        constexpr std::string_view all =
            "VAL_TABLE_ EV_ ENVVAR_DATA_ EV_DATA_ SGTYPE_ SIG_GROUP_ SIG_TYPE_REF_ SIGTYPE_VALTYPE_ "
            "SGTYPE_VAL_ "
            "BA_DEF_SGTYPE_ BA_SGTYPE_ BA_DEF_REL_ BA_REL_ BA_DEF_DEF_REL_ BU_SG_REL_ BU_EV_REL_ "
            "BU_BO_REL_ CAT_ CAT_DEF_ FILTER CM_";
        return names(all, keyword);
    }
    static constexpr bool is_statement(std::string_view keyword) noexcept {
        constexpr std::string_view read =
            "BO_ SG_ VAL_ BA_ BA_DEF_ BA_DEF_DEF_ BO_TX_BU_ SIG_VALTYPE_ SG_MUL_VAL_ BU_ NS_ BS_ VERSION";
        return names(read, keyword) || is_passed_over(keyword);
    }
    static constexpr bool begins_statement(const Scanner& at) noexcept {
        return at.begins_line() && is_statement(at.peek());
    }
    constexpr void statement() {
        if (in_.take(';')) return;
        begin(in_.at());
        const std::string_view keyword = in_.word();
        if (keyword == "SG_") return signal_statement();
        if (keyword == "BO_") return message_statement();
        const bool in_message = takes_signals_;
        takes_signals_ = false;
        if (keyword == "VAL_")
            values();
        else if (keyword == "BA_")
            attribute();
        else if (keyword == "BA_DEF_")
            attribute_definition();
        else if (keyword == "BA_DEF_DEF_")
            attribute_default();
        else if (keyword == "BO_TX_BU_")
            senders();
        else if (keyword == "SIG_VALTYPE_")
            value_type();
        else if (keyword == "SG_MUL_VAL_")
            selections();
        else if (keyword == "BU_")
            nodes();
        else if (keyword == "NS_")
            new_symbols();
        else if (keyword == "BS_")
            bit_timing();
        else if (keyword == "VERSION")
            text("the version between quotes");
        else if (is_passed_over(keyword))
            skip_statement();
        else
            return unknown(keyword, in_message);
        if (failed_ && net_.fault.empty()) skip_statement();
    }
    constexpr void unknown(std::string_view keyword, bool in_message) {
        // In a message it may be the rest of a signal, with its receivers.
        const bool continues = in_message && !keyword.ends_with('_');
        takes_signals_ = continues;
        if (continues && net_.used.signals != 0 && is_of_last(net_.signals[net_.used.signals - 1]))
            about(net_.signals[net_.used.signals - 1]);
        else if (continues)
            about(net_.messages[net_.used.messages - 1]);
        fail(statement_at_, "found \"", keyword.empty() ? in_.found() : keyword,
             "\", expected a statement, which begins with BO_, SG_, VAL_ or the like");
        if (!continues) return skip_statement();
        in_.skip_line();
        if (signal_ == no_such) return;
        const std::string_view receivers = the_signal().receivers;
        the_signal().receivers =
            in_.since(receivers.empty() ? statement_at_
                                        : static_cast<std::size_t>(receivers.data() - net_.text.data()));
    }
    constexpr void new_symbols() {
        expect(':', "\":\" after NS_");
        while (ok() && !in_.at_end()) {
            Scanner ahead = in_;
            const std::string_view symbol = ahead.word();
            const bool is_next = symbol == "BS_" || symbol == "BU_" || is_digit(ahead.next());
            if (symbol.empty() || is_next || ahead.next() == '"') return;
            in_ = ahead;
        }
    }
    constexpr void bit_timing() {
        expect(':', "\":\" after BS_");
        std::uint64_t ignored = 0;
        while (ok() && (in_.whole(ignored) || in_.take(':') || in_.take(',') || in_.take(';'))) {
        }
    }
    constexpr void nodes() {
        expect(':', "\":\" after BU_");
        if (!ok()) return;
        if (has_nodes_) note(statement_at_, "BU_ is there twice; the first one counts");
        // Nodes may continue on further lines: the next statement ends them.
        const std::size_t from = in_.at();
        while (!in_.at_end() && !is_statement(in_.peek()) && !in_.name().empty()) in_.take(',');
        in_.take(';');
        if (!has_nodes_) net_.nodes = in_.since(from);
        has_nodes_ = true;
    }
    constexpr void senders() {
        if (!known_message()) return;
        expect(':', "\":\" before the nodes that send the message");
        const std::string_view list = node_list();
        check_nodes(list);
        end_of_statement();
        if (ok()) the_message().more_senders = list;
    }

    // A fault in the names of values is a note: the signal has none of them, and what uses one is refused.
    constexpr void values() {
        weight_ = Weight::note;
        if (!in_.peek().empty()) return skip_statement(); // of an environment variable
        if (!known_message() || !known_signal()) return;
        SignalRow& row = the_signal();
        const std::size_t at = in_.at();
        const bool is_second = row.names_at != no_such;
        if (is_second)
            note(at, "signal \"", row.shape.name, "\" has its values named twice; none of the names counts");
        row.names_at = statement_at_;
        row.first_value = net_.used.values;
        row.values = 0;
        while (ok() && in_.next() != ';' && !in_.at_end() && !begins_statement(in_)) value(row);
        end_of_statement();
        if (failed_ || is_second) row.values = 0;
    }
    constexpr void value(SignalRow& row) {
        ValueName value;
        const std::size_t at = in_.at();
        bool fits = true;
        std::uint64_t large = 0;
        double real = 0;
        if (in_.integer(value.value)) {
        } else if (in_.whole(large)) { // of 64 bits: kept as the facet has it
            value.value = static_cast<std::int64_t>(large);
            fits = row.shape.bits == 64 && row.shape.kind == Kind::unsigned_integer;
        } else if (in_.real(real)) { // some tools write "3.0" for 3
            fits = real > -9e18 && real < 9e18;
            if (fits) value.value = static_cast<std::int64_t>(real);
            fits = fits && real == static_cast<double>(value.value);
        } else {
            return fail_expected("a value and its name, or \";\"");
        }
        value.name = text("the value's name between quotes");
        if (!ok()) return;
        if (!fits) return note(at, "signal \"", row.shape.name, "\" cannot have the value of this name");
        if (net_.used.values == net_.values.size()) return give_up(at, "too many values; is the file whole?");
        net_.values[net_.used.values++] = value;
        ++row.values;
    }

    constexpr void value_type() {
        if (!known_message() || !known_signal()) return;
        in_.take(':');
        const std::size_t at = in_.at();
        const std::uint32_t kind = whole(2, "0 (integer), 1 (float) or 2 (double)");
        end_of_statement();
        if (!ok() || kind == 0) return;
        Signal& s = the_signal().shape;
        if (s.bits != 32 * kind)
            spoil(at, "signal \"", s.name, "\" has ", unsigned{s.bits}, " bits, but a ",
                  kind == 1 ? "float" : "double", " has ", 32 * kind);
        else
            s.kind = kind == 1 ? Kind::float32 : Kind::float64;
    }

    constexpr void selections() {
        if (!known_message()) return;
        const std::size_t signal_at = in_.at();
        if (!known_signal()) return;
        SignalRow& row = the_signal();
        const std::size_t at = in_.at();
        const bool is_known = known_signal() && the_signal().message == row.message;
        const SignalRow& multiplexor = the_signal();
        about(row);
        if (!is_known) {
            tell(Weight::fault, at, "signal \"", row.shape.name, "\" has an unknown multiplexor");
            failed_ = true;
            return;
        }
        if (!multiplexor.is_multiplexor)
            return fail(at, "signal \"", multiplexor.shape.name,
                        "\" selects others but is not a multiplexor");
        if (!row.is_multiplexed)
            return fail(signal_at, "signal \"", row.shape.name, "\" is selected but not multiplexed");
        do {
            const std::size_t from_at = in_.at();
            const std::uint32_t from = whole(0xffff'ffff, "the first value of a range");
            expect('-', "\"-\" between the ends of a range");
            const std::uint32_t to = whole(0xffff'ffff, "the last value of a range");
            if (to < from) spoil(from_at, "an empty range");
            if (ok()) select(row, {from, to});
        } while (ok() && in_.take(','));
        end_of_statement();
        row.selected_by = static_cast<std::size_t>(&multiplexor - net_.signals.data());
    }
    // ---- attributes: rates, CAN FD, and names of more than 32 characters

    constexpr Choice* choice(std::string_view attribute) noexcept {
        for (Choice* const each : {&fd_, &switch_, &demand_})
            if (each->attribute == attribute) return each;
        return nullptr;
    }
    constexpr bool chosen(const Choice& among) {
        if (in_.next() == '"') return among.says_yes(text("the attribute's value"));
        const std::size_t at = in_.at();
        const std::uint32_t number = whole(63, "the number of the attribute's value");
        if (among.is_unreadable) spoil(at, among.attribute, " has no readable definition");
        return among.holds(number);
    }
    constexpr void attribute_definition() {
        if (in_.peek() == "BO_") in_.word();
        const std::string_view name = in_.next() == '"' ? text("an attribute's name") : std::string_view{};
        Choice* const of = choice(name);
        if (of == nullptr || in_.peek() != "ENUM") return skip_statement();
        in_.word();
        of->yes = 0;
        unsigned number = 0;
        do of->define(number++, text("a value's name between quotes"));
        while (ok() && in_.take(','));
        end_of_statement();
        of->is_unreadable = !ok();
    }

    constexpr Duration cycle_time() {
        weight_ = Weight::note;
        const std::size_t at = in_.at();
        const double ms = real("the cycle time in milliseconds");
        if (ok() && ms >= 0 && ms < 1e9) return Duration{static_cast<std::int64_t>(ms * 1e6 + 0.5)};
        spoil(at, "a cycle time of ", decimal(ms), " ms");
        return {};
    }
    constexpr void attribute() {
        const std::string_view name = text("an attribute's name between quotes");
        const std::string_view of = in_.peek();
        const bool is_period = name == "GenMsgCycleTime" && of == "BO_";
        const bool is_message_name = name == "SystemMessageLongSymbol" && of == "BO_";
        const bool is_signal_name = name == "SystemSignalLongSymbol" && of == "SG_";
        const Choice* const among = of == "BO_" ? choice(name) : nullptr;
        if (!ok()) return;
        if (!is_period && !is_message_name && !is_signal_name && among == nullptr) return skip_statement();
        in_.word();
        if (!known_message() || (is_signal_name && !known_signal())) return;
        if (among != nullptr) {
            (among == &fd_       ? the_message().is_fd
             : among == &switch_ ? the_message().switches
                                 : the_message().on_demand) = chosen(*among);
        } else if (is_period) {
            the_message().says_every = true;
            the_message().every = cycle_time();
        } else {
            weight_ = Weight::note;
            const std::string_view long_name = text("a name between quotes");
            if (ok()) (is_signal_name ? the_signal().long_name : the_message().long_name) = long_name;
        }
        end_of_statement();
    }
    constexpr void attribute_default() {
        const std::string_view name = text("an attribute's name between quotes");
        Choice* const of = choice(name);
        if (of == nullptr && name != "GenMsgCycleTime") return skip_statement();
        if (of != nullptr)
            of->usually = chosen(*of);
        else
            usual_every_ = cycle_time();
        end_of_statement();
    }

    // ---- a complete message

    constexpr void take_defaults(MessageRow& message) {
        if (message.shares_identifier) // attributes belong to the first one
            if (const MessageRow& first = net_.messages[message_of(raw_id(message))]; &first != &message) {
                message.every = first.every, message.says_every = first.says_every;
                message.is_fd = first.is_fd, message.switches = first.switches;
                message.on_demand = first.on_demand;
            }
        if (!message.says_every) message.every = usual_every_;
        if (!message.is_fd) message.is_fd = fd_.usually;
        if (!message.switches) message.switches = switch_.usually;
        if (!message.on_demand) message.on_demand = demand_.usually;
    }
    constexpr void finish(MessageRow& message) {
        take_defaults(message);
        const auto signals = net_.of(message);
        std::size_t multiplexors = 0;
        std::size_t plain = no_such; // the one that is not multiplexed itself
        for (const SignalRow& each : signals) {
            multiplexors += each.is_multiplexor;
            if (each.is_multiplexor && !each.is_multiplexed)
                plain = static_cast<std::size_t>(&each - net_.signals.data());
        }
        for (SignalRow& each : signals) {
            if (!each.is_multiplexed) continue;
            about(each);
            if (each.selected_by == no_such) {
                if (multiplexors > 1)
                    spoil(each.at, "message \"", message.name,
                          "\" has several multiplexors, and SG_MUL_VAL_ says not which one selects \"",
                          each.shape.name, "\"");
                else if (plain == no_such)
                    spoil(each.at, "signal \"", each.shape.name,
                          "\" is multiplexed but its message has no multiplexor");
                if (multiplexors > 1) continue;
                each.selected_by = plain;
                select(each, each.page);
            }
            std::size_t steps = 0;
            for (std::size_t up = each.selected_by; up != no_such && steps <= signals.size(); ++steps)
                up = net_.signals[up].selected_by;
            if (steps <= signals.size()) continue;
            spoil(each.at, "signal \"", each.shape.name, "\" is selected by itself, through others");
            each.selected_by = no_such;
        }
        for (SignalRow& each : signals)
            if (!each.long_name.empty()) each.shape.name = each.long_name;
        for (SignalRow& each : signals)
            if (each.selected_by != no_such)
                each.shape.multiplexor = net_.signals[each.selected_by].shape.name;
        if (!message.long_name.empty()) message.name = message.long_name;
    }

    bool has_nodes_ = false;
    Duration usual_every_{};
    Choice fd_ = can_fd, switch_ = bit_rate_switch, demand_ = send_type;
};

} // namespace tappet::can::dbc
