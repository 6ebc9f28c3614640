// Selects the part of a DBC file that one node uses: its frames and signals as rows of a signal map. Only
// this part must be free of faults.
#pragma once

#include "drivers/can/dbc/table.hpp"
#include "drivers/can/dbc/value_rows.hpp"
#include "kernel/base/decimal.hpp"

namespace tappet::can::dbc {

/// The sizes that the map of a node needs.
struct Sizes {
    std::size_t frames = 0, signals = 0, values = 0;
};

class Taking {
public:
    /// `rows`: the candidates among the table's messages; `fault`: receives the first fault.
    constexpr Taking(const Table& table, const Rows& rows, const Told* told, const NodeView& node,
                     Sentence& fault) noexcept
        : table_{table}, rows_{rows}, told_{told}, node_{node}, fault_text_{fault} {}

    /// Marks the node's frames and signals.
    constexpr Sizes take() {
        find_node();
        for (const FrameRow& row : node_.frames) find_message(row);
        Sizes sizes;
        for (MessageRow& message : rows_.messages) {
            if (!ok()) continue;
            take_message(message);
            if (message.is_taken && ok()) add(sizes, message);
        }
        if (faults_ != 0 && ok()) refuse();
        return sizes;
    }
    /// Fills a map of at least these sizes.
    template <std::size_t F, std::size_t S>
    constexpr void fill(SignalMap<F, S>& map, ValueName* values) {
        std::array<const MessageRow*, F> messages{};
        std::array<const SignalRow*, S> signals{};
        values_ = values;
        std::size_t f = 0, s = 0;
        for (MessageRow& message : rows_.messages) {
            if (!message.is_taken) continue;
            messages[f] = &message;
            FrameRow& frame = map.frames[f++];
            frame = frame_of(message);
            frame.first = s;
            // A multiplexor comes before the signals it selects.
            const auto all = rows_.of(message);
            for (std::size_t depth = 0; s - frame.first < count(message) && depth <= all.size(); ++depth)
                for (SignalRow& each : all) {
                    if (!each.is_taken || depth_of(each) != depth) continue;
                    each.placed = s;
                    signals[s] = &each;
                    map.signals[s++] = signal_of(each, map.signals);
                }
            frame.values = s - frame.first;
        }
        const detail::MapFault fault = detail::complete(map, f);
        if (fault.text.empty()) return;
        const MessageRow& message = *messages[fault.frame];
        const SignalRow* const signal = fault.signal == no_such ? nullptr : signals[fault.signal];
        fail(signal != nullptr ? signal->at : message.at, fault.text,
             fault.cure.empty() ? Sentence{}
                                : cure(message, signal, message.length > 8 ? "fd_bytes(..), " : ""));
    }

private:
    /// Refuses the map; only the first fault counts.
    template <class... Pieces> constexpr void fail(std::size_t at, const Pieces&... pieces) {
        if (!ok()) return;
        FieldReader lines{table_.lines};
        std::size_t line = 1, left = at;
        for (std::uint64_t size = lines.number(); size <= left; size = lines.number(), ++line)
            left -= static_cast<std::size_t>(size);
        fault_text_ = Sentence{table_.file, ":", line, ":", left + 1, ": ", pieces...};
    }
    [[nodiscard]] static constexpr bool sends(const MessageRow& message, std::string_view node) noexcept {
        return message.sender.names == node || names(message.more_senders.names, node);
    }
    [[nodiscard]] constexpr bool ok() const noexcept { return fault_text_.empty(); }
    static constexpr std::string_view in_file(const auto& row) noexcept {
        return row.in_file.empty() ? row.name : row.in_file;
    }
    [[nodiscard]] constexpr std::size_t depth_of(const SignalRow& signal) const noexcept {
        std::size_t depth = 0;
        for (std::size_t up = signal.selected_by; up != no_such; up = rows_.signals[up].selected_by) ++depth;
        return depth;
    }
    [[nodiscard]] constexpr std::size_t count(const MessageRow& message) const noexcept {
        std::size_t taken = 0;
        for (const SignalRow& each : rows_.of(message)) taken += each.is_taken;
        return taken;
    }

    // ---- names in the rows

