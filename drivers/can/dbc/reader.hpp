// Reads a DBC file, in a constant expression or on the host, with the same code and the same fault messages.
#pragma once

#include "drivers/can/dbc/choice.hpp"
#include "drivers/can/dbc/network.hpp"
#include "drivers/can/dbc/scanner.hpp"
#include "kernel/base/decimal.hpp"

namespace tappet::can::dbc {

class Reader {
public:
    explicit constexpr Reader(Network& network) noexcept : net_{network}, in_{network.text} {}

    /// Fills the network, or its fault.
    constexpr void read() {
        while (ok() && !in_.at_end()) statement();
        for (MessageRow& message : net_.all())
            if (ok() && !message.is_independent) finish(message);
    }

private:
    static constexpr std::uint32_t extended_bit = 0x8000'0000, independent_id = 0xC000'0000;

    // ---- expected items

    [[nodiscard]] constexpr bool ok() const noexcept { return net_.fault.empty(); }
    template <class... Pieces> constexpr void fail(std::size_t at, const Pieces&... pieces) {
        net_.fail(at, pieces...);
    }
    constexpr void fail_expected(std::string_view what) {
        if (in_.at_end())
            fail(in_.at(), "the file ends, expected ", what, "; is it whole?");
        else if (in_.next() == '"')
            fail(in_.at(), "a text is unclosed or out of place, expected ", what,
                 "; close the quotes in the same line");
        else
            fail(in_.at(), "found \"", in_.found(), "\", expected ", what, "; correct it");
    }
    constexpr void expect(char c, std::string_view what) {
        if (ok() && !in_.take(c)) fail_expected(what);
    }
    constexpr std::string_view word(std::string_view what) {
        const std::string_view word = ok() ? in_.word() : std::string_view{};
        if (word.empty() && ok()) fail_expected(what);
        return word;
    }
    /// Returns a number, or 0 after a fault.
    constexpr std::uint32_t whole(std::uint64_t most, std::string_view what) {
        const std::size_t at = in_.at();
        std::uint64_t value = 0;
        if (!ok()) return 0;
        if (!in_.whole(value))
            fail_expected(what);
        else if (value > most)
            fail(at, value, " is too large for ", what, ", which is ", most, " at most; correct it");
        return ok() ? static_cast<std::uint32_t>(value) : 0;
    }
    constexpr double real(std::string_view what) {
        double value = 0;
        if (ok() && !in_.real(value)) fail_expected(what);
        return value;
    }
    constexpr std::string_view text(std::string_view what, bool of_many_lines = false) {
        std::string_view text;
        if (ok() && !in_.text(text, of_many_lines)) fail_expected(what);
        return text;
    }
    constexpr void end_of_statement() { expect(';', "\";\", the end of the statement"); }
    constexpr void skip_statement() {
        if (!ok() || in_.skip_statement()) return;
        if (in_.at_end())
            fail(in_.at(), "the file ends, expected \";\", the end of a statement; is it whole?");
        else
            fail(in_.at(), "a text is unclosed; close its quotes");
    }

    // ---- look-up: an unknown message, or one in Vector's container, is nullptr

