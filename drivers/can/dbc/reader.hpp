// Reads a DBC file on the host.
// Leniency is a closed list: a fault makes the whole file unreadable, unless it is certain which row it
// concerns. Then it marks the row, and only a map that takes the row is refused.
#pragma once

#include "drivers/can/dbc/attribute_reader.hpp"

namespace tappet::can::dbc {

class Reader : AttributeReader {
public:
    explicit Reader(Network& network) noexcept : AttributeReader{network} {}

    /// Fills the network; its fault says why nothing of the file can be used.
    void read() {
        if (net_.text.size() != without_mark(net_.text).size())
            note(0, "the file begins with a byte-order mark");
        while (net_.fault.empty() && !in_.at_end()) statement();
        begin(0);
        if (!has_statement_ && net_.fault.empty()) give_up(0, "the file has no statement; is it a DBC file?");
        for (MessageRow& message : net_.messages)
            if (net_.fault.empty() && !message.is_independent) finish(message);
    }

private:
    // ---- statements

    void statement() {
        if (in_.take(';')) return;
        begin(in_.at());
        has_statement_ = true;
        const std::string_view keyword = in_.word();
        if (keyword == "SG_") return signal_statement();
        if (keyword == "BO_") return message_statement();
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
            give_up(statement_at_, "found \"", keyword.empty() ? in_.found() : keyword,
                    "\", expected a statement, which begins with BO_, SG_, VAL_ or the like");
        if (failed_ && net_.fault.empty()) skip_statement();
    }
    void new_symbols() {
        expect(':', "\":\" after NS_");
        while (ok() && !in_.at_end()) {
            Scanner ahead = in_;
            const std::string_view symbol = ahead.word();
            const bool is_next = symbol == "BS_" || symbol == "BU_" || is_digit(ahead.next());
            if (symbol.empty() || is_next || ahead.next() == '"') return;
            in_ = ahead;
        }
    }
    void bit_timing() {
        expect(':', "\":\" after BS_");
        std::uint64_t ignored = 0;
        while (ok() && (in_.whole(ignored) || in_.take(':') || in_.take(',') || in_.take(';'))) {
        }
    }
    void nodes() {
        expect(':', "\":\" after BU_");
        if (!ok()) return;
        if (has_nodes_) return give_up(statement_at_, "BU_ is there twice");
        // Nodes may continue on further lines: the next statement ends them.
        const std::size_t from = in_.at();
        while (!in_.at_end() && !is_statement(in_.peek()) && !in_.name().empty()) in_.take(',');
        in_.take(';');
        net_.nodes = {in_.since(from), from};
        has_nodes_ = true;
    }
    void senders() {
        if (!known_message(false)) return;
        expect(':', "\":\" before the nodes that send the message");
        const NodeList list = ok() ? node_list() : NodeList{};
        if (list.names.empty() && ok()) fail_expected("a node that sends the message");
        check_nodes(list.names);
        end_of_statement();
        if (!ok()) return;
        for_each_twin([&](MessageRow& each) {
            if (!each.more_senders.names.empty())
                give_up(statement_at_, "message \"", each.name, "\" has BO_TX_BU_ twice");
            each.more_senders = list;
        });
    }

    /// Names of values are texts: the signal lacks those that cannot be believed, and what uses one is
    /// refused.
    void values() {
        weight_ = Weight::note;
        if (!in_.peek().empty()) return skip_statement(); // of an environment variable
        if (!known_message(false) || !known_signal()) return;
        const Signal& shape = the_signal().shape;
        const std::size_t first = net_.values.size();
        while (ok() && in_.next() != ';' && !in_.at_end() && !begins_statement(in_)) value(the_signal());
        end_of_statement();
        if (!ok()) return;
        for_each_namesake([&](SignalRow& row) {
            const bool is_second = row.names_at != no_such;
            const bool is_other = row.shape.bits != shape.bits || row.shape.kind != shape.kind;
            if (is_second)
                note(statement_at_, "signal \"", shape.name,
                     "\" has its values named twice; none of the names counts");
            else if (is_other)
                note(row.at, "signal \"", shape.name,
                     "\" has another type than its namesake, whose names of "
                     "values it does not take");
            row.names_at = statement_at_;
            row.first_value = first;
            row.values = is_second || is_other ? 0 : net_.values.size() - first;
        });
    }
    void value(const SignalRow& row) {
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
        net_.values.push_back(value);
    }

    void value_type() {
        if (!known_message(true) || !known_signal()) return;
        in_.take(':');
        const std::size_t at = in_.at();
        const std::uint32_t kind = whole(2, "0 (integer), 1 (float) or 2 (double)");
        end_of_statement();
        if (!ok()) return;
        for_each_namesake([&](SignalRow& row) {
            concern(row);
            Signal& s = row.shape;
            const Kind was = s.kind;
            const bool was_real = was == Kind::float32 || was == Kind::float64;
            const Kind now = kind == 1 ? Kind::float32 : kind == 2 ? Kind::float64 : was;
            if (was_real && (kind == 0 || was != now))
                spoil(at, "signal \"", s.name, "\" has two types");
            else if (kind != 0 && s.bits != 32 * kind)
                spoil(at, "signal \"", s.name, "\" has ", unsigned{s.bits}, " bits, but a ",
                      kind == 1 ? "float" : "double", " has ", 32 * kind);
            else
                s.kind = now;
        });
    }
    /// From here on, faults concern this row alone.
    void concern(const SignalRow& row) {
        about(row);
        is_by_identifier_ = false;
    }

    template <class Visit> void each_range(const Visit& visit) {
        do {
            const std::size_t from_at = in_.at();
            const std::uint32_t from = whole(0xffff'ffff, "the first value of a range");
            expect('-', "\"-\" between the ends of a range");
            const std::uint32_t to = whole(0xffff'ffff, "the last value of a range");
            if (to < from && ok()) fail(from_at, "an empty range");
            if (ok()) visit(Selection{from, to});
        } while (ok() && in_.take(','));
    }
    void selections() {
        if (!known_message(true)) return;
        part_ = Part::selection;
        const std::size_t signal_at = in_.at();
        if (!known_signal()) return;
        const std::size_t at = in_.at();
        const std::string_view by = label("a multiplexor's name");
        const Scanner ranges = in_;
        each_range([](const Selection&) {});
        end_of_statement();
        const Scanner end = in_;
        if (!ok()) return;
        for_each_namesake([&](SignalRow& row) {
            concern(row);
            const SignalRow* const multiplexor = net_.find(the_message(), by);
            const auto index = static_cast<std::size_t>(multiplexor - net_.signals.data());
            if (multiplexor == nullptr)
                return spoil(at, "signal \"", row.shape.name, "\" has an unknown multiplexor");
            if (!multiplexor->is_multiplexor)
                return spoil(at, "signal \"", by, "\" selects others but is not a multiplexor");
            if (!row.is_multiplexed)
                return spoil(signal_at, "signal \"", row.shape.name, "\" is selected but not multiplexed");
            if (row.selected_by != no_such && row.selected_by != index)
                return spoil(at, "signal \"", row.shape.name, "\" has two multiplexors");
            in_ = ranges;
            each_range([&](const Selection& each) { select(row, each); });
            row.selected_by = index;
        });
        in_ = end;
    }
    // ---- a complete message

    void finish(MessageRow& message) {
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
            part_ = Part::selection;
            if (each.selection_trouble != no_such) continue;
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

    bool has_statement_ = false;
    bool has_nodes_ = false;
};

} // namespace tappet::can::dbc