    constexpr void find_node() {
        if (node_.name.empty()) return;
        const NodeEntry* const own = table_.node(node_.name);
        names_us_ = own != nullptr && own->is_listed;
        if (own != nullptr) return; // BU_ may lack it
        Nearest nearest{node_.name};
        for_each_name(table_.nodes.names, [&](std::string_view each) { nearest.consider(each); });
        for (const NodeEntry& each : table_.node_entries)
            if (each.is_sender) nearest.consider(each.name);
        fail(table_.nodes.at, "BU_ names no node \"", node_.name, "\"",
             or_meant(nearest, "; name one of its nodes, or none: node(\"\", ..)"));
    }
    constexpr void find_message(const FrameRow& row) {
        if (!ok()) return;
        const std::string_view name = in_file(row);
        bool is_found = false;
        for (MessageRow& each : rows_.messages) {
            if (each.name != name) continue;
            if (each.row != nullptr)
                return fail(each.at, "message \"", name, "\" has two rows of \"", node_.name, "\"; keep one");
            if (!row.despite_file && (row.length != 0 || row.identifier.id != 0))
                return fail(each.at, "the row of message \"", name,
                            "\" repeats its file; leave identifier and length out");
            each.row = &row;
            if (row.despite_file) believe(each, row);
            for (const Signal& signal : node_.signals.subspan(row.first, row.values))
                find_signal(each, signal);
            is_found = true;
            if (row.direction != Direction::passing) return;
        }
        if (is_found) return;
        Nearest nearest{name};
        for (const MessageEntry& each : table_.messages) nearest.consider(name_of(each));
        fail(0, "it has no message \"", name, "\", which a row of \"", node_.name, "\" names",
             or_meant(nearest, "; take the row away"));
    }
    constexpr void find_signal(const MessageRow& message, const Signal& row) {
        if (!ok()) return;
        const std::string_view name = in_file(row);
        SignalRow* const found = rows_.find(message, name);
        if (found == nullptr) {
            Nearest nearest{name};
            for (const SignalRow& each : rows_.of(message)) nearest.consider(each.shape.name);
            return fail(message.at, "message \"", message.name, "\" has no signal \"", name,
                        "\", which its row names", or_meant(nearest, "; take it away"));
        }
        if (row.despite_file && row.bits == 0)
            return fail(found->at, "the row of signal \"", name,
                        "\" does not say its place; write despite(signal(\"", name, "\", first bit, bits))");
        if (row.despite_file) return believe(message, *found, row);
        if (row.bits != 0 || row.start != 0 || row.factor != 1 || row.offset != 0 || row.has_range ||
            row.order != Order::intel || row.kind != Kind::unsigned_integer || !row.multiplexor.empty())
            return fail(found->at, "the row of signal \"", name, "\" repeats its file; write signal(\"", name,
                        "\"), its safe value and unit");
        if (found->row != nullptr)
            return fail(found->at, "the row of message \"", message.name, "\" names \"", name,
                        "\" twice; keep one");
        found->row = &row;
    }
    /// Takes from the row what the file has wrong.
    static constexpr void believe(MessageRow& message, const FrameRow& row) noexcept {
        if (row.length != 0) {
            message.length = row.length;
            message.is_fd = row.format != Format::classical;
            message.switches = row.format == Format::flexible_faster;
            message.troubles[static_cast<std::size_t>(Part::format)] = no_such;
        }
        if (!row.despite_identifier) return;
        message.identifier = row.identifier;
        message.shares_identifier = false;
        message.troubles[static_cast<std::size_t>(Part::identifier)] = no_such;
    }
    constexpr void believe(const MessageRow& message, SignalRow& file, const Signal& row) {
        const Signal in_file = file.shape;
        const bool is_selected = file.selected_by != no_such && file.selection_trouble == no_such;
        if (file.is_multiplexed && !is_selected && row.multiplexor.empty())
            return fail(file.at, "the row of signal \"", in_file.name,
                        "\" does not say what selects it; write .when(\"..\", ..) behind its place");
        file.shape = row;
        file.shape.name = in_file.name;
        file.shape.unit = in_file.unit;
        file.row = &row;
        file.has_good_names = false;
        file.trouble = file.limits_trouble = file.selection_trouble = no_such;
        for (SignalRow& each : rows_.of(message))
            each.is_replaced |= &each != &file && each.shape.name == in_file.name;
        if (row.multiplexor.empty()) {
            file.shape.multiplexor = in_file.multiplexor;
            file.shape.selections = in_file.selections;
            return;
        }
        const SignalRow* const multiplexor = rows_.find(message, row.multiplexor);
        if (multiplexor == nullptr || multiplexor == &file || multiplexor->selected_by != no_such)
            return fail(file.at, "the row of signal \"", in_file.name, "\" has the multiplexor \"",
                        row.multiplexor, "\"; name a signal of its message that is in every frame of it");
        file.selected_by = static_cast<std::size_t>(multiplexor - rows_.signals.begin());
    }

