// Selects the part of a network that one node uses: its frames and signals as rows of a signal map. Only this
// part must be free of faults.
#pragma once

#include "drivers/can/dbc/nearly.hpp"
#include "drivers/can/dbc/network.hpp"
#include "drivers/can/dbc/node.hpp"
#include "drivers/can/dbc/reader.hpp"
#include "drivers/can/dbc/scanner.hpp"
#include "drivers/can/dbc/texts.hpp"
#include "drivers/can/dbc/value_rows.hpp"

namespace tappet::can::dbc {

/// The sizes that the map of a node needs.
struct Sizes {
    std::size_t frames = 0, signals = 0, values = 0, characters = 0;
};

class Taking {
public:
    constexpr Taking(Network& network, const NodeView& node) noexcept : net_{network}, node_{node} {}

    /// Marks the node's frames and signals. Its fault becomes the network's.
    constexpr Sizes take() {
        find_node();
        for (const FrameRow& row : node_.frames) find_message(row);
        Sizes sizes;
        for (MessageRow& message : net_.all()) {
            if (!ok() || message.is_independent) continue;
            take_message(message);
            if (message.is_taken && ok()) add(sizes, message);
        }
        if (faults_ != 0 && ok()) refuse();
        return sizes;
    }
    /// Fills a map of at least these sizes.
    template <std::size_t F, std::size_t S>
    constexpr void fill(SignalMap<F, S>& map, std::span<ValueName> values, std::span<char> characters) {
        std::array<const MessageRow*, F> messages{};
        std::array<const SignalRow*, S> signals{};
        values_ = values;
        characters_ = characters;
        std::size_t f = 0, s = 0;
        for (MessageRow& message : net_.all()) {
            if (!message.is_taken) continue;
            messages[f] = &message;
            FrameRow& frame = map.frames[f++];
            frame = frame_of(message);
            frame.first = s;
            // A multiplexor comes before the signals it selects.
            const auto all = net_.of(message);
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
        net_.fail(signal != nullptr ? signal->at : message.at, fault.text,
                  fault.cure.empty() ? Sentence{}
                                     : cure(message, signal, message.length > 8 ? "fd_bytes(..), " : ""));
    }

private:
    [[nodiscard]] constexpr bool ok() const noexcept { return net_.fault.empty(); }
    static constexpr std::string_view in_file(const auto& row) noexcept {
        return row.in_file.empty() ? row.name : row.in_file;
    }
    [[nodiscard]] constexpr std::size_t depth_of(const SignalRow& signal) const noexcept {
        std::size_t depth = 0;
        for (std::size_t up = signal.selected_by; up != no_such; up = net_.signals[up].selected_by) ++depth;
        return depth;
    }
    [[nodiscard]] constexpr std::size_t count(const MessageRow& message) const noexcept {
        std::size_t taken = 0;
        for (const SignalRow& each : net_.of(message)) taken += each.is_taken;
        return taken;
    }

    // ---- names in the rows

    constexpr void find_node() {
        names_us_ = !node_.name.empty() && names(net_.nodes, node_.name);
        if (!ok() || node_.name.empty() || names_us_) return;
        Nearest nearest{node_.name};
        for_each_name(net_.nodes, [&](std::string_view each) { nearest.consider(each); });
        for (const MessageRow& message : net_.all()) { // BU_ may lack it
            if (net_.sends(message, node_.name)) return;
            nearest.consider(message.sender);
            for (const SignalRow& each : net_.of(message))
                if (names(each.receivers, node_.name)) return;
        }
        const std::size_t at =
            net_.nodes.empty() ? 0 : static_cast<std::size_t>(net_.nodes.data() - net_.text.data());
        net_.fail(at, "BU_ names no node \"", node_.name, "\"",
                  or_meant(nearest, "; name one of its nodes, or none: node(\"\", ..)"));
    }
    constexpr void find_message(const FrameRow& row) {
        if (!ok()) return;
        const std::string_view name = in_file(row);
        Nearest nearest{name};
        bool is_found = false;
        for (MessageRow& each : net_.all()) {
            if (each.is_independent) continue;
            nearest.consider(each.name);
            if (each.name != name) continue;
            if (each.row != nullptr)
                return net_.fail(each.at, "message \"", name, "\" has two rows of \"", node_.name,
                                 "\"; keep one");
            if (!row.despite_file && (row.length != 0 || row.identifier.id != 0))
                return net_.fail(each.at, "the row of message \"", name,
                                 "\" repeats its file; leave identifier and length out");
            each.row = &row;
            if (row.despite_file) believe(each, row);
            for (const Signal& signal : node_.signals.subspan(row.first, row.values))
                find_signal(each, signal);
            is_found = true;
            if (row.direction != Direction::passing) return;
        }
        if (is_found) return;
        net_.fail(0, "it has no message \"", name, "\", which a row of \"", node_.name, "\" names",
                  or_meant(nearest, "; take the row away"));
    }
    constexpr void find_signal(const MessageRow& message, const Signal& row) {
        if (!ok()) return;
        const std::string_view name = in_file(row);
        SignalRow* const found = net_.find(message, name);
        if (found == nullptr) {
            Nearest nearest{name};
            for (const SignalRow& each : net_.of(message)) nearest.consider(each.shape.name);
            return net_.fail(message.at, "message \"", message.name, "\" has no signal \"", name,
                             "\", which its row names", or_meant(nearest, "; take it away"));
        }
        if (row.despite_file && row.bits == 0)
            return net_.fail(found->at, "the row of signal \"", name,
                             "\" does not say its place; write despite(signal(\"", name,
                             "\", first bit, bits))");
        if (row.despite_file) return believe(message, *found, row);
        if (row.bits != 0 || row.start != 0 || row.factor != 1 || row.offset != 0 || row.has_range ||
            row.order != Order::intel || row.kind != Kind::unsigned_integer || !row.multiplexor.empty())
            return net_.fail(found->at, "the row of signal \"", name, "\" repeats its file; write signal(\"",
                             name, "\"), its safe value and unit");
        if (found->row != nullptr)
            return net_.fail(found->at, "the row of message \"", message.name, "\" names \"", name,
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
            return net_.fail(file.at, "the row of signal \"", in_file.name,
                             "\" does not say what selects it; write .when(\"..\", ..) behind its place");
        file.shape = row;
        file.shape.name = in_file.name;
        file.shape.unit = in_file.unit;
        file.row = &row;
        file.trouble = file.limits_trouble = file.selection_trouble = no_such;
        for (SignalRow& each : net_.of(message))
            each.is_replaced |= &each != &file && each.shape.name == in_file.name;
        if (row.multiplexor.empty()) {
            file.shape.multiplexor = in_file.multiplexor;
            file.shape.selections = in_file.selections;
            return;
        }
        const SignalRow* const multiplexor = net_.find(message, row.multiplexor);
        if (multiplexor == nullptr || multiplexor == &file || multiplexor->selected_by != no_such)
            return net_.fail(file.at, "the row of signal \"", in_file.name, "\" has the multiplexor \"",
                             row.multiplexor,
                             "\"; name a signal of its message that is in every frame of it");
        file.selected_by = static_cast<std::size_t>(multiplexor - net_.signals.data());
    }

    // ---- selection

    constexpr void take_message(MessageRow& message) {
        const bool is_ours = !node_.name.empty() && net_.sends(message, node_.name);
        const FrameRow* const row = message.row;
        const bool sends = row != nullptr && row->direction == Direction::transmit;
        const bool is_left_out = row != nullptr && row->direction == Direction::passing;
        if (is_left_out || (row == nullptr && another_has_row(message))) return;
        if (is_ours && row == nullptr)
            return net_.fail(message.at, "message \"", message.name, "\" is sent by \"", node_.name,
                             "\" but has no safe values; write transmit(\"", message.name,
                             "\", signal(\"..\").safe(..)) into its node, or .safe_by_silence() behind that");
        if (row == nullptr && !node_.name.empty()) find_doubt(message);
        const bool is_others = message.sender != nobody && !node_.name.empty() && !may_be_us(message.sender);
        if (row != nullptr && is_ours != sends && (is_ours || is_others))
            return net_.fail(message.at, "message \"", message.name, "\" is sent by \"", message.sender,
                             is_ours ? "\", so \"" : "\", not by \"", node_.name,
                             is_ours ? "\" does not receive it; write transmit(..)"
                                     : "\"; write receive(..)");
        message.direction = sends ? Direction::transmit : Direction::receive;
        const bool takes_all = sends || (row != nullptr && row->values == 0);
        for (SignalRow& each : net_.of(message)) {
            const bool is_asked = row == nullptr && names(each.receivers, node_.name);
            if (each.is_replaced || !(takes_all || is_asked || each.row != nullptr)) continue;
            for (SignalRow* up = &each; up != nullptr && !up->is_taken;
                 up = up->selected_by == no_such ? nullptr : &net_.signals[up->selected_by])
                up->is_taken = true;
        }
        message.is_taken = row != nullptr || count(message) != 0;
        if (message.is_taken) check(message);
    }
    [[nodiscard]] constexpr bool may_be_us(std::string_view name) const noexcept {
        return names_us_ && may_be_node(name, node_.name, net_.nodes);
    }
    /// Refuses a message that may be the node's own, or one for it: a name that BU_ lacks is nearly its name.
    constexpr void find_doubt(const MessageRow& message) {
        if (!names_us_) return;
        const auto look = [&](std::string_view list) {
            for_each_name(list, [&](std::string_view name) {
                if (!may_be_us(name)) return;
                net_.fail(static_cast<std::size_t>(name.data() - net_.text.data()), "\"", name,
                          "\", which BU_ does not name, may be \"", node_.name, "\"; write transmit(\"",
                          message.name, "\", ..), receive(\"", message.name, "\", ..) or without(\"",
                          message.name, "\")");
            });
        };
        look(message.sender);
        look(message.more_senders);
        std::string_view last{};
        for (const SignalRow& each : net_.of(message)) {
            if (each.receivers != last) look(each.receivers);
            last = each.receivers;
        }
    }
    /// Returns whether a row says that another message with this identifier is on the bus.
    [[nodiscard]] constexpr bool another_has_row(const MessageRow& message) const noexcept {
        if (!message.shares_identifier) return false;
        for (const MessageRow& each : net_.all())
            if (&each != &message && each.identifier == message.identifier && each.row != nullptr)
                return true;
        return false;
    }

    // ---- faults of what is taken

    constexpr void check(MessageRow& message) {
        const std::size_t before = faults_;
        if (message.shares_identifier && message.row == nullptr)
            net_.fail(message.at, "message \"", message.name,
                      "\" has the identifier of another one; write the one that is on the bus as a row, "
                      "receive(\"",
                      message.name, "\", ..)");
        if (message.length > 64)
            net_.fail(message.at, "message \"", message.name, "\" has ", std::size_t{message.length},
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
        for (SignalRow& each : net_.of(message)) {
            if (!each.is_taken) continue;
            const bool lacks_limits =
                message.direction == Direction::transmit && each.limits_trouble != no_such;
            const std::size_t at = each.trouble != no_such             ? each.trouble
                                   : each.selection_trouble != no_such ? each.selection_trouble
                                   : lacks_limits                      ? each.limits_trouble
                                                                       : no_such;
            if (at != no_such) found_fault(at, cure(message, &each));
            keep_good_names(net_, each, [](const ValueName&, std::string_view) {});
        }
        if (faults_ == before) check_rate(message);
    }
    constexpr void found_fault(std::size_t at, const Sentence& cure) {
        if (faults_++ != 0) return;
        fault_at_ = at;
        cure_ = cure;
    }
    /// Reads the file again for the sentence of the first fault.
    constexpr void refuse() {
        for (MessageRow& each : net_.all()) each = {};
        for (SignalRow& each : net_.signals.first(net_.used.signals)) each = {};
        net_.used = {};
        Trouble found{};
        Troubles troubles{.rows = {&found, 1}, .wanted = fault_at_};
        net_.troubles = &troubles;
        Reader{net_}.read();
        net_.troubles = nullptr;
        const Sentence more =
            faults_ == 1 ? Sentence{}
                         : Sentence{" (and ", faults_ - 1, " more: tappet check ", net_.file, " lists all)"};
        // A question is no clause before another one.
        net_.fail(fault_at_, found.text, cure_.view().substr(found.text.view().ends_with('?') ? 1 : 0), more);
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
            for (const SignalRow& each : net_.of(message))
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
            net_.fail(
                message.at, "message \"", message.name,
                "\" has no cycle time (GenMsgCycleTime); write can::every(..) or can::on_demand(..) into ",
                word, message.name, "\", ..)");
        else if (!says_rate(message) && *message.on_demand)
            net_.fail(message.at, "message \"", message.name,
                      "\" is sent on demand, too (GenMsgSendType), not only in its cycle time; write "
                      "can::on_demand(..) with the least time between two, or can::every(..), into ",
                      word, message.name, "\", ..)");
        if (says_rate(message) && !*message.on_demand && message.every > Duration::zero() &&
            message.row->every != message.every)
            net_.fail(message.at, "message \"", message.name, "\" has a cycle time of ",
                      decimal(static_cast<double>(message.every.count()) / 1e6),
                      " ms and a row with another one; leave it out of the row");
    }

    // ---- rows of the map, whose texts are copied out of the file's

    template <class Put> static constexpr std::size_t length_of(const Put& put_all) {
        std::size_t length = 0;
        put_all([&](std::string_view piece) { length += piece.size(); });
        return length;
    }
    template <class PutAll> constexpr std::string_view kept(const PutAll& put_all) {
        const std::size_t from = used_characters_;
        put_all([&](std::string_view piece) {
            for (const char each : piece) characters_[used_characters_++] = each;
        });
        return {characters_.data() + from, used_characters_ - from};
    }
    constexpr void add(Sizes& sizes, const MessageRow& message) const {
        ++sizes.frames;
        sizes.characters += message.name.size();
        for (const SignalRow& each : net_.of(message)) {
            if (!each.is_taken) continue;
            ++sizes.signals;
            sizes.characters += each.shape.name.size();
            sizes.characters += length_of([&](const auto& put) { put_unit(each.shape.unit, put); });
            sizes.values += each.values;
            for (const ValueName& value : net_.values.subspan(each.first_value, each.values))
                sizes.characters += length_of([&](const auto& put) { put_as_utf8(value.name, put); });
        }
    }
    constexpr FrameRow frame_of(const MessageRow& message) {
        FrameRow frame;
        frame.identifier = message.identifier;
        frame.direction = message.direction;
        frame.length = static_cast<std::uint8_t>(message.length);
        if (*message.is_fd) frame.format = *message.switches ? Format::flexible_faster : Format::flexible;
        frame.every = frame.apart = message.every;
        frame.name = kept([&](const auto& put) { put(message.name); });
        if (message.row == nullptr) return frame;
        if (!message.row->in_file.empty()) frame.name = message.row->name;
        if (says_rate(message)) static_cast<Rate&>(frame) = *message.row;
        frame.silence_is_safe = message.row->silence_is_safe;
        return frame;
    }
    template <std::size_t S>
    constexpr Signal signal_of(const SignalRow& row, const std::array<Signal, S>& placed) {
        Signal signal = row.shape;
        signal.name = kept([&](const auto& put) { put(row.shape.name); });
        signal.unit = kept([&](const auto& put) { put_unit(row.shape.unit, put); });
        const std::size_t first = used_values_;
        for (const ValueName& value : net_.values.subspan(row.first_value, row.values))
            values_[used_values_++] = {value.value,
                                       kept([&](const auto& put) { put_as_utf8(value.name, put); })};
        signal.names = values_.subspan(first, row.values);
        if (row.selected_by != no_such)
            signal.multiplexor = placed[net_.signals[row.selected_by].placed].name;
        if (row.row == nullptr) return signal;
        if (!row.row->in_file.empty()) signal.name = row.row->name;
        if (!row.row->unit.empty()) signal.unit = row.row->unit;
        if (!row.row->names.empty()) signal.names = row.row->names;
        signal.says_safe = row.row->says_safe;
        signal.safe_value = row.row->safe_value;
        signal.safe_name = row.row->safe_name;
        return signal;
    }

    Network& net_;
    NodeView node_;
    std::span<ValueName> values_{};
    std::span<char> characters_{};
    std::size_t used_values_ = 0;
    std::size_t used_characters_ = 0;
    bool names_us_ = false;                       ///< BU_ names the node
    std::size_t faults_ = 0, fault_at_ = no_such; ///< of the file, in what is taken
    Sentence cure_{};
};

} // namespace tappet::can::dbc
