// Reads messages and signals of a DBC file: BO_ and SG_.
#pragma once

#include "drivers/can/dbc/items.hpp"

namespace tappet::can::dbc {

class MessageReader : protected Items {
protected:
    static constexpr std::uint32_t extended_bit = 0x8000'0000, independent_id = 0xC000'0000;

    using Items::Items;

    static std::uint32_t raw_id(const MessageRow& message) noexcept {
        return message.identifier.id | (message.identifier.extended ? extended_bit : 0);
    }
    /// Returns the first message with this identifier, from `first` on; no_such: none. Most statements are
    /// about the message of the statement before.
    std::size_t message_of(std::uint32_t id, std::size_t first = 0) noexcept {
        if (first == 0 && found_ != no_such && id == found_id_) return found_;
        std::size_t m = first;
        for (const MessageRow& each : std::span{net_.messages}.subspan(first)) {
            if (raw_id(each) == id && !each.is_independent) break;
            ++m;
        }
        if (m == net_.messages.size()) return no_such;
        if (first == 0) found_ = m, found_id_ = id;
        return m;
    }

    // ---- nodes

    void check_nodes(std::string_view list) {
        if (list == checked_nodes_) return;
        checked_nodes_ = list; // most lists equal the previous one
        for_each_name(list, [&](std::string_view node) {
            if (node == nobody || names(net_.nodes.names, node)) return;
            Nearest nearest{node};
            for_each_name(net_.nodes.names, [&](std::string_view each) { nearest.consider(each); });
            note(net_.position_of(node), "BU_ names no node \"", node, "\"", or_meant(nearest, ""));
        });
    }
    /// Returns the names up to the end of the line, or to something else.
    NodeList node_list() {
        const std::size_t from = in_.at();
        std::size_t end = from;
        while (!in_.at_end() && !in_.begins_line() && !in_.name().empty()) {
            in_.take(',');
            end = in_.at();
        }
        return {end == from ? std::string_view{} : in_.since(from), from};
    }

    // ---- statements