    // ---- selection

    constexpr void take_message(MessageRow& message) {
        const bool is_ours = !node_.name.empty() && sends(message, node_.name);
        const FrameRow* const row = message.row;
        const bool sends = row != nullptr && row->direction == Direction::transmit;
        const bool is_left_out = row != nullptr && row->direction == Direction::passing;
        if (is_left_out || (row == nullptr && another_has_row(message))) return;
        if (is_ours && row == nullptr)
            return fail(message.at, "message \"", message.name, "\" is sent by \"", node_.name,
                        "\" but has no safe values; write transmit(\"", message.name,
                        "\", signal(\"..\").safe(..)) into its node, or .safe_by_silence() behind that");
        if (row == nullptr && !node_.name.empty()) find_doubt(message);
        const bool is_others =
            message.sender.names != nobody && !node_.name.empty() && !may_be_us(message.sender.names);
        if (row != nullptr && is_ours != sends && (is_ours || is_others))
            return fail(message.at, "message \"", message.name, "\" is sent by \"", message.sender.names,
                        is_ours ? "\", so \"" : "\", not by \"", node_.name,
                        is_ours ? "\" does not receive it; write transmit(..)" : "\"; write receive(..)");
        message.direction = sends ? Direction::transmit : Direction::receive;
        const bool takes_all = sends || (row != nullptr && row->values == 0);
        const char* last = nullptr;
        bool is_receiver = false;
        for (SignalRow& each : rows_.of(message)) {
            const std::string_view receivers = each.receivers.names; // most equal the previous ones
            if (row == nullptr && std::exchange(last, receivers.data()) != receivers.data())
                is_receiver = names(receivers, node_.name);
            const bool is_asked = row == nullptr && is_receiver;
            if (each.is_replaced || !(takes_all || is_asked || each.row != nullptr)) continue;
            for (SignalRow* up = &each; up != nullptr && !up->is_taken;
                 up = up->selected_by == no_such ? nullptr : &rows_.signals[up->selected_by])
                up->is_taken = true;
        }
        message.is_taken = row != nullptr || count(message) != 0;
        if (message.is_taken) check(message);
    }
    [[nodiscard]] constexpr bool may_be_us(std::string_view name) const noexcept {
        return names_us_ && may_be_node(name, node_.name, table_.nodes.names);
    }
    /// Refuses a message that may be the node's own, or one for it: a name that BU_ lacks is nearly its name.
    constexpr void find_doubt(const MessageRow& message) {
        if (!names_us_) return;
        const auto look = [&](const NodeList& list) {
            for_each_name(list.names, [&](std::string_view name) {
                if (!may_be_us(name)) return;
                fail(list.at + static_cast<std::size_t>(name.data() - list.names.data()), "\"", name,
                     "\", which BU_ does not name, may be \"", node_.name, "\"; write transmit(\"",
                     message.name, "\", ..), receive(\"", message.name, "\", ..) or without(\"", message.name,
                     "\")");
            });
        };
        look(message.sender);
        look(message.more_senders);
        const char* last = nullptr;
        for (const SignalRow& each : rows_.of(message))
            if (std::exchange(last, each.receivers.names.data()) != each.receivers.names.data())
                look(each.receivers);
    }
    /// Returns whether a row says that another message with this identifier is on the bus.
    [[nodiscard]] constexpr bool another_has_row(const MessageRow& message) const noexcept {
        if (!message.shares_identifier) return false;
        for (const MessageRow& each : rows_.messages)
            if (&each != &message && each.identifier == message.identifier && each.row != nullptr)
                return true;
        return false;
    }