    constexpr MessageRow* message_of(std::uint32_t id) const noexcept {
        for (MessageRow& each : net_.all())
            if (each.is_independent ? id == independent_id : id == raw_id(each)) return &each;
        return nullptr;
    }
    static constexpr std::uint32_t raw_id(const MessageRow& message) noexcept {
        return message.identifier.id | (message.identifier.extended ? extended_bit : 0);
    }
    constexpr MessageRow* known_message() {
        const std::size_t at = in_.at();
        const std::uint32_t id = whole(0xffff'ffff, "a message's identifier");
        MessageRow* const found = ok() ? message_of(id) : nullptr;
        if (ok() && found == nullptr && id != independent_id)
            fail(at, "no message has the identifier ", std::uint64_t{id},
                 "; define it by BO_ before it is used");
        return found;
    }
    constexpr SignalRow* known_signal(const MessageRow* message) {
        const std::size_t at = in_.at();
        const std::string_view name = word("a signal's name");
        if (message == nullptr || message->is_independent || !ok()) return nullptr;
        SignalRow* const found = net_.find(*message, name);
        if (found != nullptr) return found;
        Nearest nearest{name};
        for (const SignalRow& each : net_.of(*message)) nearest.consider(each.shape.name);
        fail(at, "message \"", message->name, "\" has no signal \"", name, "\"",
             or_meant(nearest, "; define it by SG_ in its message"));
        return nullptr;
    }
    constexpr void check_nodes(std::string_view list) {
        if (list == checked_nodes_) return; // most lists equal the previous one
        checked_nodes_ = list;
        for_each_name(list, [&](std::string_view node) {
            if (!ok() || node == nobody || names(net_.nodes, node)) return;
            Nearest nearest{node};
            for_each_name(net_.nodes, [&](std::string_view each) { nearest.consider(each); });
            fail(static_cast<std::size_t>(node.data() - net_.text.data()), "BU_ names no node \"", node, "\"",
                 or_meant(nearest, "; add it there"));
        });
    }
    /// Returns the names up to the end of the line, or to something else.
    constexpr std::string_view node_list() {
        const std::size_t from = in_.at();
        std::size_t end = from;
        while (!in_.at_end() && !in_.begins_line() && !in_.word().empty()) {
            in_.take(',');
            end = in_.at();
        }
        return end == from ? std::string_view{} : in_.since(from);
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
    constexpr void statement() {
        const std::size_t at = in_.at();
        const std::string_view keyword = in_.word();
        if (keyword == "SG_") return signal();
        takes_signals_ = false;
        if (keyword == "BO_") return message(at);
        if (keyword == "VAL_") return values();
        if (keyword == "BA_") return attribute();
        if (keyword == "BA_DEF_") return attribute_definition();
        if (keyword == "BA_DEF_DEF_") return attribute_default();
        if (keyword == "BO_TX_BU_") return senders();
        if (keyword == "SIG_VALTYPE_") return value_type();
        if (keyword == "SG_MUL_VAL_") return selections();
        if (keyword == "BU_") return nodes(at);
        if (keyword == "NS_") return new_symbols();
        if (keyword == "BS_") return bit_timing();
        if (keyword == "VERSION") return static_cast<void>(text("the version between quotes"));
        if (is_passed_over(keyword)) return skip_statement();
        fail(at, "found \"", keyword.empty() ? in_.found() : keyword,
             "\", expected a statement, which begins with BO_, SG_, VAL_ or the like; correct it");
    }
    constexpr void new_symbols() {
        expect(':', "\":\" after NS_");
        while (ok() && in_.peek() != "BS_" && in_.peek() != "BU_" && !in_.word().empty()) {
        }
    }
    constexpr void bit_timing() {
        expect(':', "\":\" after BS_");
        std::uint64_t ignored = 0;
        while (ok() && (in_.whole(ignored) || in_.take(':') || in_.take(',') || in_.take(';'))) {
        }
    }
    constexpr void nodes(std::size_t at) {
        expect(':', "\":\" after BU_");
        if (!ok()) return;
        if (has_nodes_) return fail(at, "BU_ is there twice; put all nodes into one");
        has_nodes_ = true;
        // Nodes may continue on further lines: the next statement ends them.
        const std::size_t from = in_.at();
        while (!in_.at_end() && !is_statement(in_.peek()) && !in_.word().empty()) in_.take(',');
        net_.nodes = in_.since(from);
    }
    constexpr void message(std::size_t statement_at) {
        const std::size_t id_at = in_.at();
        const std::uint32_t id = whole(0xffff'ffff, "a message's identifier");
        MessageRow row;
        row.at = in_.at();
        row.name = word("a message's name");
        expect(':', "\":\" after the message's name");
        row.length = static_cast<std::uint16_t>(whole(0xffff, "the message's length in bytes"));
        const std::size_t sender_at = in_.at();
        row.sender = word("the node that sends the message");
        if (!ok()) return;
        row.is_independent = id == independent_id;
        row.identifier = {id & ~extended_bit, (id & extended_bit) != 0};
        row.first = net_.used.signals;
        if (!row.is_independent) {
            check_nodes(net_.text.substr(sender_at, row.sender.size()));
            if (!valid(row.identifier))
                fail(id_at, "message \"", row.name, "\" has the identifier ", std::uint64_t{id},
                     ": a standard one ends at 2047, an extended one has bit 31 set and 29 bits; correct it");
            for (const MessageRow& each : net_.all()) {
                if (!each.is_independent && each.identifier == row.identifier)
                    fail(id_at, "message \"", row.name, "\" has the identifier of \"", each.name,
                         "\"; give it its own");
                if (each.name == row.name)
                    fail(row.at, "message \"", row.name, "\" is there twice; rename one of them");
            }
        }
        if (net_.used.messages == net_.messages.size())
            return fail(statement_at, "BO_ is in the middle of a line; begin a new one");
        net_.messages[net_.used.messages++] = row;
        takes_signals_ = true;
    }

    constexpr void signal() {
        if (net_.used.messages == 0) return fail(in_.at(), "a signal without a message; write BO_ before it");
        MessageRow& owner = net_.messages[net_.used.messages - 1];
        SignalRow row;
        row.at = in_.at();
        row.message = net_.used.messages - 1;
        Signal& s = row.shape;
        s.name = word("a signal's name");
        const std::size_t multiplexing_at = in_.at();
        if (const std::string_view written = in_.word(); !written.empty())
            multiplexing(row, written, multiplexing_at);
        expect(':', "\":\" after the signal's name");
        s.start = static_cast<std::uint16_t>(whole(0xffff, "the signal's first bit"));
        expect('|', "\"|\" after the signal's first bit");
        const std::size_t bits_at = in_.at();
        s.bits = static_cast<std::uint8_t>(whole(64, "the number of the signal's bits"));
        if (ok() && s.bits == 0) fail(bits_at, "signal \"", s.name, "\" has 0 bits; give it 1 to 64");
        expect('@', "\"@\" after the number of the signal's bits");
        s.order = whole(1, "the byte order, 0 (Motorola) or 1 (Intel)") == 1 ? Order::intel : Order::motorola;
        if (ok() && in_.take('-'))
            s.kind = Kind::signed_integer;
        else
            expect('+', "\"+\" (unsigned) or \"-\" (signed)");
        expect('(', "\"(\" before factor and offset");
        s.factor = real("the factor");
        expect(',', "\",\" between factor and offset");
        s.offset = real("the offset");
        expect(')', "\")\" after factor and offset");
        expect('[', "\"[\" before the least value");
        s.least = real("the least value");
        expect('|', "\"|\" between the least and the greatest value");
        s.most = real("the greatest value");
        expect(']', "\"]\" after the greatest value");
        s.has_range = s.least != 0 || s.most != 0; // [0|0] means no range
        s.unit = text("the unit between quotes");
        if (!ok()) return;
        row.receivers = node_list();
        if (owner.is_independent) return;
        if (!takes_signals_)
            return fail(row.at, "signal \"", s.name, "\" is not in its message; put it under its BO_");
        check_nodes(row.receivers);
        if (net_.find(owner, s.name) != nullptr)
            fail(row.at, "message \"", owner.name, "\" has two signals \"", s.name, "\"; rename one of them");
        if (net_.used.signals == net_.signals.size())
            return fail(row.at, "SG_ is in the middle of a line; begin a new one");
        net_.signals[net_.used.signals++] = row;
        ++owner.signals;
    }
    /// Reads "M", "m12" or "m12M".
    constexpr void multiplexing(SignalRow& row, std::string_view written, std::size_t at) {
        std::string_view left = written;
        row.is_multiplexed = left.starts_with('m');
        if (row.is_multiplexed) {
            left.remove_prefix(1);
            std::uint64_t page = 0;
            std::size_t digits = 0;
            for (; digits < left.size() && digits < 10 && is_digit(left[digits]); ++digits)
                page = 10 * page + static_cast<unsigned>(left[digits] - '0');
            if (digits == 0 || page > 0xffff'ffff) left = "-";
            row.page = static_cast<std::uint32_t>(page);
            left.remove_prefix(digits < left.size() ? digits : left.size());
        }
        row.is_multiplexor = left == "M";
        if (!left.empty() && !row.is_multiplexor)
            fail(at, "found \"", written,
                 "\", expected \":\" or M, m0 or m0M of a multiplexed signal; correct it");
    }

    constexpr void senders() {
        MessageRow* const message = known_message();
        expect(':', "\":\" before the nodes that send the message");
        const std::string_view list = node_list();
        check_nodes(list);
        end_of_statement();
        if (ok() && message != nullptr) message->more_senders = list;
    }

    constexpr void values() {
        if (!in_.peek().empty()) return skip_statement(); // of an environment variable
        SignalRow* const signal = known_signal(known_message());
        if (!ok()) return;
        if (signal != nullptr && signal->values != 0)
            return fail(in_.at(), "signal \"", signal->shape.name,
                        "\" has its values named twice; keep one VAL_");
        if (signal != nullptr) signal->first_value = net_.used.values;
        while (ok() && !in_.take(';')) {
            ValueName value;
            const std::size_t at = in_.at();
            if (double real = 0; !in_.integer(value.value)) {
                // Some tools write "3.0" for 3.
                if (!in_.real(real) || real != static_cast<double>(static_cast<std::int64_t>(real)))
                    return fail_expected("a value and its name, or \";\"");
                value.value = static_cast<std::int64_t>(real);
            }
            value.name = text("the value's name between quotes");
            if (!ok() || signal == nullptr) continue;
            if (net_.used.values == net_.values.size())
                return fail(at, "too many values; is the file whole?");
            net_.values[net_.used.values++] = value;
            ++signal->values;
        }
    }

    constexpr void value_type() {
        SignalRow* const signal = known_signal(known_message());
        in_.take(':');
        const std::size_t at = in_.at();
        const std::uint32_t kind = whole(2, "0 (integer), 1 (float) or 2 (double)");
        end_of_statement();
        if (!ok() || signal == nullptr || kind == 0) return;
        if (signal->shape.bits != 32 * kind)
            return fail(at, "signal \"", signal->shape.name, "\" has ", unsigned{signal->shape.bits},
                        " bits, but a ", kind == 1 ? "float" : "double", " has ", 32 * kind,
                        "; correct one of them");
        signal->shape.kind = kind == 1 ? Kind::float32 : Kind::float64;
    }

    constexpr void selections() {
        const MessageRow* const message = known_message();
        const std::size_t signal_at = in_.at();
        SignalRow* const signal = known_signal(message);
        const std::size_t at = in_.at();
        const SignalRow* const multiplexor = known_signal(message);
        if (ok() && multiplexor != nullptr && !multiplexor->is_multiplexor)
            return fail(at, "signal \"", multiplexor->shape.name,
                        "\" selects others but is not a multiplexor; write M behind its name");
        if (ok() && signal != nullptr && !signal->is_multiplexed)
            return fail(signal_at, "signal \"", signal->shape.name,
                        "\" is selected but not multiplexed; write m and a number behind its name");
        do {
            const std::size_t from_at = in_.at();
            const std::uint32_t from = whole(0xffff'ffff, "the first value of a range");
            expect('-', "\"-\" between the ends of a range");
            const std::uint32_t to = whole(0xffff'ffff, "the last value of a range");
            if (ok() && to < from) fail(from_at, "an empty range; exchange its bounds");
            if (ok() && signal != nullptr) select(*signal, {from, to});
        } while (ok() && in_.take(','));
        end_of_statement();
        if (ok() && signal != nullptr)
            signal->selected_by = static_cast<std::size_t>(multiplexor - net_.signals.data());
    }
    static constexpr void select(SignalRow& signal, const Selection& more) noexcept {
        auto& all = signal.shape.selections;
        if (!all.empty() && more.from != 0 && all[all.size() - 1].to == more.from - 1)
            all[all.size() - 1].to = more.to;
        else
            signal.too_many_selections |= !all.push(more);
    }

    // ---- attributes: the cycle time, CAN FD, and names of more than 32 characters

    constexpr Choice* choice(std::string_view attribute) noexcept {
        return attribute == fd_.attribute ? &fd_ : attribute == switch_.attribute ? &switch_ : nullptr;
    }
    constexpr bool chosen(const Choice& among) {
        if (in_.next() == '"') return among.says_yes(text("the attribute's value"));
        return among.says_yes(whole(63, "the number of the attribute's value"));
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
    }

    constexpr Duration cycle_time() {
        const std::size_t at = in_.at();
        const double ms = real("the cycle time in milliseconds");
        if (ok() && !(ms >= 0 && ms < 1e9)) fail(at, "a cycle time of ", decimal(ms), " ms; correct it");
        return ok() ? Duration{static_cast<std::int64_t>(ms * 1e6 + 0.5)} : Duration{};
    }
    constexpr void attribute() {
        const std::string_view name = text("an attribute's name between quotes");
        const std::string_view of = in_.peek();
        const bool is_period = name == "GenMsgCycleTime" && of == "BO_";
        const bool is_message_name = name == "SystemMessageLongSymbol" && of == "BO_";
        const bool is_signal_name = name == "SystemSignalLongSymbol" && of == "SG_";
        const Choice* const among = of == "BO_" ? choice(name) : nullptr;
        if (!ok() || (!is_period && !is_message_name && !is_signal_name && among == nullptr))
            return skip_statement();
        in_.word();
        MessageRow* const message = known_message();
        SignalRow* const signal = is_signal_name ? known_signal(message) : nullptr;
        if (among != nullptr) {
            const bool yes = chosen(*among);
            if (message != nullptr) (among == &fd_ ? message->is_fd : message->switches) = yes;
        } else if (is_period) {
            const Duration every = cycle_time();
            if (ok() && message != nullptr) {
                message->every = every;
                message->says_every = true;
            }
        } else {
            const std::string_view long_name = text("a name between quotes");
            if (ok() && signal != nullptr) signal->long_name = long_name;
            if (ok() && message != nullptr && is_message_name) message->long_name = long_name;
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

    constexpr void finish(MessageRow& message) {
        if (!message.says_every) message.every = usual_every_;
        if (!message.is_fd) message.is_fd = fd_.usually;
        if (!message.switches) message.switches = switch_.usually;
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
            if (each.selected_by == no_such) {
                if (multiplexors > 1)
                    return fail(each.at, "message \"", message.name,
                                "\" has several multiplexors; say by SG_MUL_VAL_ which one selects \"",
                                each.shape.name, "\"");
                if (plain == no_such)
                    return fail(each.at, "signal \"", each.shape.name,
                                "\" is multiplexed but its message has no multiplexor; write M behind the "
                                "name of one");
                each.selected_by = plain;
                select(each, each.page);
            }
            std::size_t steps = 0;
            for (std::size_t up = each.selected_by; up != no_such && steps <= signals.size(); ++steps)
                up = net_.signals[up].selected_by;
            if (steps > signals.size())
                return fail(each.at, "signal \"", each.shape.name,
                            "\" is selected by itself, through others; correct SG_MUL_VAL_");
        }
        for (SignalRow& each : signals)
            if (!each.long_name.empty()) each.shape.name = each.long_name;
        for (SignalRow& each : signals)
            if (each.is_multiplexed) each.shape.multiplexor = net_.signals[each.selected_by].shape.name;
        if (!message.long_name.empty()) message.name = message.long_name;
    }

    Network& net_;
    Scanner in_;
    std::string_view checked_nodes_{};
    bool has_nodes_ = false;
    bool takes_signals_ = false;
    Duration usual_every_{};
    Choice fd_ = can_fd, switch_ = bit_rate_switch;
};

} // namespace tappet::can::dbc