    void message_statement() {
        if (!in_.begins_statement(statement_at_))
            return give_up(statement_at_, "BO_ is in the middle of a line; begin a new one");
        MessageRow& row = net_.messages.emplace_back();
        row.first = net_.signals.size();
        const std::size_t id_at = row.at = in_.at();
        const std::uint32_t id = whole(0xffff'ffff, "a message's identifier");
        row.at = in_.at();
        row.name = label("a message's name");
        row.identifier = {id & ~extended_bit, (id & extended_bit) != 0};
        row.is_independent = id == independent_id || row.name == independent;
        expect(':', "\":\" after the message's name");
        row.length = whole(0xffff'ffff, "the message's length in bytes");
        row.sender.at = in_.at();
        row.sender.names = label("the node that sends the message");
        takes_signals_ = true;
        if (!ok() || row.is_independent) return;
        about(row);
        check_nodes(row.sender.names);
        part_ = Part::identifier;
        if (!valid(row.identifier))
            spoil(id_at, "message \"", row.name, "\" has the identifier ", std::uint64_t{id},
                  ": a standard one ends at 2047, an extended one has bit 31 set and 29 bits");
        part_ = Part::all;
        for (MessageRow& each : std::span{net_.messages}.first(net_.messages.size() - 1)) {
            if (each.is_independent) continue;
            if (each.identifier == row.identifier) {
                // Either may be taken, so none is spoilt.
                net_.troubles.push_back(
                    {id_at, Weight::fault, message_, no_such,
                     Sentence{"message \"", row.name, "\" has the identifier of \"", each.name, "\""}});
                each.shares_identifier = row.shares_identifier = true;
            }
            if (each.name == row.name) {
                spoil(row.at, "message \"", row.name, "\" is there twice");
                mark(each.troubles[0], last_trouble());
            }
        }
    }

    void signal_statement() {
        if (net_.messages.empty())
            return give_up(in_.at(), "a signal without a message; write BO_ before it");
        MessageRow& owner = net_.messages.back();
        if (!takes_signals_) return give_up(in_.at(), "a signal that is not behind its message");
        if (!in_.begins_statement(statement_at_, "BO_"))
            return give_up(in_.at(), "SG_ is in the middle of a line; begin a new one");
        SignalRow& row = net_.signals.emplace_back();
        row.at = in_.at();
        row.message = net_.messages.size() - 1;
        ++owner.signals;
        about(row);
        if (owner.is_independent) weight_ = Weight::note;
        shape(row);
        row.receivers = node_list();
        if (ok() && !in_.at_end() && !in_.begins_line())
            fail_expected("a node that receives the signal, or the end of the line");
        if (!ok()) return;
        check_nodes(row.receivers.names);
        const Signal& s = row.shape;
        if (SignalRow* const other = net_.find(owner, s.name); other != &row) {
            spoil(row.at, "message \"", owner.name, "\" has two signals \"", s.name, "\"");
            mark(other->trouble, last_trouble());
        }
    }
    /// Reads a signal up to its unit.
    void shape(SignalRow& row) {
        Signal& s = row.shape;
        s.name = label("a signal's name");
        const std::size_t multiplexing_at = in_.at();
        if (const std::string_view written = in_.word(); !written.empty())
            multiplexing(row, written, multiplexing_at);
        expect(':', "\":\" after the signal's name");
        s.start = static_cast<std::uint16_t>(whole(0xffff, "the signal's first bit"));
        expect('|', "\"|\" after the signal's first bit");
        const std::size_t bits_at = in_.at();
        s.bits = static_cast<std::uint8_t>(whole(64, "the number of the signal's bits"));
        if (s.bits == 0 && row.trouble == no_such)
            spoil(bits_at, "signal \"", s.name, "\" has 0 bits instead of 1 to 64");
        expect('@', "\"@\" after the number of the signal's bits");
        const std::size_t order_at = in_.at();
        const std::uint32_t order = whole(0xffff'ffff, "the byte order, 0 (Motorola) or 1 (Intel)");
        if (order > 1) give_up(order_at, order, " is no byte order: 0 (Motorola) or 1 (Intel)");
        s.order = order == 1 ? Order::intel : Order::motorola;
        if (ok() && in_.take('-'))
            s.kind = Kind::signed_integer;
        else
            expect('+', "\"+\" (unsigned) or \"-\" (signed)");
        expect('(', "\"(\" before factor and offset");
        const std::size_t factor_at = in_.at();
        s.factor = real("the factor");
        row.factor = in_.since(factor_at);
        if (s.factor == 0 && ok())
            spoil(factor_at, "signal \"", s.name, "\" has the factor 0: every value would be the offset");
        expect(',', "\",\" between factor and offset");
        const std::size_t offset_at = in_.at();
        s.offset = real("the offset");
        row.offset = in_.since(offset_at);
        expect(')', "\")\" after factor and offset");
        expect('[', "\"[\" before the least value");
        const std::size_t limits_at = in_.at();
        s.least = limit("the least value", '|');
        expect('|', "\"|\" between the least and the greatest value");
        s.most = limit("the greatest value", ']');
        expect(']', "\"]\" after the greatest value");
        s.has_range = s.least != 0 || s.most != 0; // [0|0] means no range
        if (ok() && s.least > s.most && row.limits_trouble == no_such)
            tell(Weight::limits, limits_at, "signal \"", s.name, "\" has an empty range");
        if (row.limits_trouble != no_such) s.least = s.most = 0, s.has_range = false;
        s.unit = text("the unit between quotes");
    }
    /// Reads "M", "m12" or "m12M".
    void multiplexing(SignalRow& row, std::string_view written, std::size_t at) {
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
            fail(at, "found \"", written, "\", expected \":\" or M, m0 or m0M of a multiplexed signal");
    }

    void select(SignalRow& signal, const Selection& more) {
        auto& all = signal.shape.selections;
        if (!all.empty() && more.from != 0 && all[all.size() - 1].to == more.from - 1)
            all[all.size() - 1].to = more.to;
        else if (!all.push(more))
            spoil(signal.at, "signal \"", signal.shape.name, "\" is selected by more than ",
                  Signal::most_selections, " ranges");
    }

    bool takes_signals_ = false; ///< no other statement came since BO_

private:
    std::string_view checked_nodes_{};
    std::size_t found_ = no_such;
    std::uint32_t found_id_ = 0;
};

} // namespace tappet::can::dbc