    // ---- faults of what is taken

    constexpr void check(MessageRow& message) {
        const std::size_t before = faults_;
        if (message.shares_identifier && message.row == nullptr)
            fail(message.at, "message \"", message.name,
                 "\" has the identifier of another one; write the one that is on the bus as a row, "
                 "receive(\"",
                 message.name, "\", ..)");
        if (message.length > 64)
            fail(message.at, "message \"", message.name, "\" has ", std::size_t{message.length},
                 " bytes, which no frame holds, only a transport protocol", cure(message, nullptr));
        for (std::size_t part = 0; part < message.troubles.size(); ++part) {
            const bool is_rate = static_cast<Part>(part) == Part::rate;
            if (message.troubles[part] == no_such || (is_rate && says_rate(message))) continue;
            found_fault(message.troubles[part],
                        is_rate ? Sentence{"; write can::every(..) or can::on_demand(..) into ",
                                           word_of(message), message.name, "\", ..)"}
                                : cure(message, nullptr,
                                       static_cast<Part>(part) == Part::identifier ? "extended(..), " : ""));
        }
        for (SignalRow& each : rows_.of(message)) {
            if (!each.is_taken) continue;
            const bool lacks_limits =
                message.direction == Direction::transmit && each.limits_trouble != no_such;
            const std::size_t trouble = each.trouble != no_such             ? each.trouble
                                        : each.selection_trouble != no_such ? each.selection_trouble
                                        : lacks_limits                      ? each.limits_trouble
                                                                            : no_such;
            if (trouble != no_such) found_fault(trouble, cure(message, &each));
            if (!each.has_good_names) keep_good_names(rows_, each, [](const ValueName&, std::string_view) {});
        }
        if (faults_ == before) check_rate(message);
    }
    constexpr void found_fault(std::size_t trouble, const Sentence& cure) {
        if (faults_++ != 0) return;
        fault_ = trouble;
        cure_ = cure;
    }
    /// Refuses the map with the sentence of the first fault.
    constexpr void refuse() {
        const Told& told = told_[fault_];
        const Sentence more = faults_ == 1 ? Sentence{}
                                           : Sentence{" (and ", faults_ - 1, " more: tappet check ",
                                                      table_.file, " lists all)"};
        // A question is no clause before another one.
        fail(told.at, told.text, cure_.view().substr(told.text.ends_with('?') ? 1 : 0), more);
    }
    /// Returns the end of a sentence about a fault of the file: how the node's rows go around it.
    constexpr Sentence cure(const MessageRow& message, const SignalRow* signal,
                            std::string_view wrong = {}) const {
        const bool is_sent = message.direction == Direction::transmit;
        const std::string_view word = word_of(message);
        if (signal == nullptr && wrong.empty())
            return Sentence{"; leave it out by a row, without(\"", message.name, "\")"};
        if (signal == nullptr)
            return Sentence{"; state it in its row, despite(",       wrong,        word, message.name,
                            "\", ..)), or leave it out, without(\"", message.name, "\")"};
        const Sentence state{"; state it in its row, despite(", row_for(*signal), "), or "};
        if (!is_sent)
            for (const SignalRow& each : rows_.of(message))
                if (&each != signal && each.trouble == no_such && each.selection_trouble == no_such)
                    return Sentence{state,           "take other signals alone, receive(\"",
                                    message.name,    "\", signal(\"",
                                    each.shape.name, "\"), ..)"};
        return Sentence{state, "leave its message out by a row, without(\"", message.name, "\")"};
    }
    static constexpr std::string_view word_of(const MessageRow& message) noexcept {
        return message.direction == Direction::transmit ? "transmit(\"" : "receive(\"";
    }
    /// Returns a signal's row with all that was read of it, and ".." for what the machine must state.
    static constexpr Sentence row_for(const SignalRow& signal) {
        const Signal& s = signal.shape;
        Sentence row{"signal(\"", s.name, "\", "};
        const bool has_place = signal.trouble == no_such &&
                               (signal.limits_trouble != no_such || signal.selection_trouble != no_such);
        if (has_place)
            row.add(s.start).add(", ").add(s.bits).add(")");
        else
            row.add("first bit, bits)");
        if (s.order == Order::motorola) row.add(".big_endian()");
        if (s.kind != Kind::unsigned_integer)
            row.add(s.kind == Kind::signed_integer ? ".as_signed()" : ".as_float()");
        const auto add = [&](std::string_view word, double value, double usual, std::string_view written) {
            if (value != usual) row.add(word).add(value == 0 || !is_number(value) ? ".." : written).add(")");
        };
        add(".times(", s.factor, 1, signal.factor);
        add(".plus(", s.offset, 0, signal.offset);
        if (s.has_range || signal.limits_trouble != no_such) row.add(".range(.., ..)");
        const bool lacks_selection = signal.is_multiplexed && signal.selected_by == no_such;
        if (lacks_selection || signal.selection_trouble != no_such) row.add(".when(\"..\", ..)");
        return row;
    }
    static constexpr bool says_rate(const MessageRow& message) noexcept {
        return message.row != nullptr && message.row->every != as_in_file.every;
    }
    constexpr void check_rate(const MessageRow& message) {
        const std::string_view word = word_of(message);
        if (!says_rate(message) && message.every <= Duration::zero())
            fail(message.at, "message \"", message.name,
                 "\" has no cycle time (GenMsgCycleTime); write can::every(..) or can::on_demand(..) into ",
                 word, message.name, "\", ..)");
        else if (!says_rate(message) && *message.on_demand)
            fail(message.at, "message \"", message.name,
                 "\" is sent on demand, too (GenMsgSendType), not only in its cycle time; write "
                 "can::on_demand(..) with the least time between two, or can::every(..), into ",
                 word, message.name, "\", ..)");
        if (says_rate(message) && !*message.on_demand && message.every > Duration::zero() &&
            message.row->every != message.every)
            fail(message.at, "message \"", message.name, "\" has a cycle time of ",
                 decimal(static_cast<double>(message.every.count()) / 1e6),
                 " ms and a row with another one; leave it out of the row");
    }

    // ---- rows of the map

    constexpr void add(Sizes& sizes, const MessageRow& message) const {
        ++sizes.frames;
        for (const SignalRow& each : rows_.of(message)) {
            sizes.signals += each.is_taken;
            sizes.values += each.is_taken ? each.values : 0;
        }
    }
    constexpr FrameRow frame_of(const MessageRow& message) {
        FrameRow frame;
        frame.identifier = message.identifier;
        frame.direction = message.direction;
        frame.length = static_cast<std::uint8_t>(message.length);
        if (*message.is_fd) frame.format = *message.switches ? Format::flexible_faster : Format::flexible;
        frame.every = frame.apart = message.every;
        frame.name = message.name;
        if (message.row == nullptr) return frame;
        if (!message.row->in_file.empty()) frame.name = message.row->name;
        if (says_rate(message)) static_cast<Rate&>(frame) = *message.row;
        frame.silence_is_safe = message.row->silence_is_safe;
        return frame;
    }
    template <std::size_t S>
    constexpr Signal signal_of(const SignalRow& row, const std::array<Signal, S>& placed) {
        Signal signal = row.shape;
        ValueName* const names = values_ + used_values_;
        used_values_ += row.values;
        std::ranges::copy(rows_.names_of(row), names);
        signal.names = {names, row.values};
        if (row.selected_by != no_such)
            signal.multiplexor = placed[rows_.signals[row.selected_by].placed].name;
        if (row.row == nullptr) return signal;
        if (!row.row->in_file.empty()) signal.name = row.row->name;
        if (!row.row->unit.empty()) signal.unit = row.row->unit;
        if (!row.row->names.empty()) signal.names = row.row->names;
        signal.says_safe = row.row->says_safe;
        signal.safe_value = row.row->safe_value;
        signal.safe_name = row.row->safe_name;
        return signal;
    }

    const Table& table_;
    Rows rows_;
    const Told* told_;
    NodeView node_;
    Sentence& fault_text_;
    ValueName* values_ = nullptr;
    std::size_t used_values_ = 0;
    bool names_us_ = false;                    ///< BU_ names the node
    std::size_t faults_ = 0, fault_ = no_such; ///< of the file, in what is taken
    Sentence cure_{};
};

} // namespace tappet::can::dbc
